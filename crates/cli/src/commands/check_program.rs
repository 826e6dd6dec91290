//! `carrystep check` for a G-code program: the path that the pulses of a capture follow, and their
//! times against the plan.

use crate::arguments::CheckArguments;
use crate::capture::{origin, unusable};
use crate::failure::Failure;
use crate::junit::JunitFile;
use crate::pass::{Kept, RowsAhead};
use crate::{job, output, program, program_run};
use carrystep_check::{
    Capture, JobChecker, JobOutputs, JobReport, OutputPins, PlannedRow, PlannedRows, SignalMap,
    TraceError, sink_beside,
};
use carrystep_files::InputError;
use carrystep_program::{Legs, Marks, Row, Rows};
use carrystep_report::Detail;
use schemars::JsonSchema;
use serde::Serialize;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct CheckedProgram<'a> {
    passed: bool,
    capture: &'a std::path::Path,
    check: &'a JobReport,
}

/// Refuses slices, with the reason.
fn refuse_slices(arguments: &CheckArguments) -> Result<(), Failure> {
    let CheckArguments { slice, merge, .. } = arguments;
    let options = [("--slice", slice.is_some()), ("--merge", !merge.is_empty())];
    let Some((option, _)) = options.iter().find(|(_, given)| *given) else { return Ok(()) };
    let message = format!(
        "{option} is not available for G-code programs: each slice would have to plan the program \
         from its beginning and follow its path from there, which is half of the work of the whole \
         check or more"
    );
    let help = format!(
        "leave out {option}: the memory of a check does not grow with the capture; --path-only \
         takes two thirds of the time"
    );
    Err(InputError::new(message).help(help).into())
}

/// Checks a capture against a program and prints the report.
pub fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    program::refuse(&[("--fit-ns", arguments.fit_ns.is_some())])?;
    refuse_slices(arguments)?;
    let file = program::load(&arguments.file, &arguments.program)?;
    let name = format!("check {} {}", arguments.capture.display(), arguments.file.display());
    let map =
        SignalMap::parse(&arguments.map).map_err(|error| Failure::input(error.to_string()))?;
    let names: Vec<&str> = file.machine().axes.iter().map(|axis| axis.name.as_str()).collect();
    let failed = |error: TraceError| unusable(arguments, error);
    let build = file.machine().outputs;
    let exist = OutputPins { outputs: build.exist, pwm: build.pwm_divider > 0 };
    let capture = Capture::new(&arguments.capture, &names, &map).map_err(failed)?;
    let capture = capture.with_outputs(exist);
    let reader = capture.open().map_err(failed)?;
    let timebase = file.machine().timebase;
    let origin = origin(arguments, reader.own(), &timebase)?;
    let mut junit = JunitFile::begin(arguments.junit.as_deref(), name)?;
    let (survey, _) = program::survey(&file, Detail::Figures, |_| Ok(()))?;
    job::fits_into_a_capture(survey.ticks, &timebase)?;

    let kept = Kept::default();
    let mut setup = program_run::setup(&file, 0);
    for (axis, planned) in setup.axes.iter_mut().zip(&survey.axes) {
        axis.steps = planned.steps();
    }
    setup.slack_ps = arguments.slack_ns.saturating_mul(1000);
    let rows = if arguments.path_only {
        None
    } else {
        setup.total_ps = program_run::length_ps(&survey, &timebase);
        let rows = RowsAhead::new(Rows::new(&file)?);
        let mut outputs = file.row_outputs();
        let planned = move |row: Row| {
            let outputs = outputs.change(&row);
            PlannedRow { segments: row.segments, outputs }
        };
        let rows = kept.until_an_error(rows).map(planned);
        Some(Box::new(rows) as PlannedRows<'_>)
    };
    let legs = Box::new(kept.until_an_error(Legs::new(&file)?));
    let marks = Box::new(kept.until_an_error(Marks::new(&file)?));
    let outputs = JobOutputs {
        exist,
        shown: reader.outputs(),
        divider: build.pwm_divider,
        is_own: reader.own().is_some(),
        marks,
    };
    let checker = JobChecker::new(setup, legs, rows, outputs, &timebase, origin);
    // The capture is read while it is checked.
    let (played, checker) = sink_beside(checker, |sink| reader.play(sink)).map_err(failed)?;
    let report = checker.finish();
    // An error of reading the program explains whatever the check says.
    kept.error()?;
    file.same()?;
    played.map_err(failed)?;

    if let Some(mut junit) = junit.take() {
        junit.case("path".to_owned(), &report.path.failures);
        for axis in report.times.iter().flatten() {
            junit.case(format!("axis {}", axis.axis), &axis.failures);
        }
        for output in report.output_times.iter().flatten() {
            junit.case(format!("output {}", output.output), &output.failures);
        }
        if let Some(pwm) = &report.pwm {
            junit.case("PWM".to_owned(), pwm.first_wrong.as_slice());
        }
        junit.keep()?;
    }
    let passed = report.passed;
    if arguments.json {
        let capture = &arguments.capture;
        output::print_json(&CheckedProgram { passed, capture, check: &report })?;
    } else {
        let verdict = if passed { "ALL HOLDS" } else { "FAILED" };
        output::print(&format!("{report}{verdict}\n"))?;
    }
    if passed { Ok(()) } else { Err(Failure::Check) }
}

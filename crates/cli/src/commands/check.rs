//! `carrystep check`: checks any VCD against a move file.

use crate::arguments::CheckArguments;
use crate::failure::Failure;
use crate::junit::JunitFile;
use crate::{job, output};
use carrystep_check::{CheckReport, Origin, SignalMap, TraceError, VcdReader, check_beside};
use carrystep_core::Timebase;
use carrystep_plan::{AxisTotals, Pass, Survey};
use schemars::JsonSchema;
use serde::Serialize;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct Checked<'a> {
    passed: bool,
    capture: &'a std::path::Path,
    check: &'a CheckReport,
}

/// Checks a capture and prints the report.
pub fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    let survey = job::survey(job::load(&arguments.file, arguments.fit_ns)?, |_| Ok(()))?;
    let name = format!("check {} {}", arguments.capture.display(), arguments.file.display());
    let mut junit = JunitFile::begin(arguments.junit.as_deref(), name)?;
    let report = read(arguments, &survey)?;
    if let Some(mut junit) = junit.take() {
        for axis in &report.axes {
            junit.case(format!("axis {}", axis.axis), &axis.failures);
        }
        junit.keep()?;
    }
    if arguments.json {
        output::print_json(&Checked {
            passed: report.passed(),
            capture: &arguments.capture,
            check: &report,
        })?;
    } else {
        output::print(&format!(
            "{report}{}\n",
            if report.passed() { "ALL HOLDS" } else { "FAILED" }
        ))?;
    }
    if report.passed() { Ok(()) } else { Err(Failure::Check) }
}

fn read(arguments: &CheckArguments, survey: &Survey) -> Result<CheckReport, Failure> {
    job::fits_a_capture(survey)?;
    let timebase = survey.build().timebase;
    let unusable =
        |error: String| Failure::input(format!("{}: {error}", arguments.capture.display()));
    let capture = carrystep_files::open(&arguments.capture)
        .map_err(|error| Failure::input(error.to_string()))?;
    let map =
        SignalMap::parse(&arguments.map).map_err(|error| Failure::input(error.to_string()))?;
    let names: Vec<&str> = survey.machine().axes.iter().map(|axis| axis.name.as_str()).collect();
    let reader =
        VcdReader::new(capture, &names, &map).map_err(|error| unusable(error.to_string()))?;
    if let Some(own) = reader.own().filter(|own| own.timebase != timebase) {
        return Err(unusable(format!(
            "recorded from gateware with {}, but the machine of {} has {}",
            figures(&own.timebase),
            arguments.file.display(),
            figures(&timebase)
        )));
    }
    let origin = match (arguments.origin_ps, reader.own()) {
        (Some(ps), _) => Origin::Fixed { ps },
        (None, Some(own)) => Origin::Known { ps: own.origin_ps },
        (None, None) => Origin::Midpoint,
    };
    uncertain_by_less_than_a_period(arguments.slack_ns, survey)?;
    let Pass { timelines, courses, .. } = survey.begin();
    let mut setup = job::check_setup(survey, &timelines, courses, origin);
    // Only the checker keeps a place in the plan.
    drop(timelines);
    setup.slack_ps = arguments.slack_ns.saturating_mul(1000);
    let (played, report) = check_beside(setup, |mut checker| reader.play(&mut checker));
    survey.whole()?;
    let played = played.map_err(|error| match error {
        TraceError::Read(error) => unusable(error.to_string()),
        other => other.into(),
    })?;
    if let Origin::Fixed { ps } = origin {
        overlap(ps, played.end_ps, survey).map_err(unusable)?;
    }
    Ok(report)
}

/// Refuses a slack of more than half of the shortest period, because a pulse could then match the
/// neighbouring step.
fn uncertain_by_less_than_a_period(slack_ns: u64, survey: &Survey) -> Result<(), Failure> {
    let speed = |axis: &AxisTotals| axis.peaks.steps_per_s(&survey.build().timebase);
    let fastest = survey.totals().axes.iter().map(speed).fold(0.0, f64::max);
    let most_ns = (0.5e9 / fastest).floor();
    if fastest > 0.0 && slack_ns as f64 > most_ns {
        let text = format!(
            "--slack-ns {slack_ns} is over half of the shortest period; at most {most_ns} can be checked"
        );
        return Err(Failure::input(text));
    }
    Ok(())
}

/// Checks that moves that start at `origin_ps` overlap a capture that ends at `end_ps`; the error
/// is the reason.
fn overlap(origin_ps: i64, end_ps: u64, survey: &Survey) -> Result<(), String> {
    let tick_ps = i128::from(survey.build().timebase.tick_ns()) * 1000;
    let length_ps = i128::from(survey.totals().ticks) * tick_ps;
    let (from, to) = (i128::from(origin_ps), i128::from(origin_ps) + length_ps);
    if from <= i128::from(end_ps) && to >= 0 {
        return Ok(());
    }
    Err(format!(
        "with --origin-ps {origin_ps} the moves last from {from} to {to} ps; the capture, from 0 to {end_ps} ps"
    ))
}

/// The settings in which two builds must agree to have the same time base.
fn figures(timebase: &Timebase) -> String {
    format!(
        "clock_hz = {}, tick_ns = {}, phases = {}",
        timebase.clock_hz(),
        timebase.tick_ns(),
        timebase.phases()
    )
}

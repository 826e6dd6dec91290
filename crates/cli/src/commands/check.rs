//! `carrystep check`: checks any VCD against a move file, as a whole or in slices.

use crate::arguments::CheckArguments;
use crate::capture::{origin, unusable};
use crate::commands::check_program;
use crate::failure::Failure;
use crate::junit::JunitFile;
use crate::output::OutputFile;
use crate::{job, output};
use carrystep_check::{Capture, CheckReport, Origin, Setup, SignalMap, check_beside};
use carrystep_files::OutputClaim;
use carrystep_files::sealed::sha256_of;
use carrystep_plan::{AxisTotals, Pass, Survey};
use carrystep_program::is_program;
use carrystep_sweep::Shard;
use schemars::JsonSchema;
use serde::Serialize;
use slice_file::{SliceFault, SliceSettings, Slices};
use std::io::{self, Read as _, Write as _};

mod slice_file;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct Checked<'a> {
    passed: bool,
    capture: &'a std::path::Path,
    check: &'a CheckReport,
}

/// Checks a capture and prints the report, or keeps what a slice of it shows.
pub fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    if is_program(&arguments.file) {
        return check_program::run(arguments);
    }
    arguments.program.refuse_for_moves()?;
    if arguments.path_only {
        return Err(Failure::input("--path-only is an option of G-code programs"));
    }
    let survey = job::survey(job::load(&arguments.file, arguments.fit_ns)?, |_| Ok(()))?;
    let name = format!("check {} {}", arguments.capture.display(), arguments.file.display());
    let mut junit = JunitFile::begin(arguments.junit.as_deref(), name)?;
    let out = arguments.out.as_deref().map(OutputFile::claim).transpose()?;
    let map =
        SignalMap::parse(&arguments.map).map_err(|error| Failure::input(error.to_string()))?;
    let names: Vec<&str> = survey.machine().axes.iter().map(|axis| axis.name.as_str()).collect();
    let check = Check::new(arguments, &survey, &names, &map)?;
    if let (Some(shard), Some(out)) = (arguments.slice, out) {
        return check.slice(shard, out);
    }
    let report = if arguments.merge.is_empty() { check.whole()? } else { check.merged()? };
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

/// A capture, and what it is checked against.
struct Check<'a> {
    arguments: &'a CheckArguments,
    survey: &'a Survey,
    capture: Capture<'a>,
    origin: Origin,
}

impl<'a> Check<'a> {
    fn new(
        arguments: &'a CheckArguments,
        survey: &'a Survey,
        names: &'a [&'a str],
        map: &'a SignalMap,
    ) -> Result<Self, Failure> {
        job::fits_a_capture(survey)?;
        let timebase = survey.build().timebase;
        let failed = |error| unusable(arguments, error);
        let capture = Capture::new(&arguments.capture, names, map).map_err(failed)?;
        let own = capture.open().map_err(failed)?.own();
        let origin = origin(arguments, own, &timebase)?;
        uncertain_by_less_than_a_period(arguments.slack_ns, survey)?;
        Ok(Self { arguments, survey, capture, origin })
    }

    /// A new pass through the moves.
    fn setup(&self) -> Setup<'a> {
        // The timelines end with this function, so that only the checker keeps a place in the plan.
        let Pass { timelines, courses, .. } = self.survey.begin();
        let mut setup = job::check_setup(self.survey, &timelines, courses, self.origin);
        setup.slack_ps = self.arguments.slack_ns.saturating_mul(1000);
        setup
    }

    /// Checks the whole capture.
    fn whole(&self) -> Result<CheckReport, Failure> {
        let failed = |error| unusable(self.arguments, error);
        let reader = self.capture.open().map_err(failed)?;
        let (played, report) = check_beside(self.setup(), |mut checker| reader.play(&mut checker));
        self.survey.whole()?;
        self.overlap(played.map_err(failed)?.end_ps)?;
        Ok(report)
    }

    /// Checks a slice and keeps it in a file.
    fn slice(&self, shard: Shard, out: OutputClaim) -> Result<(), Failure> {
        let checked = self.capture.check_slice(|| self.setup(), shard.number, shard.count);
        self.survey.whole()?;
        let slice = checked.map_err(|error| unusable(self.arguments, error))?;
        let (from, to) = slice.bytes();
        let mut out = OutputFile::begin(out)?;
        out.text(&Slices::text(slice, self.settings()?)?)?;
        let path = out.keep()?;
        output::print(&format!(
            "slice {shard}: bytes {from} to {to} of the capture are in {}; --merge gives the verdict\n",
            path.display()
        ))
    }

    /// Merges all slices.
    fn merged(&self) -> Result<CheckReport, Failure> {
        let mut slices = Slices::default();
        self.arguments.merge.iter().try_for_each(|file| slices.add(file))?;
        let slices = slices.in_order(&self.settings()?)?;
        let merged = self.capture.merge(self.setup(), &slices);
        self.survey.whole()?;
        let merged = merged.map_err(|error| unusable(self.arguments, error))?;
        self.overlap(merged.end_ps)?;
        for number in merged.again {
            let _ = writeln!(
                io::stderr(),
                "note: slice {number} did not begin as the slices before it ended, and was checked again"
            );
        }
        Ok(merged.report)
    }

    /// What decides the report besides the capture.
    fn settings(&self) -> Result<SliceSettings, Failure> {
        let CheckArguments { map, origin_ps, slack_ns, fit_ns, file, .. } = self.arguments;
        let mut options = map.clone();
        options.sort();
        options.extend([format!("{origin_ps:?}"), format!("{slack_ns}"), format!("{fit_ns:?}")]);
        let machine = format!("{:?}", self.survey.machine());
        let bytes = carrystep_files::open(file)
            .map_err(|error| Failure::input(error.to_string()))?
            .chain(machine.as_bytes());
        let moves = sha256_of(bytes)
            .map_err(|error| Failure::input(format!("{}: {error}", file.display())))?;
        Ok(SliceSettings::new(options, moves))
    }

    /// Refuses an origin with which no move overlaps the capture, which ends at `end_ps`.
    fn overlap(&self, end_ps: u64) -> Result<(), Failure> {
        let Origin::Fixed { ps } = self.origin else { return Ok(()) };
        let capture = self.arguments.capture.display();
        overlap(ps, end_ps, self.survey)
            .map_err(|reason| Failure::input(format!("{capture}: {reason}")))
    }
}

impl From<SliceFault> for Failure {
    fn from(error: SliceFault) -> Self {
        Self::input(error.to_string())
    }
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

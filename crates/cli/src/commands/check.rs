//! `carrystep check`: any VCD against a move file.

use crate::arguments::Check;
use crate::failure::{Failure, refused};
use crate::junit::JunitFile;
use crate::{job, output};
use carrystep_plan::plan;
use carrystep_spec::{MoveFile, Timebase};
use carrystep_trace::{Checker, Origin, Report, SignalMap, TraceError, VcdReader};
use schemars::JsonSchema;
use serde::Serialize;
use std::io::BufReader;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct Checked<'a> {
    passed: bool,
    capture: &'a std::path::Path,
    check: &'a Report,
}

/// Checks a capture.
pub fn run(arguments: &Check) -> Result<(), Failure> {
    let file = job::load(&arguments.file, arguments.fit_ns)?;
    let plan = plan::<f64>(&file).map_err(|error| refused(&file, &error))?;
    let timelines = plan.timelines();
    let name = format!("check {} {}", arguments.capture.display(), arguments.file.display());
    let mut junit = JunitFile::begin(arguments.junit.as_deref(), name)?;
    let report = read(arguments, &file, &plan, &timelines)?;
    if let Some(mut junit) = junit.take() {
        for axis in &report.axes {
            junit.case(format!("axis {}", axis.axis), &axis.failures);
        }
        junit.keep()?;
    }
    if arguments.json {
        output::print_json(&Checked { passed: report.passed(), capture: &arguments.capture, check: &report })?;
    } else {
        output::print(&report.to_string())?;
    }
    if report.passed() { Ok(()) } else { Err(Failure::Check) }
}

fn read(
    arguments: &Check,
    file: &MoveFile,
    plan: &carrystep_plan::Plan,
    timelines: &[carrystep_profile::Timeline],
) -> Result<Report, Failure> {
    job::fits_a_capture(plan)?;
    let unusable = |error: String| Failure::input(format!("{}: {error}", arguments.capture.display()));
    let capture = carrystep_files::open(&arguments.capture).map_err(|error| Failure::input(error.to_string()))?;
    let map = SignalMap::parse(&arguments.map).map_err(|error| Failure::input(error.to_string()))?;
    let names: Vec<&str> = file.machine.axes.iter().map(|axis| axis.name.as_str()).collect();
    let reader = VcdReader::new(BufReader::new(capture), &names, &map).map_err(|error| unusable(error.to_string()))?;
    if let Some(own) = reader.own().filter(|own| own.timebase != plan.build.timebase) {
        return Err(unusable(format!(
            "recorded from gateware with {}, but the machine of {} has {}",
            figures(&own.timebase),
            arguments.file.display(),
            figures(&plan.build.timebase)
        )));
    }
    let origin = match (arguments.origin_ps, reader.own()) {
        (Some(ps), _) => Origin::Fixed { ps },
        (None, Some(own)) => Origin::Known { ps: own.origin_ps },
        (None, None) => Origin::Midpoint,
    };
    let mut setup = job::check_setup(file, plan, timelines, origin);
    setup.slack_ps = arguments.slack_ns.saturating_mul(1000);
    let mut checker = Checker::new(setup);
    reader.play(&mut checker).map_err(|error| match error {
        TraceError::Read(error) => unusable(error.to_string()),
        other => other.into(),
    })?;
    Ok(checker.finish())
}

/// What makes two builds' time the same.
fn figures(timebase: &Timebase) -> String {
    format!("clock_hz = {}, tick_ns = {}, phases = {}", timebase.clock_hz(), timebase.tick_ns(), timebase.phases())
}

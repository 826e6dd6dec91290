//! `carrystep sweep`: many machines and moves over all processors, or the reports of many shards as
//! one.

use crate::arguments::{Core, Sweep};
use crate::failure::Failure;
use crate::junit::JunitFile;
use crate::wanted::Wanted;
use crate::{interrupt, job, output};
use carrystep_check::AxisReport;
use carrystep_plan::{PlanError, plan};
use carrystep_simulators::Level;
use carrystep_sweep::{Case, CaseVerdict, SweepError, SweepFile, SweepReport};
use indicatif::{ProgressBar, ProgressDrawTarget};
use std::collections::BTreeMap;
use std::path::Path;

/// Runs a shard, or merges reports, and prints the report.
pub fn run(arguments: &Sweep) -> Result<(), Failure> {
    let name = arguments
        .file
        .as_ref()
        .map_or("sweep".to_owned(), |file| format!("sweep {}", file.display()));
    let junit = JunitFile::begin(arguments.junit.as_deref(), name)?;
    let report = match &arguments.file {
        Some(file) => {
            let sweep = SweepFile::load(file, arguments.sample, arguments.seed)?;
            let cases = arguments.shard.cases(sweep.cases()).count() as u64;
            let bar =
                ProgressBar::with_draw_target(Some(cases), ProgressDrawTarget::stderr_with_hz(10));
            let report = carrystep_sweep::run(
                &sweep,
                arguments.shard,
                arguments.core.name(),
                |case| judge(case, arguments.core),
                || bar.inc(1),
            );
            bar.finish_and_clear();
            // After an interrupt, the remaining cases have not been judged.
            interrupt::check()?;
            report
        }
        None => SweepReport::merge(
            arguments.merge.iter().map(|path| read(path)).collect::<Result<Vec<_>, _>>()?,
        )?,
    };
    if let Some(junit) = junit {
        cases(junit, &report)?;
    }
    if arguments.json {
        output::print_json(&report)?;
    } else {
        output::print(&report.to_string())?;
    }
    match report.passed {
        Some(true) => Ok(()),
        Some(false) => Err(Failure::Check),
        None => Err(Failure::NothingTried),
    }
}

/// Writes one test case for the whole sweep and one for each failed case that the report lists.
fn cases(mut junit: JunitFile, report: &SweepReport) -> Result<(), Failure> {
    let SweepReport { passed, cases_passed, cases_refused, cases_failed, .. } = report;
    let counts = format!("{cases_passed} passed, {cases_refused} refused, {cases_failed} failed");
    let wrong = if *passed == Some(true) { Vec::new() } else { vec![counts] };
    junit.case("all cases", &wrong);
    for failed in &report.failures {
        junit.case(
            format!("case {}", failed.case),
            &[format!("{}: {}", failed.filled(), failed.message)],
        );
    }
    junit.keep()
}

fn read(path: &Path) -> Result<SweepReport, Failure> {
    let wrong = |error: String| Failure::input(format!("{}: {error}", path.display()));
    let text =
        carrystep_files::read_text(path).map_err(|error| Failure::input(error.to_string()))?;
    serde_json::from_slice(&text).map_err(|error| wrong(format!("no report of a sweep: {error}")))
}

/// Plans, simulates and checks a case.
fn judge(case: &Case, core: Core) -> CaseVerdict {
    let Ok(file) = &case.file else { return CaseVerdict::Failed("no move file".to_owned()) };
    let plan = match plan::<f64>(file) {
        Ok(plan) => plan,
        Err(error @ PlanError::Broken { .. }) => return CaseVerdict::Failed(error.to_string()),
        Err(error) => return CaseVerdict::Refused(error.to_string()),
    };
    match job::run(file, &plan, core, Level::Fast, &Wanted::default()) {
        Ok(done) if done.passed => CaseVerdict::Passed(figures(&done)),
        Ok(done) => {
            let first = done.check.failures().next();
            CaseVerdict::Failed(
                first.map_or_else(|| format!("faults: {}", done.faults), str::to_owned),
            )
        }
        Err(failure) => CaseVerdict::Failed(failure.message()),
    }
}

/// The worst figure of all axes, each as a fraction of its limit: 1 is at the limit.
fn figures(done: &job::RunResult) -> BTreeMap<&'static str, f64> {
    let needed = |required: f64, found: Option<f64>| found.map(|found| required / found);
    let early = |axis: &AxisReport| axis.error_min_ns.map(|error| -error / axis.error_bound_ns);
    let late = |axis: &AxisReport| axis.error_max_ns.map(|error| error / axis.error_bound_ns);
    let mut worst = BTreeMap::new();
    let mut add = |name, part: Option<f64>| {
        if let Some(part) = part {
            let old = worst.entry(name).or_insert(part);
            *old = part.max(*old);
        }
    };
    for axis in &done.check.axes {
        add("early", early(axis));
        add("late", late(axis));
        add("step high", needed(axis.step_high_required_ns, axis.step_high_min_ns));
        add("step low", needed(axis.step_low_required_ns, axis.step_low_min_ns));
        add("dir set-up", needed(axis.dir_setup_required_ns, axis.dir_setup_min_ns));
        add("dir hold", needed(axis.dir_hold_required_ns, axis.dir_hold_min_ns));
    }
    for limits in &done.limits.axes {
        add("speed", Some(limits.speed_steps_per_s / limits.speed_limit_steps_per_s));
        add(
            "acceleration",
            Some(limits.acceleration_steps_per_s2 / limits.acceleration_limit_steps_per_s2),
        );
    }
    worst
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Input(error) => Self::Input(error),
            other => Self::input(other.to_string()),
        }
    }
}

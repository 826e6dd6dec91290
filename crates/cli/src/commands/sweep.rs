//! `carrystep sweep`: many machines and moves over all processors, the reports of many shards as
//! one, or the files with which a cluster runs the shards.

mod cluster;
mod judge;

use crate::arguments::Sweep;
use crate::failure::Failure;
use crate::junit::JunitFile;
use crate::output::OutputFile;
use crate::{executable, interrupt, output};
use carrystep_sweep::{
    JudgedBy, KeptShard, Part, Progress, SweepError, SweepFile, SweepReport, run as run_cases,
};
pub use cluster::WrittenForCluster;
use indicatif::{ProgressBar, ProgressDrawTarget};
use std::ops::ControlFlow;
use std::path::Path;

/// Runs a shard, merges reports or writes files for a cluster, and prints the report.
pub fn run(arguments: &Sweep) -> Result<(), Failure> {
    if let Some(file) = &arguments.file
        && let Some(scheduler) = cluster::Scheduler::of(arguments)
    {
        return cluster::write(arguments, file, &scheduler);
    }
    let name = arguments
        .file
        .as_ref()
        .map_or("sweep".to_owned(), |file| format!("sweep {}", file.display()));
    let junit = JunitFile::begin(arguments.junit.as_deref(), name)?;
    let written = arguments.report.as_deref().map(OutputFile::create).transpose()?;
    let report = match &arguments.file {
        Some(file) => {
            let sweep = SweepFile::load(file, arguments.sample, arguments.seed)?;
            shard(arguments, &sweep)?
        }
        None => {
            let parts = arguments.merge.iter().map(|path| Part::read(path));
            SweepReport::merge(parts.collect::<Result<Vec<_>, _>>()?)?
        }
    };
    if let Some(junit) = junit {
        cases(junit, &report)?;
    }
    if let Some(mut written) = written {
        written.text(&output::json_text(&report)?)?;
        written.keep()?;
    }
    if arguments.json {
        output::print_json(&report)?;
    } else {
        output::print(&report.to_string())?;
    }
    match report.passed {
        _ if arguments.no_verdict => Ok(()),
        Some(true) => Ok(()),
        Some(false) => Err(Failure::Check),
        None => Err(Failure::NothingTried),
    }
}

/// Judges the cases of a shard, from where an earlier run has stopped.
fn shard(arguments: &Sweep, sweep: &SweepFile) -> Result<SweepReport, Failure> {
    let build = executable::build()?;
    let (core, carrystep) = (arguments.core.name(), env!("CARGO_PKG_VERSION"));
    let by = JudgedBy { core, carrystep, build: &build };
    let fresh = Progress::new(sweep, arguments.shard, by);
    let (mut kept, progress) = match &arguments.keep {
        Some(path) => {
            let (kept, progress) = KeptShard::open(path, fresh)?;
            (Some(kept), progress)
        }
        None => (None, fresh),
    };
    if progress.is_complete() {
        return Ok(progress.into_report());
    }
    interrupt::watch();
    let target = ProgressDrawTarget::stderr_with_hz(10);
    let bar = ProgressBar::with_draw_target(Some(progress.cases()), target);
    bar.set_position(progress.cases_done());
    let judged = run_cases(
        sweep,
        progress,
        |case| {
            let verdict = judge::judge(case, arguments.core);
            // An interrupt ends the simulation of this case, so its verdict has no meaning.
            if interrupt::is_asked() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(verdict)
            }
        },
        |progress| {
            bar.inc(1);
            kept.as_mut().map_or(Ok(()), |kept| kept.save_from_time_to_time(progress))
        },
    );
    bar.finish_and_clear();
    let progress = judged?;
    if let Some(kept) = &mut kept {
        kept.save(&progress)?;
    }
    if progress.is_complete() {
        return Ok(progress.into_report());
    }
    Err(match &kept {
        Some(kept) => stopped(&progress, kept.path()),
        None => Failure::Run("interrupted: nothing is kept".to_owned()),
    })
}

/// The failure of an interrupted run that keeps its progress.
fn stopped(progress: &Progress, path: &Path) -> Failure {
    let (done, all, path) = (progress.cases_done(), progress.cases(), path.display());
    Failure::Run(format!(
        "interrupted: {done} of {all} cases are kept in {path}; the same command continues with the others"
    ))
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

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Input(error) => Self::Input(error),
            other => Self::input(other.to_string()),
        }
    }
}

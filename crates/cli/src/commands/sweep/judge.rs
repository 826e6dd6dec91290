//! The judgement of one case of a sweep.

use crate::arguments::Core;
use crate::job;
use crate::recorded::MoveRecorder;
use crate::wanted::Wanted;
use carrystep_check::AxisReport;
use carrystep_plan::{PlanError, Survey, plan};
use carrystep_report::Detail;
use carrystep_simulators::Level;
use carrystep_sweep::{Case, CaseVerdict};
use std::collections::BTreeMap;

/// Plans, simulates and checks a case.
pub fn judge(case: &Case, core: Core) -> CaseVerdict {
    let Ok(file) = &case.file else { return CaseVerdict::Failed("no move file".to_owned()) };
    let plan = match plan::<f64>(file) {
        Ok(plan) => plan,
        Err(error @ PlanError::Broken { .. }) => return CaseVerdict::Failed(error.to_string()),
        Err(error) => return CaseVerdict::Refused(error.to_string()),
    };
    let mut recorder = MoveRecorder::new(&file.machine, Detail::Figures);
    plan.moves.iter().for_each(|planned| recorder.add(planned));
    let recorded = recorder.finish();
    let survey = Survey::of(file.clone().into(), plan);
    match job::run((&survey, &recorded), core, Level::Fast, &Wanted::default()) {
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

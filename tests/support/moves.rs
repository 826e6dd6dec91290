//! Move files and golden cases as programs for the levels.

use crate::golden::Case;
use carrystep_check::{AxisSetup, Checker, Origin, Report, Setup};
use carrystep_core::{AXES, Build, Command, Program, Segment};
use carrystep_files::MoveFile;
use carrystep_plan::Plan;
use carrystep_profile::{Line, Timeline};
use carrystep_simulators::pins::PinFeed;
use carrystep_simulators::{Job, Level};
use std::path::Path;

/// The root folder of the workspace.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ is in the workspace")
}

/// The plan of the demo.
pub fn demo() -> Plan {
    shipped("demo").1
}

/// The plan of a file with every profile, free and straight.
pub fn curves() -> Plan {
    shipped("curves").1
}

/// A move file from `sim/`, and its plan.
pub fn shipped(name: &str) -> (MoveFile, Plan) {
    let file = MoveFile::load(&root().join("sim").join(name).with_extension("toml")).expect("a shipped move file");
    let plan = carrystep_plan::plan::<f64>(&file).expect("a shipped plan");
    (file, plan)
}

/// Golden cases side by side, case i on axis i, started in one tick; and the greatest number of
/// ticks of a case.
pub fn side_by_side(cases: &[&Case]) -> (Program, u64) {
    assert!(cases.len() <= AXES);
    let mut due: Vec<(u64, u8, Segment)> = Vec::new();
    for (axis, case) in (0..).zip(cases) {
        let mut tick = 0;
        for segment in case.segments() {
            due.push((tick, axis, segment));
            tick += u64::from(segment.ticks);
        }
    }
    due.sort_by_key(|&(tick, axis, _)| (tick, axis));
    let mut program: Program = due.into_iter().map(|(_, axis, segment)| Command::Segment { axis, segment }).collect();
    program.insert(cases.len(), Command::Start { mask: (1 << cases.len()) - 1 });
    (program, cases.iter().map(|case| case.total_ticks).max().unwrap_or(0))
}

/// Runs a plan's program, or another one instead, on the fast model and checks pins and straight
/// lines as `carrystep simulate` does.
pub fn check(file: &MoveFile, plan: &Plan, lines: &[Line], program: &Program, build: &Build) -> Report {
    let timelines = plan.timelines();
    let job = Job::new(build, program, plan.total_ticks());
    let mut checker = Checker::new(Setup { lines: lines.to_vec(), ..check_setup(file, plan, &timelines, &job) });
    let mut feed = PinFeed::new(build.timebase, timelines.len(), &mut checker);
    let outcome = carrystep_simulators::run(Level::Fast, &job, &mut |cycle, outputs| feed.observe(cycle, outputs));
    feed.end(outcome.expect("the model").clocks).expect("the checker");
    checker.finish()
}

/// The setup of the checker for a planned move file in a run of `job`.
fn check_setup<'a>(file: &'a MoveFile, plan: &Plan, timelines: &'a [Timeline], job: &Job<'_>) -> Setup<'a> {
    let time = plan.build.timebase;
    let load = carrystep_simulators::origin(job).expect("the program starts");
    let axis = |(i, (axis, timeline)): (usize, (&'a carrystep_files::Axis, &'a Timeline))| {
        let steps = plan.moves.iter().map(|m| m.axes[i].steps);
        AxisSetup {
            name: &axis.name,
            unit: Some(&axis.unit),
            timeline,
            pins_ns: axis.pins_ns,
            expected_pulses: steps.clone().map(i64::unsigned_abs).sum(),
            expected_position: steps.sum(),
        }
    };
    Setup {
        timebase: time,
        phase: plan.build.phase,
        axes: file.machine.axes.iter().zip(timelines).enumerate().map(axis).collect(),
        lines: plan.lines(),
        origin: Origin::Known { ps: time.clock_to_ps(load + time.latency_clocks()).cast_signed() },
        slack_ps: 0,
    }
}

//! Move files and golden cases as programs for the levels.

use crate::golden::Case;
use carrystep_check::{AxisSetup, CheckReport, Checker, Origin, Setup};
use carrystep_core::{AXES, Build, Command, EngineBuild, Program, Segment};
use carrystep_files::{Machine, MoveFile, SourceText};
use carrystep_plan::Plan;
use carrystep_profile::Course;
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

/// The demo's moves at 48 MHz: a clock that only the parallel core takes, so its levels are through
/// sooner.
pub fn demo_at_48_mhz() -> Plan {
    let read = |name: &str| {
        std::fs::read_to_string(root().join("sim").join(name)).expect("a shipped file")
    };
    let moves = read("demo.toml").replace("machine_file = \"six-axis.toml\"", "");
    let text =
        read("six-axis.toml").replace("clock_hz = 80_000_000", "clock_hz = 48_000_000") + &moves;
    planned_at("demo", text, 48_000_000)
}

/// Every profile, free and straight, planned.
pub fn curves() -> Plan {
    shipped("curves").1
}

/// The same at 6.4 MHz: a clock that only the parallel core takes.
pub fn curves_at_6_mhz() -> Plan {
    let text = std::fs::read_to_string(root().join("sim/curves.toml")).expect("a shipped file");
    planned_at("curves", text.replace("clock_hz = 16_000_000", "clock_hz = 6_400_000"), 6_400_000)
}

/// A text that is a move file of this clock, planned.
fn planned_at(name: &str, text: String, clock_hz: u64) -> Plan {
    let file = MoveFile::from_source(SourceText { path: name.into(), text: text.into() })
        .expect("a fine move file");
    assert_eq!(file.machine.timebase.clock_hz(), clock_hz, "{name}");
    carrystep_plan::plan::<f64>(&file).expect("a plan")
}

/// A short move of each axis of the shipped machine, or that move and one in which axes go back, and
/// its engine: for levels that take microseconds a clock.
pub fn nudge(and_back: bool) -> (EngineBuild, Plan) {
    let machine = Machine::load(&root().join("sim/six-axis.toml")).expect("the shipped machine");
    let engine = machine.engine();
    let to = "[[move]]\nprofile = \"ranade\"\nto = { x = 0.025, y = -0.025, z = 0.005, a = 0.3, b = -0.05, c = 1 }\n";
    let back = to.replace("x = 0.025, y = -0.025", "x = -0.025, y = 0.025");
    let text = if and_back { format!("{to}{back}") } else { to.to_owned() };
    let source = SourceText { path: "nudge.toml".into(), text: text.into() };
    let file = MoveFile::of_moves(machine, source).expect("fine moves");
    (engine, carrystep_plan::plan::<f64>(&file).expect("a plan"))
}

/// Six axes on six adders out and back at 1.9 million steps/s each, in ticks of 250 ns at 64 MHz.
pub fn six_fast_axes() -> (MoveFile, Plan) {
    let mut text =
        "[machine]\nclock_hz = 64_000_000\ntick_ns = 250\nphases = 4\nadders = 6\n".to_owned();
    for name in ["x", "y", "z", "a", "b", "c"] {
        text += &format!(
            "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = 1\nspeed_limit = 1.9e6\n\
             accel_limit = 1.5e9\nstep_ns = 100\ngap_ns = 100\nsetup_ns = 200\nhold_ns = 200\n"
        );
    }
    for to in ["6000, y = -6000, z = 5000", "-6000, y = 6000, z = -5000"] {
        let others = if to.starts_with('-') { "a = 1, b = -5999" } else { "a = -1, b = 5999" };
        text += &format!(
            "[[move]]\nprofile = \"trapezoid\"\nto = {{ x = {to}, {others}, c = 6000 }}\n"
        );
    }
    let source = SourceText { path: "fast.toml".into(), text: text.into() };
    let file = MoveFile::from_source(source).expect("a fine move file");
    let plan = carrystep_plan::plan::<f64>(&file).expect("a plan");
    (file, plan)
}

/// The engine of a move file that is shipped in `sim/`, and the plan.
pub fn on_the_engine(name: &str) -> (EngineBuild, Plan) {
    let (file, plan) = shipped(name);
    (file.machine.engine(), plan)
}

/// A move file that is shipped in `sim/`, and its plan.
pub fn shipped(name: &str) -> (MoveFile, Plan) {
    let file = MoveFile::load(&root().join("sim").join(name).with_extension("toml"))
        .expect("a shipped move file");
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
    let mut program: Program =
        due.into_iter().map(|(_, axis, segment)| Command::Segment { axis, segment }).collect();
    program.insert(cases.len(), Command::Start { mask: (1 << cases.len()) - 1 });
    (program, cases.iter().map(|case| case.total_ticks).max().unwrap_or(0))
}

/// Runs a plan's program, or another one instead, on the fast model and checks pins and straight
/// lines as `carrystep simulate` does.
pub fn check(
    file: &MoveFile,
    plan: &Plan,
    courses: &[Course],
    program: &Program,
    build: &Build,
) -> CheckReport {
    let job = Job::new(build, program, plan.total_ticks());
    let setup = check_setup(file, plan, &job);
    let mut checker = Checker::new(Setup { courses: Some(courses.to_vec().into()), ..setup });
    let mut feed = PinFeed::new(build.timebase, file.machine.axes.len(), &mut checker);
    let outcome = carrystep_simulators::run(Level::Fast, &job, &mut |cycle, outputs| {
        feed.observe(cycle, outputs);
    });
    feed.end(outcome.expect("the model").clocks).expect("the checker");
    checker.finish()
}

/// The setup of the checker for a planned move file in a run of `job`.
fn check_setup<'a>(file: &'a MoveFile, plan: &Plan, job: &Job<'_>) -> Setup<'a> {
    let time = plan.build.timebase;
    let load = carrystep_simulators::origin(job).expect("the program starts");
    let axes = file.machine.axes.iter().zip(plan.timelines());
    let axes = axes.map(|(axis, timeline)| AxisSetup {
        name: &axis.name,
        unit: Some(&axis.unit),
        travel: timeline.legs().collect(),
        timeline,
        pins_ns: axis.pins_ns,
    });
    Setup {
        timebase: time,
        phase: plan.build.phase,
        axes: axes.collect(),
        courses: Some(plan.courses().into()),
        origin: Origin::Known { ps: time.clock_to_ps(load + time.latency_clocks()).cast_signed() },
        slack_ps: 0,
    }
}

//! The builds that are proved: the shipped machines from their committed Verilog, and small and
//! extreme builds.

use super::Case;
use crate::{lockstep, moves};
use carrystep_core::build::MAX_CLOCKS;
use carrystep_core::engine::{
    CAUSES, Cause, EngineBuild, Guard, InputRow, Latch, LimitWiring, Outputs,
};
use carrystep_core::{AXES, Build, PinTiming, StartPhase, Timebase};
use carrystep_files::Machine;
use carrystep_hdl::parameters::{DIR_HOLD, DIR_SETUP, STEP_HIGH, STEP_LOW};
use std::sync::{Arc, Mutex};

/// The shipped machine: its build, and its committed Verilog in `hdl-out/`.
pub fn shipped() -> (Build, Arc<str>) {
    let file = moves::root().join("hdl-out/core/carrystep_parallel_6.v");
    let text = std::fs::read_to_string(file).expect("the committed Verilog");
    (moves::demo().build, text.into())
}

/// A build with the fewest clocks in a tick, and pin timings in which every timer is at times the
/// one that forbids an edge.
pub fn small(phases: u32) -> (Build, Arc<str>) {
    small_from(phases, StartPhase::Half)
}

/// The same build with another start value of P.
pub fn small_from(phases: u32, start: StartPhase) -> (Build, Arc<str>) {
    let pins = |step_high, step_low, dir_setup, dir_hold| PinTiming {
        step_high,
        step_low,
        dir_setup,
        dir_hold,
    };
    let pins: [PinTiming; AXES] = [
        pins(2, 3, 4, 3),
        PinTiming::SHORTEST,
        pins(8, 8, 20, 1),
        pins(1, 37, 3, 40),
        pins(19, 1, 1, 2),
        pins(MAX_CLOCKS, MAX_CLOCKS, MAX_CLOCKS, MAX_CLOCKS),
    ];
    let build = Build { pins, ..lockstep::quick_build(phases, start) };
    let text =
        carrystep_verilog::parallel_verilog(&build, AXES, "a proof").expect("the core").into();
    (build, text)
}

/// An engine: its build, and its Verilog.
pub type BuiltEngine = (EngineBuild, Arc<str>);

/// The shipped engine: its build, and the Verilog in `hdl-out/` as it is committed.
pub fn shipped_engine() -> BuiltEngine {
    let root = moves::root();
    let text = std::fs::read_to_string(root.join("hdl-out/core/carrystep_engine.v"))
        .expect("the committed Verilog");
    let machine = Machine::load(&root.join("sim/six-axis.toml")).expect("the engine's machine");
    (machine.engine(), text.into())
}

/// An engine with its Verilog. Proofs of several modules are about the same one, and the mutants ask
/// for all of them again: each is written once.
pub(super) fn exported(build: EngineBuild) -> BuiltEngine {
    static WRITTEN: Mutex<Vec<BuiltEngine>> = Mutex::new(Vec::new());
    let mut written = WRITTEN.lock().expect("no test has failed in here");
    if let Some(found) = written.iter().find(|(known, _)| *known == build) {
        return found.clone();
    }
    let text = carrystep_verilog::engine_verilog(&build, "a proof").expect("the engine").into();
    written.push((build, text));
    written[written.len() - 1].clone()
}

/// An engine with this many axes and clocks per tick, with extreme pin timings, a guard with small
/// figures, and cuts.
pub fn small_engine(
    axes: usize,
    clocks: u32,
    phases: u32,
    limits: LimitWiring,
) -> (EngineBuild, Arc<str>) {
    exported(small_build(axes, clocks, phases, limits))
}

fn small_build(axes: usize, clocks: u32, phases: u32, limits: LimitWiring) -> EngineBuild {
    let timebase =
        Timebase::new(u64::from(clocks) * 1_000_000, 1000, phases).expect("a fine timebase");
    let mut minimal = EngineBuild::minimal(&Build { timebase, ..small(phases).0 }, 1 << 40);
    minimal.pins.resize(axes, PinTiming::SHORTEST);
    minimal.guard.stop.resize(axes, 1 << 40);
    minimal.cuts = true;
    let low = limits != LimitWiring::Pair;
    let guard = Guard {
        round: 2,
        debounce: 2,
        watchdog: 2,
        enable: 2,
        limits,
        limit_freezes: low,
        ..minimal.guard.clone().active_low(low)
    };
    EngineBuild { guard, ..minimal }
}

/// As [`small_engine`], with limits at both ends and this number of adders.
pub fn engine_on_adders(axes: usize, adders: usize, clocks: u32, phases: u32) -> BuiltEngine {
    let small = small_build(axes, clocks, phases, LimitWiring::Pair);
    exported(EngineBuild { adders, ..small })
}

/// Engines with several adders in the shortest ticks: six axes on two and on six, eight on eight; and
/// six on two in a longer tick.
pub fn engines_on_adders() -> Vec<BuiltEngine> {
    let builds = [(6, 2, 42), (6, 6, 16), (8, 8, 16), (6, 2, 48)];
    builds.map(|(axes, adders, clocks)| engine_on_adders(axes, adders, clocks, 1)).into()
}

/// The parameter with the number of adders for `promises.sv`.
pub fn lanes(build: &EngineBuild) -> (&'static str, String) {
    ("LANES", build.adders.to_string())
}

/// The same with limits at both ends, with inputs in both rows, and with a latch of two looks.
pub fn engine_with_inputs(axes: usize, clocks: u32, phases: u32) -> (EngineBuild, Arc<str>) {
    let mut build = small_build(axes, clocks, phases, LimitWiring::Pair);
    build.guard.round = 4;
    build.guard.inputs = [InputRow { exist: 3, low: 1 }, InputRow { exist: 1, low: 1 }];
    build.guard.latches = vec![Latch::of_pin(false, 2)];
    exported(build)
}

/// The same engine of two axes with this number of latches, of one or two looks.
pub fn engine_with_latches(count: usize) -> (EngineBuild, Arc<str>) {
    let (mut build, _) = engine_with_inputs(2, 32, 4);
    let latch = |number: usize| Latch::of_pin(number == 1, 1 + (number as u8 & 1));
    build.guard.latches = (0..count).map(latch).collect();
    exported(build)
}

/// An engine of two axes on two adders, with one latch.
pub fn engine_with_latch_on_adders() -> BuiltEngine {
    let (build, _) = engine_with_latches(1);
    exported(EngineBuild { adders: 2, ..build })
}

/// An engine of six axes with these outputs, and a PWM with this divider.
pub fn engine_with_outputs(exist: u8, pwm_divider: u32) -> (EngineBuild, Arc<str>) {
    let mut build = small_build(6, 80, 4, LimitWiring::Pair);
    build.outputs = Outputs { exist, pwm_divider, off_at_ramps: true };
    exported(build)
}

/// The parameter with the number of axes for `promises.sv`.
pub fn axes(build: &EngineBuild) -> (&'static str, String) {
    ("AXES", build.axes().to_string())
}

/// The causes of a stop and their numbers for `promises.sv`, as a list that follows `localparam`.
pub fn causes() -> (&'static str, String) {
    let number = |cause: Cause| {
        let name = cause.name().replace('-', "_").to_uppercase();
        format!("{name}={}", cause as u8)
    };
    ("CAUSES", CAUSES.map(number).join(","))
}

/// The parameters with clocks and phases of a tick for `promises.sv`.
pub fn beat(time: &Timebase) -> Vec<(&'static str, String)> {
    vec![("CLOCKS", time.clocks_per_tick().to_string()), ("PHASES", time.phases().to_string())]
}

/// A name for a tick.
pub fn beat_name(time: &Timebase) -> String {
    format!("{} clocks in {} phases", time.clocks_per_tick(), time.phases())
}

/// One case for each pin timing of the builds. All are of one module of this kind, whose parameters
/// they are.
pub fn pin_cases(kind: &str, builds: &[(Vec<PinTiming>, Arc<str>)]) -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    for (pins, verilog) in builds {
        for pins in pins {
            let name = format!(
                "w{}_s{}_d{}_h{}",
                pins.step_high, pins.step_low, pins.dir_setup, pins.dir_hold
            );
            let numbers = [
                ("STEP_HIGH", pins.step_high),
                ("STEP_LOW", pins.step_low),
                ("DIR_SETUP", pins.dir_setup),
                ("DIR_HOLD", pins.dir_hold),
            ];
            let numbers =
                numbers.into_iter().map(|(name, clocks)| (name, clocks.to_string())).collect();
            if cases.iter().all(|case| case.name != name) {
                let (dut, parameters) = (kind.to_owned(), pin_parameters(pins));
                cases.push(Case { name, dut, parameters, verilog: verilog.clone(), numbers });
            }
        }
    }
    cases
}

/// The parameters of a pulser or shaper with this timing.
pub fn pin_parameters(pins: &PinTiming) -> Vec<(&'static str, u32)> {
    let &PinTiming { step_high, step_low, dir_setup, dir_hold } = pins;
    vec![
        (STEP_HIGH.name, step_high),
        (STEP_LOW.name, step_low),
        (DIR_SETUP.name, dir_setup),
        (DIR_HOLD.name, dir_hold),
    ]
}

//! The builds that are proved: the shipped machine's, from the committed text, and small and extreme ones.

use super::Case;
use crate::{lockstep, moves};
use carrystep_spec::build::MAX_CLOCKS;
use carrystep_spec::engine::{EngineBuild, Guard, Limits};
use carrystep_spec::{AXES, Build, Machine, PinTiming, StartPhase, Timebase};
use std::sync::Arc;

/// The shipped machine: its build, and the Verilog in `hdl-out/` as it is committed.
pub fn shipped() -> (Build, Arc<str>) {
    let file = moves::root().join("hdl-out/core/carrystep_six_axis.v");
    let text = std::fs::read_to_string(file).expect("the committed Verilog");
    (moves::demo().build, text.into())
}

/// The fewest clocks in a tick, and pins in which every timer is at times the one that forbids.
pub fn small(phases: u32) -> (Build, Arc<str>) {
    small_from(phases, StartPhase::Half)
}

/// The same, with P that starts elsewhere.
pub fn small_from(phases: u32, start: StartPhase) -> (Build, Arc<str>) {
    let pins = |width, gap, setup, hold| PinTiming { width, gap, setup, hold };
    let pins: [PinTiming; AXES] = [
        pins(2, 3, 4, 3),
        PinTiming::SHORTEST,
        pins(8, 8, 20, 1),
        pins(1, 37, 3, 40),
        pins(19, 1, 1, 2),
        pins(MAX_CLOCKS, MAX_CLOCKS, MAX_CLOCKS, MAX_CLOCKS),
    ];
    let build = Build { pins, ..lockstep::quick_build(phases, start) };
    let text = carrystep_export::six_axis_verilog(&build, "a proof").expect("the core").into();
    (build, text)
}

/// An engine: its build, and its Verilog.
pub type BuiltEngine = (EngineBuild, Arc<str>);

/// The shipped engine: its build, and the Verilog in `hdl-out/` as it is committed.
pub fn shipped_engine() -> BuiltEngine {
    let root = moves::root();
    let text = std::fs::read_to_string(root.join("hdl-out/core/carrystep_engine.v")).expect("the committed Verilog");
    let machine = Machine::load(&root.join("sim/six-axis.toml")).expect("the engine's machine");
    (machine.engine(), text.into())
}

/// An engine of so many axes, at a tick of so many clocks, with extreme pins, and a guard whose figures are small.
pub fn small_engine(axes: usize, clocks: u32, phases: u32, limits: Limits) -> (EngineBuild, Arc<str>) {
    let timebase = Timebase::new(u64::from(clocks) * 1_000_000, 1000, phases).expect("a fine timebase");
    let mut minimal = EngineBuild::minimal(&Build { timebase, ..small(phases).0 }, 1 << 40);
    minimal.pins.resize(axes, PinTiming::SHORTEST);
    minimal.guard.stop.resize(axes, 1 << 40);
    let low = limits != Limits::Pair;
    let guard = Guard {
        round: 2,
        debounce: 2,
        watchdog: 2,
        enable: 2,
        limits,
        limit_freezes: low,
        estop_low: low,
        limits_low: low,
        ..minimal.guard.clone()
    };
    let build = EngineBuild { guard, ..minimal };
    let text = carrystep_export::engine_verilog(&build, "a proof").expect("the engine").into();
    (build, text)
}

/// How many axes an engine has, as `promises.sv` takes it.
pub fn axes(build: &EngineBuild) -> (&'static str, String) {
    ("AXES", build.axes().to_string())
}

/// Clocks and phases of a tick, as `promises.sv` takes them.
pub fn beat(time: &Timebase) -> Vec<(&'static str, String)> {
    vec![("CLOCKS", time.clocks_per_tick().to_string()), ("PHASES", time.phases().to_string())]
}

/// A name for a tick.
pub fn beat_name(time: &Timebase) -> String {
    format!("{} clocks in {} phases", time.clocks_per_tick(), time.phases())
}

/// A case for each pin timing of the builds: the module of this kind that was exported for it.
pub fn pin_cases(kind: &str, builds: &[(Vec<PinTiming>, Arc<str>)]) -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    for (pins, verilog) in builds {
        for pins in pins {
            let name = format!("w{}_s{}_d{}_h{}", pins.width, pins.gap, pins.setup, pins.hold);
            let numbers = [("W", pins.width), ("S", pins.gap), ("D", pins.setup), ("H", pins.hold)];
            let numbers = numbers.into_iter().map(|(name, clocks)| (name, clocks.to_string())).collect();
            let dut = format!("{kind}_{name}");
            if cases.iter().all(|case| case.dut != dut) {
                cases.push(Case { name, dut, verilog: verilog.clone(), numbers });
            }
        }
    }
    cases
}

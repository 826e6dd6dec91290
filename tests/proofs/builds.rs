//! The builds that are proved: the shipped machine's, from the committed text, and small and extreme ones.

use crate::{lockstep, moves};
use carrystep_spec::build::MAX_CLOCKS;
use carrystep_spec::{AXES, Build, PinTiming, StartPhase};
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

/// Clocks and phases of a tick, as `promises.sv` takes them.
pub fn beat(build: &Build) -> Vec<(&'static str, String)> {
    let time = &build.timebase;
    vec![("CLOCKS", time.clocks_per_tick().to_string()), ("PHASES", time.phases().to_string())]
}

/// A name for a build's tick.
pub fn beat_name(build: &Build) -> String {
    format!("{} clocks in {} phases", build.timebase.clocks_per_tick(), build.timebase.phases())
}

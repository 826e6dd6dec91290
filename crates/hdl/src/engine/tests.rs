//! Checks which builds make an engine, and that yosys accepts the Verilog of the engines.

use super::*;
use crate::primitives::compiled_once::assert_sizes_agree;
use carrystep_core::{AXES, Build, PinTiming, StartPhase, Timebase};

fn build() -> EngineBuild {
    let timebase = Timebase::new(80_000_000, 1000, 16).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    EngineBuild::minimal(&build, 1 << 40)
}

/// Makes a build with this number of axes, whose tick is long enough for them.
fn of_axes(axes: usize) -> EngineBuild {
    let mut build = build();
    build.pins.resize(axes, PinTiming::SHORTEST);
    build.guard.stop.resize(axes, 1);
    build.timebase = Timebase::new(56_000_000, 2000, 16).unwrap();
    build
}

#[test]
fn statements_are_those_of_each_size() {
    assert_sizes_agree::<Engine<1, 0>>();
    assert_sizes_agree::<Engine<2, 1>>();
    assert_sizes_agree::<Engine<3, 1>>();
    assert_sizes_agree::<Engine<7, 0>>();
    assert_sizes_agree::<Engine<8, 1>>();
    parts_agree::<1>();
    parts_agree::<6>();
    parts_agree::<8>();
}

fn parts_agree<const N: usize>() {
    assert_sizes_agree::<TimeSlot<N>>();
    assert_sizes_agree::<Switches<N>>();
    assert_sizes_agree::<SeekControl<N>>();
    assert_sizes_agree::<Stops<N>>();
}

#[test]
fn engine_synthesizes() {
    crate::sim::assert_synthesizes(Engine::<1, 0>::new(&of_axes(1)).unwrap(), "carrystep_engine_1");
    crate::sim::assert_synthesizes(Engine::<6, 0>::new(&build()).unwrap(), "carrystep_engine_6");
    crate::sim::assert_synthesizes(Engine::<8, 0>::new(&of_axes(8)).unwrap(), "carrystep_engine_8");
}

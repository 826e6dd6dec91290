//! Checks that yosys accepts the Verilog of engines with several adders.

use super::*;
use crate::primitives::compiled_once::assert_sizes_agree;
use carrystep_core::{AXES, Build, PinTiming, StartPhase, Timebase};

#[test]
fn statements_are_those_of_each_size() {
    assert_sizes_agree::<WideEngine<3, 3>>();
    assert_sizes_agree::<WideEngine<6, 2>>();
    assert_sizes_agree::<LaneSeek<3, 3>>();
    assert_sizes_agree::<LaneSeek<6, 2>>();
    assert_sizes_agree::<Findings<3, 3>>();
    assert_sizes_agree::<Findings<6, 2>>();
    assert_sizes_agree::<LaneSlots<2>>();
    assert_sizes_agree::<LaneCounts<6>>();
}

#[test]
fn engines_with_several_adders_synthesize() {
    let timebase = Timebase::new(64_000_000, 1000, 16).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, 1 << 40);
    build.adders = 2;
    let two = WideEngine::<6, 2>::new(&build).unwrap();
    crate::sim::assert_synthesizes(*two, "carrystep_engine_on_2");
    build.adders = 6;
    let six = WideEngine::<6, 6>::new(&build).unwrap();
    crate::sim::assert_synthesizes(*six, "carrystep_engine_on_6");
}

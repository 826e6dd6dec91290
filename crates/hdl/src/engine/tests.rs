//! Checks that the statements of an engine fit each size, and that yosys accepts its Verilog.

#[path = "test_builds.rs"]
mod test_builds;

use super::*;
use crate::primitives::compiled_once::{assert_sizes_agree, assert_sizes_agree_of};
use test_builds::{build, of_axes};

#[test]
fn statements_are_those_of_each_size() {
    assert_sizes_agree::<Engine<1>>();
    // Without further latches.
    assert_sizes_agree_of(&Engine::<7>::new(&of_axes(7)).unwrap());
    parts_agree::<1>();
    parts_agree::<6>();
}

fn parts_agree<const N: usize>() {
    assert_sizes_agree::<TimeSlot<N>>();
    assert_sizes_agree::<Switches<N>>();
    assert_sizes_agree::<SeekControl<N>>();
    assert_sizes_agree::<Stops<N>>();
}

#[test]
fn engine_synthesizes() {
    crate::sim::assert_synthesizes(Engine::<1>::new(&of_axes(1)).unwrap(), "carrystep_engine_1");
    crate::sim::assert_synthesizes(Engine::<6>::new(&build()).unwrap(), "carrystep_engine_6");
    crate::sim::assert_synthesizes(Engine::<8>::new(&of_axes(8)).unwrap(), "carrystep_engine_8");
}

//! Checks which builds make an engine.
//!
//! These tests are outside the crate, as all that need [`engine`] or the simulations of an engine or
//! a link: those contain an engine of each shape, 26 of them, and the crate's own tests are compiled
//! without them.

#[path = "../src/engine/test_builds.rs"]
mod test_builds;

use carrystep_core::engine::EngineError;
use carrystep_core::{EngineBuild, Timebase};
use carrystep_hdl::{HdlError, engine};
use test_builds::{build, of_axes};

#[test]
fn engine_accepts_one_to_eight_axes() {
    for axes in 1..=8 {
        assert!(engine(&of_axes(axes)).is_ok(), "{axes} axes");
    }
    for axes in [0, 9] {
        assert_eq!(engine(&of_axes(axes)).err(), Some(HdlError::Engine(EngineError::Axes(axes))));
    }
}

#[test]
fn engine_rejects_a_tick_shorter_than_the_time_slots() {
    let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
    let refused = engine(&EngineBuild { timebase, ..build() });
    assert!(matches!(refused.err(), Some(HdlError::Engine(EngineError::Schedule { .. }))));
}

//! Checks which builds make an engine.
//!
//! These tests are outside the crate, as all that need [`engine`] or the simulations of an engine or
//! a link: those contain an engine of each shape, 26 of them, and the crate's own tests are compiled
//! without them.

use carrystep_core::engine::EngineError;
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_hdl::{HdlError, engine};

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

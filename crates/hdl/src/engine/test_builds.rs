//! Builds for tests of engines, of those in this crate and of those in crates/hdl/tests/engine.rs.

use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};

/// Makes a build of six axes with ticks of 1 us.
pub fn build() -> EngineBuild {
    let timebase = Timebase::new(80_000_000, 1000, 16).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    EngineBuild::minimal(&build, 1 << 40)
}

/// Makes a build with this number of axes, whose tick is long enough for them.
pub fn of_axes(axes: usize) -> EngineBuild {
    let mut build = build();
    build.pins.resize(axes, PinTiming::SHORTEST);
    build.guard.stop.resize(axes, 1);
    build.timebase = Timebase::new(56_000_000, 2000, 16).unwrap();
    build
}

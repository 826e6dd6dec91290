//! How far a run is, for whoever watches it from another thread.

use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};

/// What a run does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// It goes from clock to clock, and says at which it is.
    Runs,
    /// The model runs first, clock by clock: the Verilog is then compared with it.
    ModelRuns,
    /// The Verilog is compiled and compared; nobody knows how far that is.
    VerilogRuns,
}

/// The clock that a run has come to, and what it does.
#[derive(Debug, Default)]
pub struct HowFar {
    clock: AtomicU64,
    stage: AtomicU8,
}

impl HowFar {
    /// The run has come to this clock.
    pub fn at(&self, clock: u64) {
        self.clock.store(clock, Ordering::Relaxed);
    }

    /// The clock that the run has come to.
    pub fn clock(&self) -> u64 {
        self.clock.load(Ordering::Relaxed)
    }

    /// Another stage begins.
    pub(crate) fn begin(&self, stage: Stage) {
        self.at(0);
        self.stage.store(stage as u8, Ordering::Relaxed);
    }

    /// What the run does.
    pub fn stage(&self) -> Stage {
        match self.stage.load(Ordering::Relaxed) {
            1 => Stage::ModelRuns,
            2 => Stage::VerilogRuns,
            _ => Stage::Runs,
        }
    }
}

/// Tells whoever watches.
pub(crate) fn tell(how_far: Option<&HowFar>, clock: u64) {
    if let Some(how_far) = how_far {
        how_far.at(clock);
    }
}

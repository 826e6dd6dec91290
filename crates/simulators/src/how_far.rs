//! Progress of a run, which another thread can read.

use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};

/// Stage of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunStage {
    /// The simulation runs, and reports its clock.
    Runs,
    /// The model runs first, clock by clock. The Verilog will be compared with it.
    ModelRuns,
    /// The Verilog is compiled and compared; its progress is not known.
    VerilogRuns,
}

/// The clock that a run has reached, and its stage.
#[derive(Debug, Default)]
pub struct HowFar {
    clock: AtomicU64,
    stage: AtomicU8,
}

impl HowFar {
    /// Records that the run has reached this clock.
    pub fn at(&self, clock: u64) {
        self.clock.store(clock, Ordering::Relaxed);
    }

    /// The clock that the run has reached.
    pub fn clock(&self) -> u64 {
        self.clock.load(Ordering::Relaxed)
    }

    /// Begins another stage.
    pub(crate) fn begin(&self, stage: RunStage) {
        self.at(0);
        self.stage.store(stage as u8, Ordering::Relaxed);
    }

    /// The current stage.
    pub fn stage(&self) -> RunStage {
        match self.stage.load(Ordering::Relaxed) {
            1 => RunStage::ModelRuns,
            2 => RunStage::VerilogRuns,
            _ => RunStage::Runs,
        }
    }
}

/// Records the clock, if anybody watches the run.
pub(crate) fn tell(how_far: Option<&HowFar>, clock: u64) {
    if let Some(how_far) = how_far {
        how_far.at(clock);
    }
}

//! Access for the fast model: the readout after many clocks in which the axes only repeat their
//! additions. No step is discarded in them, no limit is found, nothing is cleared and no snapshot
//! is requested, and an axis that runs goes on running.

use super::Readout;
use super::counts::COMPARE_BEAT;
use crate::parts::shaper::ShaperState;
use carrystep_core::engine::TIME_SLOT_CLOCKS;

/// A run of clocks, from this clock of a tick on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Span {
    pub clock: u64,
    pub clocks: u64,
    pub per_tick: u64,
}

impl Span {
    /// Number of strobes in these clocks.
    pub const fn strobes(self) -> u64 {
        (self.clock + self.clocks) / self.per_tick
    }
}

impl Readout {
    /// Passes the counts of one axis through clocks in which the position and the discarded steps
    /// of its shaper are constant.
    pub(crate) fn follow(&mut self, axis: usize, shaper: &ShaperState, runs: bool, span: Span) {
        let compares = axis as u64 * u64::from(TIME_SLOT_CLOCKS) + u64::from(COMPARE_BEAT);
        let counts = &mut self.counts[axis];
        let mut strobes = span.strobes();
        let compared = span.clock > compares;
        if compared && strobes > 0 {
            counts.commit();
            strobes -= 1;
        } else if compared {
            return;
        }
        counts.follow(shaper, runs, strobes);
        if (span.clock + span.clocks) % span.per_tick > compares {
            counts.compare(shaper, runs);
        }
    }

    /// Adds the carries of an axis, forward less backward.
    pub(crate) fn carry(&mut self, axis: usize, carries: i32) {
        self.counts[axis].carry(carries);
    }

    /// Passes this many strobes.
    pub(crate) const fn pass(&mut self, strobes: u64) {
        if strobes > 0 {
            self.ticks = self.ticks.wrapping_add(strobes as u32);
            self.met = 0;
            self.takes = self.asked;
            self.asked = false;
        }
    }
}

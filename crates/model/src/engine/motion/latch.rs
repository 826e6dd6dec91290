//! The latch: it accepts an edge of its pin after some looks, one at each strobe, and marks the
//! tick whose words of state are latched. It must stay equal to "The latch" in
//! docs/clock-by-clock.md.

use carrystep_core::engine::{EngineInputs, Guard, Latch};

/// Greatest number of edges that are counted.
const MOST_EDGES: u8 = 15;

/// The registers of the latch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct LatchState {
    /// Synchronizer of the pin: two flip-flops, `first` and `now`.
    first: bool,
    now: bool,
    accepted: bool,
    count: u8,
    pub(super) armed: bool,
    pub(super) edges: u8,
    /// The words of state of this tick are latched.
    pub(super) latches: bool,
}

impl LatchState {
    /// Advances by one cycle.
    pub(super) fn clock(&mut self, guard: &Guard, inputs: &EngineInputs, strobe: bool) {
        let Some(Latch { low, looks }) = guard.latch else { return };
        if strobe {
            self.look(looks);
        }
        if inputs.latch_arm {
            (self.armed, self.edges) = (true, 0);
        }
        (self.now, self.first) = (self.first, inputs.latch != low);
    }

    /// Looks at the pin, at a strobe.
    fn look(&mut self, looks: u8) {
        let changes = self.now != self.accepted && self.count + 1 == looks;
        self.count = if self.now == self.accepted || changes { 0 } else { self.count + 1 };
        let edge = changes && self.now;
        if changes {
            self.accepted = self.now;
        }
        self.latches = edge && self.armed;
        if edge && !self.armed {
            self.edges = (self.edges + 1).min(MOST_EDGES);
        }
        self.armed &= !edge;
    }

    /// Returns to the state at configuration, but for the flip-flops.
    pub(super) fn forget(&mut self) {
        *self = Self { first: self.first, now: self.now, ..Self::default() };
    }
}

/// Access for the fast model, which passes many clocks at once.
impl LatchState {
    /// True if these inputs change nothing before the next strobe.
    pub(super) fn is_steady(&self, guard: &Guard, inputs: &EngineInputs) -> bool {
        guard.latch.is_none_or(|Latch { low, .. }| {
            let pin = inputs.latch != low;
            !inputs.latch_arm && self.first == pin && self.now == pin
        })
    }

    /// Strobes before the first one that does more than count looks.
    pub(super) fn plain_strobes(&self, guard: &Guard) -> u64 {
        match guard.latch {
            Some(_) if self.latches => 0,
            Some(Latch { looks, .. }) if self.now != self.accepted => {
                u64::from(looks - 1 - self.count)
            }
            _ => u64::MAX,
        }
    }

    /// Passes this many strobes, at most [`LatchState::plain_strobes`].
    pub(super) fn pass(&mut self, strobes: u64) {
        if self.now != self.accepted {
            // Fewer than the looks, which fit.
            self.count += strobes as u8;
        } else if strobes > 0 {
            self.count = 0;
        }
    }
}

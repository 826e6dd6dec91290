//! The latches: each accepts an edge of its pin after some looks, one at each strobe, and marks the
//! tick whose words of state are its record. It must stay equal to "The latch" and "Several
//! latches" in docs/clock-by-clock.md.

use carrystep_core::engine::{EngineInputs, Guard, Latch, MAX_LATCHES};

/// Greatest number of edges that are counted.
const MOST_EDGES: u8 = 15;

/// The registers of one latch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct OneLatch {
    /// Synchronizer of the pin: two flip-flops, `first` and `now`.
    first: bool,
    now: bool,
    accepted: bool,
    count: u8,
    armed: bool,
    edges: u8,
    /// The words of state of this tick are its record.
    latches: bool,
    /// The number of the record that it holds.
    record: u8,
}

/// The registers of all latches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct LatchState {
    each: [OneLatch; MAX_LATCHES],
    /// The number of the record to which the words of this tick belong if a latch latches them.
    pub(super) record: u8,
}

impl OneLatch {
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

    /// True if a pin at this level changes nothing before the next strobe.
    fn is_steady(&self, pin: bool) -> bool {
        self.first == pin && self.now == pin
    }

    /// Strobes before the first one that does more than count looks.
    fn plain_strobes(&self, looks: u8) -> u64 {
        if self.latches {
            0
        } else if self.now != self.accepted {
            u64::from(looks - 1 - self.count)
        } else {
            u64::MAX
        }
    }

    /// Passes this many strobes, at most [`OneLatch::plain_strobes`].
    fn pass(&mut self, strobes: u64) {
        if self.now != self.accepted {
            // Fewer than the looks, which fit.
            self.count += strobes as u8;
        } else if strobes > 0 {
            self.count = 0;
        }
    }
}

impl LatchState {
    /// Advances by one cycle.
    pub(super) fn clock(&mut self, guard: &Guard, inputs: &EngineInputs, strobe: bool) {
        if strobe {
            self.look(guard);
        }
        for (number, (latch, one)) in guard.latches.iter().zip(&mut self.each).enumerate() {
            if inputs.latch_arm >> number & 1 == 1 {
                (one.armed, one.edges) = (true, 0);
            }
            (one.now, one.first) = (one.first, level(inputs, number) != latch.low);
        }
    }

    /// All latches look at their pins, at a strobe. Those that accept the edges for which they were
    /// armed take the free record.
    fn look(&mut self, guard: &Guard) {
        let free = self.free_record(guard);
        for (latch, one) in guard.latches.iter().zip(&mut self.each) {
            one.look(latch.looks);
        }
        if !self.latches() || guard.latches.len() < 2 {
            return;
        }
        self.record = free;
        self.each.iter_mut().filter(|one| one.latches).for_each(|one| one.record = free);
    }

    /// The least number of a record that no latch holds.
    fn free_record(&self, guard: &Guard) -> u8 {
        let latches = self.each.iter().take(guard.latches.len());
        let held = latches.filter(|one| !one.armed).fold(0_u8, |held, one| held | 1 << one.record);
        held.trailing_ones() as u8
    }

    /// True if the words of state of this tick are the record of some latch.
    pub(super) const fn latches(&self) -> bool {
        let [zero, one, two, three] = self.each;
        zero.latches || one.latches || two.latches || three.latches
    }

    /// Mask of the latches that wait for their edges.
    pub(super) fn armed(&self) -> u8 {
        (0..).zip(&self.each).fold(0, |mask, (number, one)| mask | u8::from(one.armed) << number)
    }

    /// The edges that each latch has counted.
    pub(super) fn edges(&self) -> [u8; MAX_LATCHES] {
        self.each.map(|one| one.edges)
    }

    /// The number of the record that each latch holds.
    pub(super) fn records(&self) -> [u8; MAX_LATCHES] {
        self.each.map(|one| one.record)
    }

    /// Returns to the state at configuration, but for the flip-flops.
    pub(super) fn forget(&mut self) {
        let each = self.each.map(|OneLatch { first, now, .. }| OneLatch {
            first,
            now,
            ..OneLatch::default()
        });
        *self = Self { each, record: 0 };
    }
}

/// True if the host arms a latch that the build does not have, which is a fault in a build with
/// several latches.
pub(super) fn arms_a_missing_one(guard: &Guard, inputs: &EngineInputs) -> bool {
    let count = guard.latches.len();
    count > 1 && inputs.latch_arm >> count != 0
}

const fn level(inputs: &EngineInputs, number: usize) -> bool {
    inputs.latch >> number & 1 == 1
}

/// Access for the fast model, which passes many clocks at once.
impl LatchState {
    /// The latches of the build, each with its number and its registers.
    fn built<'a>(&'a self, guard: &'a Guard) -> impl Iterator<Item = (usize, Latch, &'a OneLatch)> {
        guard
            .latches
            .iter()
            .zip(&self.each)
            .enumerate()
            .map(|(number, (latch, one))| (number, *latch, one))
    }

    /// True if these inputs change nothing before the next strobe.
    pub(super) fn is_steady(&self, guard: &Guard, inputs: &EngineInputs) -> bool {
        self.built(guard).all(|(number, latch, one)| {
            let arms = inputs.latch_arm >> number & 1 == 1;
            !arms && one.is_steady(level(inputs, number) != latch.low)
        })
    }

    /// Strobes before the first one that does more than count looks.
    pub(super) fn plain_strobes(&self, guard: &Guard) -> u64 {
        let strobes = self.built(guard).map(|(_, latch, one)| one.plain_strobes(latch.looks));
        strobes.min().unwrap_or(u64::MAX)
    }

    /// Passes this many strobes, at most [`LatchState::plain_strobes`].
    pub(super) fn pass(&mut self, strobes: u64) {
        self.each.iter_mut().for_each(|one| one.pass(strobes));
    }
}

//! The crossings that an axis has still to make, in order.
//!
//! They are computed in groups: an edge is compared with the next two of them without copying them,
//! and the computations of one group do not wait for each other. A move is read when an edge may
//! belong to it, and not before, because the moves may still be planned.

use crate::ideal::Due;
use carrystep_core::StartPhase;
use carrystep_profile::{Crossing, Leg, Reader, Timeline};

/// The number of crossings that are computed together.
const GROUP: u64 = 64;

/// The crossings of an axis, from the next one on.
pub(crate) struct Ahead {
    phase: StartPhase,
    tick_ps: u64,
    legs: Reader<Leg>,
    /// The leg that was read last, and the number of its next crossing that is not in `group`.
    leg: Option<(Leg, u64)>,
    group: Vec<(Crossing, Due)>,
    /// The place of the next crossing in `group`.
    at: usize,
    /// Number of the next crossing, counted from 1.
    number: u64,
}

impl Ahead {
    /// All crossings of a timeline. `tick_ps` is the length of a tick.
    pub(crate) fn new(timeline: &Timeline, phase: StartPhase, tick_ps: u64) -> Self {
        let (legs, group) = (timeline.legs(), Vec::with_capacity(GROUP as usize + 1));
        Self { phase, tick_ps, legs, leg: None, group, at: 0, number: 1 }
    }

    /// Number of the next crossing, counted from 1.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// Whether the next two crossings are computed.
    pub(crate) fn has_two(&self) -> bool {
        self.at + 1 < self.group.len()
    }

    /// Computes the next two crossings, as far as they are in moves that begin by `tick`.
    pub(crate) fn look_to(&mut self, tick: u64) {
        while !self.has_two() {
            if self.leg.as_ref().is_none_or(|(leg, next)| *next > leg.steps) {
                let Some(leg) = self.legs.next_by(tick) else { return };
                self.leg = Some((leg, 1));
            }
            self.refill();
        }
    }

    /// Adds crossings of the leg that was read last.
    fn refill(&mut self) {
        let Some((leg, next)) = &mut self.leg else { return };
        let last = leg.steps.min(*next + GROUP - 1);
        let crossings = (*next..=last).map(|k| leg.crossing(self.phase, k));
        self.group.extend(crossings.map(|crossing| (crossing, Due::of(&crossing, self.tick_ps))));
        *next = last + 1;
    }

    /// The next crossing (0) or the one after it (1), if it is computed. If an edge is nearer to
    /// the second one, a pulse is missing.
    pub(crate) fn next(&self, which: usize) -> Option<&(Crossing, Due)> {
        self.group.get(self.at + which)
    }

    /// Goes on to the crossing after the next one.
    pub(crate) fn advance(&mut self) {
        self.number += 1;
        self.at += 1;
        if !self.has_two() {
            self.group.drain(..self.at.min(self.group.len()));
            self.at = 0;
            self.refill();
        }
    }
}

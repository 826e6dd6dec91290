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
    /// The last crossing that `go_to` has passed.
    passed: Option<Due>,
}

impl Ahead {
    /// All crossings of a timeline. `tick_ps` is the length of a tick.
    pub(crate) fn new(timeline: &Timeline, phase: StartPhase, tick_ps: u64) -> Self {
        let (legs, group) = (timeline.legs(), Vec::with_capacity(GROUP as usize + 1));
        Self { phase, tick_ps, legs, leg: None, group, at: 0, number: 1, passed: None }
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

    /// Goes on to the first crossing that is not before a time of the capture, and returns whether
    /// a crossing is within `within_ps` of that time. No crossing may have been computed before.
    pub(crate) fn go_to(&mut self, ps: u64, origin_ps: i64, within_ps: f64) -> bool {
        let tick = (ps.saturating_add_signed(origin_ps.saturating_neg()) as f64 + within_ps)
            / self.tick_ps as f64;
        let (phase, tick_ps) = (self.phase, self.tick_ps);
        let late = |due: Due| due.lateness_ps(ps, origin_ps);
        loop {
            if self.leg.as_ref().is_none_or(|(leg, next)| *next > leg.steps) {
                match self.legs.next_by(tick as u64 + 1) {
                    Some(leg) => self.leg = Some((leg, 1)),
                    None => break,
                }
            }
            let Some((leg, next)) = &mut self.leg else { break };
            let due = |k| Due::of(&leg.crossing(phase, k), tick_ps);
            // The crossings from `next` to before `k` are before the time.
            let (mut k, mut end) = (*next, leg.steps + 1);
            while k < end {
                let middle = k + (end - k) / 2;
                if late(due(middle)) > 0.0 { k = middle + 1 } else { end = middle }
            }
            if k > *next {
                self.passed = Some(due(k - 1));
            }
            self.number += k - *next;
            *next = k;
            if k <= leg.steps {
                let near = self.passed.is_some_and(|due| late(due) < within_ps);
                return near || -late(due(k)) < within_ps;
            }
        }
        self.passed.is_some_and(|due| late(due) < within_ps)
    }

    /// Goes on to the crossing of this number.
    pub(crate) fn skip_to(&mut self, number: u64) {
        let mut left = number.saturating_sub(self.number);
        self.number += left;
        let computed = left.min(self.group.len().saturating_sub(self.at) as u64);
        self.at += computed as usize;
        left -= computed;
        while left > 0 {
            if self.leg.as_ref().is_none_or(|(leg, next)| *next > leg.steps) {
                self.leg = self.legs.next().map(|leg| (leg, 1));
            }
            let Some((leg, next)) = &mut self.leg else { break };
            let skipped = left.min(leg.steps + 1 - *next);
            *next += skipped;
            left -= skipped;
        }
        self.fill_up();
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
        self.fill_up();
    }

    fn fill_up(&mut self) {
        if !self.has_two() {
            self.group.drain(..self.at.min(self.group.len()));
            self.at = 0;
            self.refill();
        }
    }
}

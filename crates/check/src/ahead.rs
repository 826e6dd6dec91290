//! The crossings that an axis has still to make, in order.
//!
//! They are computed in groups: an edge is compared with the next two of them without copying them,
//! and the computations of one group do not wait for each other.

use crate::ideal::Due;
use carrystep_core::StartPhase;
use carrystep_profile::{Crossing, Timeline};

/// The number of crossings that are computed together.
const GROUP: usize = 64;

/// Adds the next crossings to a list, at most [`GROUP`] of them.
type Refill<'a> = Box<dyn FnMut(&mut Vec<(Crossing, Due)>) + Send + 'a>;

/// The crossings of an axis, from the next one on.
pub(crate) struct Ahead<'a> {
    refill: Refill<'a>,
    group: Vec<(Crossing, Due)>,
    /// The place of the next crossing in `group`.
    at: usize,
    /// Number of the next crossing, counted from 1.
    number: u64,
}

impl<'a> Ahead<'a> {
    /// All crossings of a timeline. `tick_ps` is the length of a tick.
    pub(crate) fn new(timeline: &'a Timeline, phase: StartPhase, tick_ps: u64) -> Self {
        let with_due = move |crossing: Crossing| (crossing, Due::of(&crossing, tick_ps));
        let mut all = timeline.crossings(phase).map(with_due);
        let mut refill: Refill<'a> = Box::new(move |group| group.extend(all.by_ref().take(GROUP)));
        let mut group = Vec::with_capacity(GROUP + 1);
        refill(&mut group);
        Self { refill, group, at: 0, number: 1 }
    }

    /// Number of the next crossing, counted from 1.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// The next crossing and the one after it. If an edge is nearer to the second one, a pulse is
    /// missing.
    pub(crate) fn next(&self) -> [Option<&(Crossing, Due)>; 2] {
        [self.group.get(self.at), self.group.get(self.at + 1)]
    }

    /// Goes on to the crossing after the next one.
    pub(crate) fn advance(&mut self) {
        self.number += 1;
        self.at += 1;
        if self.at + 1 >= self.group.len() {
            self.group.drain(..self.at.min(self.group.len()));
            self.at = 0;
            (self.refill)(&mut self.group);
        }
    }
}

//! Cuts of a program that runs: which slot each segment has, and what was decided.
//!
//! ```text
//! sent      | s4 | s5 | s6 | s7 | s8 |      s4 runs; keep = 6: s0 to s5 are kept
//! cut                 ^                     the CUT names the slot of s5
//! behind              | t6 | t7 | ...       the new segments follow it in the window
//! ```

use crate::command::{CutSlots, SegmentSource};
use crate::feeder::Feeder;
use crate::registers::{MOST_AXES, STATUS_SLOT, STATUS_WAITING};
use crate::session::Session;

/// The cuts of a program.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cutting {
    /// The slot of the first segment of each axis of the program.
    first: [u8; MOST_AXES as usize],
    /// Number of axes of the build.
    axes: u8,
    /// Number of segments that the queue of an axis holds.
    depth: u8,
    /// The cut that was asked for and is not queued: the number of segments that each axis keeps.
    wanted: Option<u32>,
    /// Number of cuts that were granted.
    granted: u32,
    /// The greatest result of [`Self::begun`] so far.
    begun: u32,
}

impl Cutting {
    /// The cuts of a program that begins at rest, when STATUS of each axis is this.
    pub fn new(status: &[u32], depth: u32) -> Self {
        // At rest the slot is that of the last segment that ran; others may wait behind it.
        let behind = |&status: &u32| {
            let waiting = (status & STATUS_WAITING) >> STATUS_WAITING.trailing_zeros();
            ((status & STATUS_SLOT) + waiting + 1) as u8
        };
        let mut first = [0; MOST_AXES as usize];
        for (first, status) in first.iter_mut().zip(status) {
            *first = behind(status);
        }
        let (axes, depth) = (status.len() as u8, depth.min(STATUS_SLOT) as u8);
        Self { first, axes, depth, wanted: None, granted: 0, begun: 0 }
    }

    /// Number of segments of each axis of which the axis that is furthest is known to have begun to
    /// run the last one. It never decreases: behind a cut that was refused, the room of the queues is
    /// unknown until it has been read, but what had begun before has begun.
    pub fn begun<S: SegmentSource, const N: usize>(
        &mut self,
        session: &Session<N>,
        feeder: &Feeder<S>,
    ) -> u32 {
        let of = |axis| {
            let waits = self.depth.saturating_sub(session.room(axis));
            feeder.sent(axis).saturating_sub(waits.into())
        };
        self.begun = (0..self.axes).map(of).fold(self.begun, u32::max);
        self.begun
    }

    /// Number of segments that every axis has got.
    pub fn sent<S: SegmentSource>(&self, feeder: &Feeder<S>) -> u32 {
        (0..self.axes).map(|axis| feeder.sent(axis)).min().unwrap_or_default()
    }

    /// Asks for a cut behind the first `keep` segments of each axis.
    pub fn ask(&mut self, keep: u32) {
        self.wanted = Some(keep);
    }

    /// Number of cuts that were granted.
    pub const fn granted(&self) -> u32 {
        self.granted
    }

    /// Notes whether a cut was decided, and queues one that is wanted. Returns false while segments
    /// would come before it.
    pub fn advance<S: SegmentSource, const N: usize>(
        &mut self,
        session: &mut Session<N>,
        feeder: &mut Feeder<S>,
    ) -> bool {
        if feeder.is_cutting() && !session.cutting() {
            let granted = !session.cut_refused();
            self.granted += u32::from(granted);
            feeder.decided(granted);
        }
        let Some(keep) = self.wanted else { return true };
        // The slots of longer ago are those of segments that wait now.
        let is_past = |axis| feeder.sent(axis).saturating_sub(keep) > self.depth.into();
        if keep == 0 || (0..self.axes).any(is_past) {
            feeder.cut(self.axes, keep);
            feeder.decided(false);
            self.wanted = None;
            return true;
        }
        let mut slots = CutSlots::default();
        let slot_count = u32::from(self.depth) + 1;
        for ((_, slot), first) in (0..self.axes).zip(&mut slots.0).zip(self.first) {
            *slot = Some(((u32::from(first) + keep - 1) % slot_count) as u8);
        }
        if feeder.is_cutting() || session.cut(slots).is_err() {
            return false;
        }
        for axis in 0..self.axes {
            let dropped = feeder.sent(axis).saturating_sub(keep);
            session.drops(axis, dropped as u8);
        }
        feeder.cut(self.axes, keep);
        self.wanted = None;
        true
    }
}

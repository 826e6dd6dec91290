//! The cut: drops the segments behind a named one in several axes at one strobe, or in none. It
//! must stay equal to "Cut" in docs/clock-by-clock.md.
//!
//! ```text
//! cut      _/^\\_______________________________
//! asked    ___/^^^^^^^^\\______________________
//! strobe   __________/^\\_________/^\\_________
//! checks   ____________/^^^^^^^^^^^\\__________
//! queues   ........................|   end with the named segments, unless the cut is refused
//! ```

use super::Motion;
use super::axis_model::AxisModel;
use carrystep_core::engine::EngineInputs;

/// The registers of the cut, but for the names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Cut {
    asked: bool,
    /// The strobe that ends this tick decides.
    pub(super) checks: bool,
    /// The last cut was refused.
    pub(super) refused: bool,
}

impl Cut {
    /// True if a cut was requested and is not decided yet.
    pub(super) const fn is_busy(self) -> bool {
        self.asked || self.checks
    }
}

impl Cut {
    /// No cut is requested any more.
    pub(super) const fn withdraw(&mut self) {
        (self.asked, self.checks) = (false, false);
    }
}

impl Motion {
    /// Executes the rules of the cut that apply in every cycle.
    pub(super) fn clock_cut(&mut self, inputs: &EngineInputs, strobe: bool) {
        if strobe {
            self.cut.checks = std::mem::take(&mut self.cut.asked);
        }
        self.cut.asked |= inputs.cut && self.build.cuts;
    }

    /// Decides about a cut at a strobe, and executes it. `ticked` are the axes after this tick,
    /// with the segments that were committed in it.
    pub(super) fn decide_cut(&mut self, ticked: &mut [AxisModel]) {
        if !self.cut.checks {
            return;
        }
        let emptied = self.stop.clearing || self.reset.forgets();
        let mut pairs = self.axis_models.iter().zip(&*ticked);
        self.cut.refused = !pairs.all(|(before, after)| {
            before.named.is_none_or(|slot| before.keeps(after, slot, emptied))
        });
        for axis_model in ticked {
            if let Some(slot) = axis_model.named.take()
                && !self.cut.refused
            {
                axis_model.queue.truncate(axis_model.distance(slot));
            }
        }
    }
}

impl AxisModel {
    /// Number of slots from that of the running segment to this one.
    fn distance(&self, slot: u8) -> usize {
        (usize::from(slot) + self.slots - usize::from(self.slot)) % self.slots
    }

    /// True if the segment in this slot still waits or runs after this tick, and no segment is
    /// partly written. `after` is this axis after the tick, in which a clear has `emptied` the
    /// queue or not.
    fn keeps(&self, after: &Self, slot: u8, emptied: bool) -> bool {
        let seek_empties = self.seek.ramps && after.running.is_none();
        let distance = self.distance(slot);
        let waits = (1..=self.queue.len()).contains(&distance) && !emptied && !seek_empties;
        let runs = distance == 0 && after.running.is_some() && after.slot == self.slot;
        (waits || runs) && after.next_word == 0
    }
}

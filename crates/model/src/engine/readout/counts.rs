//! The counts of one axis in the readout. They follow the registers of its step shaper by at most
//! one step in a tick, so that all words of a tick belong to one strobe.

use crate::parts::shaper::ShaperState;

/// The beat of a time slot in which the discarded steps are compared with those of the shaper.
pub(super) const DISCARDED_BEAT: u32 = 4;

/// The beat of a time slot in which the position is compared with that of the shaper.
pub(super) const POSITION_BEAT: u32 = 6;

/// The counts of an axis, and the results of the last comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Counts {
    /// The position, in steps.
    pub(super) position: i32,
    /// The change of the position at the next strobe: 1, -1 or 0.
    change: i32,
    /// Number of steps that were discarded.
    pub(super) discarded: u32,
    /// One more discarded step is counted at the next strobe.
    lost: bool,
    /// The carries since the last clear less the counted steps since then, modulo 16: -8 to 7.
    pub(super) on_way: i8,
}

impl Counts {
    /// Compares a count with the shaper of an axis that `runs` or does not, if this is a beat that
    /// does.
    pub(super) const fn compare(&mut self, beat: u32, shaper: &ShaperState, runs: bool) {
        match beat {
            DISCARDED_BEAT => self.lost = shaper.discarded != self.discarded && !runs,
            POSITION_BEAT => {
                self.change = shaper.position.wrapping_sub(self.position).signum();
            }
            _ => {}
        }
    }

    /// Counts what the comparison of this tick has found.
    pub(super) fn commit(&mut self) {
        self.count(self.change);
        self.discarded = self.discarded.wrapping_add(self.lost.into());
        (self.change, self.lost) = (0, false);
    }

    /// Counts steps of the position, which are no longer on their way.
    const fn count(&mut self, steps: i32) {
        self.position = self.position.wrapping_add(steps);
        self.carry(steps.wrapping_neg());
    }

    /// Adds carries, forward less backward.
    pub(super) const fn carry(&mut self, carries: i32) {
        self.on_way = (((self.on_way as i32).wrapping_add(carries) << 28) >> 28) as i8;
    }

    /// Makes this number of comparisons in a beat and commits each, while the shaper stays the
    /// same.
    pub(super) fn follow(&mut self, beat: u32, shaper: &ShaperState, runs: bool, ticks: u64) {
        if beat == POSITION_BEAT {
            let apart = shaper.position.wrapping_sub(self.position);
            let steps = u64::from(apart.unsigned_abs()).min(ticks) as u32;
            self.count(apart.signum().wrapping_mul(steps.cast_signed()));
        } else if !runs {
            let lost = shaper.discarded.wrapping_sub(self.discarded);
            self.discarded = self.discarded.wrapping_add(u64::from(lost).min(ticks) as u32);
        }
    }
}

//! The counts of one axis in the readout. They follow the registers of its step shaper by at most
//! one step in a tick, so that all words of a tick belong to one strobe.

use crate::engine::Motion;

/// The beat of a time slot in which the discarded steps are compared with those of the shaper.
pub(super) const DISCARDED_BEAT: u32 = 4;

/// The beat of a time slot in which the position is compared with that of the shaper.
pub(super) const POSITION_BEAT: u32 = 6;

/// What the counts of an axis follow.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counted {
    /// The position of the step shaper, in steps.
    pub(crate) position: i32,
    /// Number of steps that the step shaper has discarded.
    discarded: u32,
    /// Whether the axis runs. While it does, discarded steps are not counted.
    runs: bool,
}

impl Counted {
    /// Those of an axis in the present clock.
    pub(crate) fn of(motion: &Motion, axis: usize) -> Self {
        let shaper = motion.shaper(axis);
        let runs = motion.axis_state(axis).left.is_some();
        Self { position: shaper.position, discarded: shaper.discarded, runs }
    }
}

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
    /// Compares a count with what it follows, if this is a beat that does.
    pub(super) const fn compare(&mut self, beat: u32, counted: Counted) {
        match beat {
            DISCARDED_BEAT => {
                self.lost = counted.discarded != self.discarded && !counted.runs;
            }
            POSITION_BEAT => {
                self.change = counted.position.wrapping_sub(self.position).signum();
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

    /// Makes this number of comparisons in a beat and commits each, while what the counts follow
    /// stays the same.
    pub(super) fn follow(&mut self, beat: u32, counted: Counted, ticks: u64) {
        if beat == POSITION_BEAT {
            let apart = counted.position.wrapping_sub(self.position);
            let steps = u64::from(apart.unsigned_abs()).min(ticks) as u32;
            self.count(apart.signum().wrapping_mul(steps.cast_signed()));
        } else if !counted.runs {
            let lost = counted.discarded.wrapping_sub(self.discarded);
            self.discarded = self.discarded.wrapping_add(u64::from(lost).min(ticks) as u32);
        }
    }
}

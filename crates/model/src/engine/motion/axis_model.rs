//! One axis of the engine: the calculation of one tick. It must stay equal to "A tick of an axis"
//! in docs/clock-by-clock.md.

use super::seek::AxisSeek;
use super::switches::{Sample, Switch};
use crate::parts::phase::{bisect, crosses};
use crate::parts::shaper;
use crate::parts::stage::{Stage, Step};
use carrystep_core::OutputChange;
use carrystep_core::engine::{Cause, Commit, Guard, SEGMENT_WORDS, SWITCH_ROWS};
use std::collections::VecDeque;

/// A segment in the format of the queue: `v`, `a`, `j` in 2^-64 step per tick, tick^2, tick^3.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Queued {
    /// Remaining ticks after the next one (`ticks` - 1 when it is loaded).
    pub(super) left: u32,
    pub(super) v: i64,
    pub(super) a: i64,
    pub(super) j: i64,
    pub(super) commit: Commit,
}

impl Queued {
    /// Assembles the segment from its seven words, low half first.
    pub(super) fn of_words(words: [u32; SEGMENT_WORDS as usize], commit: Commit) -> Self {
        let [left, v, v_high, a, a_high, j, j_high] = words;
        let long = |low: u32, high: u32| (u64::from(high) << 32 | u64::from(low)).cast_signed();
        Self { left, v: long(v, v_high), a: long(a, a_high), j: long(j, j_high), commit }
    }
}

/// One axis: its accumulator, its queue, its switches, the stages behind the accumulator and the
/// step shaper.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct AxisModel {
    pub(super) p: u64,
    pub(super) running: Option<Queued>,
    /// The sum V + A of the running segment did not fit 64 bits.
    pub(super) unfit: bool,
    /// In a ramp whose direction is known: true is backward.
    pub(super) ramp: Option<bool>,
    /// Acceleration of ramps, in 2^-64 step per tick^2.
    pub(super) stop: i64,
    pub(super) seek: AxisSeek,
    pub(super) queue: VecDeque<Queued>,
    /// Number of slots: those of the queue, and that of the running segment.
    pub(super) slots: usize,
    /// Number of segments that have left the queue, modulo the number of slots: the slot of the
    /// running segment, or of the last one that ran.
    pub(super) slot: u8,
    /// The change of outputs with the segment with which the axis begins this tick.
    pub(super) begun: Option<OutputChange>,
    /// The segment that was committed in this tick; the strobe moves it into the queue.
    pub(super) fresh: Option<Queued>,
    pub(super) words: [u32; SEGMENT_WORDS as usize],
    /// Number of the word of that segment that must come next.
    pub(super) next_word: u8,
    /// The slot that the host has named for a cut.
    pub(super) named: Option<u8>,
    /// The switches of this axis, one of each row.
    pub(super) switches: [Switch; SWITCH_ROWS as usize],
    pub(super) computed: Stage,
    pub(super) emitted: Stage,
    pub(super) shaper: shaper::ShaperState,
}

/// The conditions of a tick that are the same for all axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tick<'a> {
    pub(super) guard: &'a Guard,
    pub(super) phase_bits: u32,
    pub(super) halted: bool,
    pub(super) ramp: bool,
}

impl AxisModel {
    pub(super) fn new(p: u64, stop: u64, slots: usize, shaper: shaper::ShaperState) -> Self {
        Self {
            p,
            running: None,
            unfit: false,
            ramp: None,
            stop: stop.cast_signed(),
            seek: AxisSeek::default(),
            queue: VecDeque::new(),
            slots,
            slot: 0,
            begun: None,
            fresh: None,
            words: [0; SEGMENT_WORDS as usize],
            next_word: 0,
            named: None,
            switches: Default::default(),
            computed: Stage::default(),
            emitted: Stage::default(),
            shaper,
        }
    }

    /// Number of segments for which the queue has room.
    pub(super) fn room(&self) -> u8 {
        (self.slots - 1 - self.queue.len()) as u8
    }

    /// Takes the first segment of the queue, if there is one, as the running segment.
    pub(super) fn load(&mut self) {
        self.running = self.queue.pop_front();
        self.begun =
            self.running.map(|segment| segment.commit.outputs).filter(|change| !change.is_none());
        self.pass_slots(usize::from(self.running.is_some()));
    }

    /// True if the axis is in a ramp, that of all axes (`all`) or one of its own.
    pub(super) const fn is_in_ramp(&self, all: bool) -> bool {
        all || self.seek.ramps
    }

    /// Counts segments that leave the queue.
    fn pass_slots(&mut self, segments: usize) {
        self.slot = ((usize::from(self.slot) + segments) % self.slots) as u8;
    }

    /// Returns the axis after one tick, and the cause of a stop if the tick finds one.
    pub(super) fn tick(&self, tick: Tick<'_>, sample: Option<Sample>) -> (Self, Option<Cause>) {
        let mut next = self.clone();
        next.emitted = self.computed;
        next.computed = Stage::default();
        next.running = None;
        next.begun = None;
        next.ramp = None;
        next.unfit = false;
        let mut found = None;
        match self.running.filter(|_| !tick.halted) {
            Some(Queued { v, .. }) if self.unfit || v == i64::MIN => found = Some(Cause::Overspeed),
            Some(segment) => found = self.add(&mut next, segment, tick),
            None => {}
        }
        if let Some(sample) = sample {
            let sign = next.computed.sign;
            let switch = &mut next.switches[usize::from(sample.row)];
            if switch.finds_limit(sample, tick.guard, sign) && !self.seek.is_excused {
                found = Some(Cause::Limit);
            }
        }
        if self.seek.ramps && next.running.is_none() {
            next.pass_slots(next.queue.len());
            next.queue.clear();
        }
        (next, found)
    }

    /// Executes the additions of one tick. `next` must be at rest when the function is called.
    fn add(&self, next: &mut Self, segment: Queued, tick: Tick<'_>) -> Option<Cause> {
        let Queued { left, v, a, j, commit } = segment;
        let segment = Queued { left: left.wrapping_sub(1), ..segment };
        let step = crosses(self.p, v)
            .then(|| Step { backward: v < 0, phase: bisect(self.p, v, tick.phase_bits) });
        next.computed = Stage { step, sign: v.signum() as i8 };
        next.p = self.p.wrapping_add(v.cast_unsigned());
        if self.is_in_ramp(tick.ramp) {
            let Some(back) = self.ramp else {
                next.running = Some(segment);
                next.ramp = Some(v < 0);
                return None;
            };
            let slower = if back { v + self.stop } else { v - self.stop };
            if (slower < 0) == back {
                next.running = Some(Queued { v: slower, ..segment });
                next.ramp = Some(back);
            }
            return None;
        }
        let (faster, unfit) = v.overflowing_add(a);
        let on = Queued { v: faster, a: a.wrapping_add(j), ..segment };
        if left > 0 {
            next.running = Some(on);
            next.unfit = unfit;
            return None;
        }
        if commit.last {
            return None;
        }
        next.load();
        if next.running.is_some() {
            return None;
        }
        next.running = Some(on);
        next.unfit = unfit;
        Some(Cause::Underrun)
    }
}

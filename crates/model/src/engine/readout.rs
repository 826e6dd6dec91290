//! What the engine outputs for a host: in each time slot the words of an axis' state, and at the
//! end of the last one that all of them are fresh. It must stay equal to "What the host reads" in
//! docs/clock-by-clock.md.
//!
//! ```text
//! beat     4        5                  6          7        10       11      12
//! word     P low    left, discarded    position   switch   P high   ticks   status
//!          |        |                  compares the position with the shaper
//!          |        looks at the pin of the switch
//!          compares the discarded steps with the shaper
//! ```

mod counts;
mod leap;

pub(crate) use counts::Counted;
pub(crate) use leap::Span;

use super::motion::{Ending, Motion};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{
    AxisStatus, EngineInputs, EngineOutputs, SWITCH_LEVEL, SWITCH_STATE, StateItem, StatePage,
    StateWord, StateWords, TIME_SLOT_CLOCKS,
};
use counts::Counts;
use std::ops::Range;

/// The beat of a time slot in which the level of a switch is read, and the one in which it is
/// output.
const LOOK_BEAT: u32 = 5;
const SWITCH_BEAT: u32 = 7;

/// The last beat of a time slot, which outputs the status.
const LAST_BEAT: u32 = TIME_SLOT_CLOCKS - 1;

/// The registers of the readout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Readout {
    counts: Vec<Counts>,
    /// Number of strobes since configuration, modulo 2^32.
    ticks: u32,
    /// A snapshot was requested and is not being output yet.
    asked: bool,
    /// The words of this tick are those of a snapshot.
    takes: bool,
    /// The axes whose state at the hit of a seek is to be output, one bit each.
    captures: u8,
    /// The levels of the switches of this time slot, one bit for each adder, from the beat in which
    /// they are read to the one in which they are output; else 0.
    levels: u8,
    /// Number of adders.
    adders: usize,
}

impl Readout {
    /// The readout at configuration.
    pub(crate) fn new(build: &EngineBuild) -> Self {
        let counts = vec![Counts::default(); build.axes()];
        let adders = build.adders;
        Self { counts, ticks: 0, asked: false, takes: false, captures: 0, levels: 0, adders }
    }

    /// The outputs of an engine with this motion in this cycle.
    pub(crate) fn outputs(&self, motion: &Motion, inputs: &EngineInputs) -> EngineOutputs {
        let last = self.counts.len() - 1;
        let slot = motion.time_slot();
        let word = |adder| {
            let (axis, beat) = slot
                .as_ref()
                .and_then(|(axes, beat)| axes.clone().nth(adder).map(|axis| (axis, *beat)))?;
            match beat {
                SWITCH_BEAT => {
                    switch_word(motion, axis, motion.row()?, self.levels >> adder & 1 == 1)
                }
                _ => self.word(motion, axis, beat),
            }
        };
        let ends = |(axes, beat): &(Range<usize>, u32)| axes.contains(&last) && *beat == LAST_BEAT;
        EngineOutputs {
            state: StateWords::of(word),
            refreshed: slot.as_ref().is_some_and(ends)
                && self.page(motion, last) == StatePage::Live,
            ..motion.outputs(inputs)
        }
    }

    /// Number of clocks before the next one in which `refreshed` may be asserted; 0 if it may be in
    /// the present one.
    pub(crate) fn until_refresh(&self, motion: &Motion) -> u64 {
        motion.until(self.counts.len() - 1, LAST_BEAT)
    }

    /// True if this tick and the next one output live words, unless a snapshot is requested, or a
    /// seek hits or a latch accepts an edge in this tick.
    pub(crate) const fn is_live(&self, motion: &Motion) -> bool {
        !self.asked && !self.takes && self.captures == 0 && !motion.latches()
    }

    /// The word of its state that an axis outputs in this beat of its time slot of the present
    /// tick.
    fn word(&self, motion: &Motion, axis: usize, beat: u32) -> Option<StateWord> {
        let (counts, state) = (self.counts[axis], motion.axis_state(axis));
        let page = self.page(motion, axis);
        let (item, word) = match beat {
            4 => (StateItem::PLow, state.p as u32),
            5 if page == StatePage::Seek => return None,
            5 => match state.left {
                Some(left) => (StateItem::Left, left),
                None => (StateItem::Discarded, counts.discarded),
            },
            6 => (StateItem::Position, counts.position.cast_unsigned()),
            10 => (StateItem::PHigh, (state.p >> 32) as u32),
            11 => (StateItem::Ticks, self.ticks),
            LAST_BEAT => {
                let status = AxisStatus {
                    slot: state.slot,
                    running: state.left.is_some(),
                    waiting: state.waiting,
                    on_way: counts.on_way,
                };
                (StateItem::Status, status.word())
            }
            _ => return None,
        };
        Some(StateWord { page, record: motion.record(), axis: axis as u8, item, word })
    }

    const fn page(&self, motion: &Motion, axis: usize) -> StatePage {
        if motion.latches() {
            StatePage::Latch
        } else if self.captures >> axis & 1 == 1 {
            StatePage::Seek
        } else if self.takes {
            StatePage::Snapshot
        } else {
            StatePage::Live
        }
    }

    /// All words that the present tick outputs in these clocks of it, but those of switches, each
    /// with its clock.
    pub(crate) fn words(
        &self,
        motion: &Motion,
        clocks: Range<u64>,
    ) -> impl Iterator<Item = (u32, StateWord)> {
        (0..self.counts.len()).flat_map(move |axis| {
            let first = motion.build().first_clock_of(axis);
            let beat_at = move |clock: u64| clock.saturating_sub(first.into()) as u32;
            let end = beat_at(clocks.end).min(TIME_SLOT_CLOCKS);
            (beat_at(clocks.start)..end).filter_map(move |beat| {
                let word = self.word(motion, axis, beat)?;
                Some((first + beat, word))
            })
        })
    }

    /// Observes the motion before a clock with these inputs. The result is for
    /// [`Readout::clock`].
    pub(crate) fn observe(&mut self, motion: &Motion, inputs: &EngineInputs) -> Option<Ending> {
        if let Some((axes, beat)) = motion.time_slot() {
            for axis in axes.clone() {
                self.counts[axis].compare(beat, Counted::of(motion, axis));
            }
            match beat {
                LOOK_BEAT => self.levels = levels(motion, inputs, axes),
                SWITCH_BEAT => self.levels = 0,
                _ => {}
            }
        }
        let ending = motion.ending();
        if ending.is_some() && !motion.latches() {
            // This tick has output them.
            self.captures = 0;
        }
        ending
    }

    /// Advances by one cycle; `motion` has already advanced.
    pub(crate) fn clock(&mut self, motion: &Motion, inputs: &EngineInputs, ending: Option<Ending>) {
        let asked = self.asked;
        self.asked |= inputs.snapshot;
        let Some(Ending { hits, empties, forgets }) = ending else { return };
        for (axis, counts) in self.counts.iter_mut().enumerate() {
            counts.commit();
            counts.carry(motion.carry(axis));
            if empties {
                counts.on_way = 0;
            }
            if forgets {
                counts.discarded = 0;
            }
        }
        self.ticks = self.ticks.wrapping_add(1);
        self.captures |= hits;
        let taken = self.captures != 0 || motion.latches();
        self.takes = asked && !taken;
        self.asked = inputs.snapshot || (asked && taken);
    }
}

/// The levels of the switches of these axes in the row of this tick, the first axis lowest; 0 if the
/// tick has no row.
fn levels(motion: &Motion, inputs: &EngineInputs, axes: Range<usize>) -> u8 {
    let Some(row) = motion.row() else { return 0 };
    (0..)
        .zip(axes)
        .fold(0, |bits, (adder, axis)| bits | u8::from(motion.pin(inputs, axis, row)) << adder)
}

/// The word of a switch, if it is output: the row, and the level that was read.
fn switch_word(motion: &Motion, axis: usize, row: u8, level: bool) -> Option<StateWord> {
    let bit = |bit, is_set| if is_set { bit } else { 0 };
    (!motion.is_resetting()).then(|| StateWord {
        page: StatePage::of_number(row),
        record: motion.record(),
        axis: axis as u8,
        item: StateItem::Switch,
        word: bit(SWITCH_STATE, motion.switch_state(axis, row)) | bit(SWITCH_LEVEL, level),
    })
}

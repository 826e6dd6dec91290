//! What the engine outputs for a host: in each time slot the words of an axis' state, and at the
//! end of the last one that all of them are fresh. It must stay equal to "What the host reads" in
//! docs/clock-by-clock.md.
//!
//! ```text
//! beat     4        5                  6          10       11      12
//! word     P low    left, discarded    position   P high   ticks   status
//!          compares position and discarded steps with the shaper
//! ```

mod counts;
mod leap;

pub(crate) use leap::Span;

use super::motion::{Ending, Motion};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{
    AxisStatus, EngineInputs, EngineOutputs, StateItem, StatePage, StateWord, TIME_SLOT_CLOCKS,
};
use counts::{COMPARE_BEAT, Counts};

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
    /// The axes that found their limit in the tick before, one bit each.
    met: u8,
}

impl Readout {
    /// The readout at configuration.
    pub(crate) fn new(build: &EngineBuild) -> Self {
        let counts = vec![Counts::default(); build.axes()];
        Self { counts, ticks: 0, asked: false, takes: false, met: 0 }
    }

    /// The outputs of an engine with this motion in this cycle.
    pub(crate) fn outputs(&self, motion: &Motion, inputs: &EngineInputs) -> EngineOutputs {
        let slot = motion.time_slot();
        EngineOutputs {
            state: slot.and_then(|(axis, beat)| self.word(motion, axis, beat)),
            refreshed: slot == Some((self.counts.len() - 1, LAST_BEAT)) && !self.takes,
            ..motion.outputs(inputs)
        }
    }

    /// True if this tick and the next one output live words, unless a snapshot is requested or a
    /// limit is found in this tick.
    pub(crate) const fn is_live(&self) -> bool {
        !self.asked && !self.takes && self.met == 0
    }

    /// The word of state that an axis outputs in this beat of its time slot of the present tick.
    fn word(&self, motion: &Motion, axis: usize, beat: u32) -> Option<StateWord> {
        let (counts, state) = (self.counts[axis], motion.axis_state(axis));
        let page = self.page(axis);
        let (item, word) = match beat {
            COMPARE_BEAT => (StateItem::PLow, state.p as u32),
            5 if page == StatePage::Limit => return None,
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
        Some(StateWord { page, axis: axis as u8, item, word })
    }

    const fn page(&self, axis: usize) -> StatePage {
        if self.met >> axis & 1 == 1 {
            StatePage::Limit
        } else if self.takes {
            StatePage::Snapshot
        } else {
            StatePage::Live
        }
    }

    /// All words of the present tick, each with the clock in which it is output.
    pub(crate) fn words(&self, motion: &Motion) -> impl Iterator<Item = (u32, StateWord)> {
        (0..self.counts.len()).flat_map(move |axis| {
            (0..TIME_SLOT_CLOCKS).filter_map(move |beat| {
                let word = self.word(motion, axis, beat)?;
                Some((axis as u32 * TIME_SLOT_CLOCKS + beat, word))
            })
        })
    }

    /// Observes the motion before a clock. The result is for [`Readout::clock`].
    pub(crate) fn observe(&mut self, motion: &Motion) -> Option<Ending> {
        if let Some((axis, COMPARE_BEAT)) = motion.time_slot() {
            let runs = motion.axis_state(axis).left.is_some();
            self.counts[axis].compare(motion.shaper(axis), runs);
        }
        motion.ending()
    }

    /// Advances by one cycle; `motion` has already advanced.
    pub(crate) fn clock(&mut self, motion: &Motion, inputs: &EngineInputs, ending: Option<Ending>) {
        let asked = self.asked;
        self.asked |= inputs.snapshot;
        let Some(Ending { met, empties, forgets }) = ending else { return };
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
        self.met = met;
        self.takes = asked && met == 0;
        self.asked = inputs.snapshot || (asked && met != 0);
    }
}

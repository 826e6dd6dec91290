//! Access for the fast model: the readout after many clocks in which the axes only repeat their
//! additions. No step is discarded in them, no switch changes its debounced state, no seek hits,
//! no latch accepts an edge, nothing is cleared and no snapshot is requested, and an axis that
//! runs goes on running.

use super::counts::{Counted, DISCARDED_BEAT, POSITION_BEAT};
use super::{LOOK_BEAT, Readout, SWITCH_BEAT, levels, switch_word};
use crate::engine::Motion;
use carrystep_core::engine::{EngineInputs, StateWord, TIME_SLOT_CLOCKS};

/// A run of clocks, from this clock of a tick on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Span {
    pub clock: u64,
    pub clocks: u64,
    pub per_tick: u64,
}

impl Span {
    /// Number of strobes in these clocks.
    pub const fn strobes(self) -> u64 {
        (self.clock + self.clocks) / self.per_tick
    }
}

impl Readout {
    /// Passes the counts of one axis through clocks in which what they follow is constant.
    pub(crate) fn follow(&mut self, axis: usize, counted: Counted, span: Span) {
        let adders = self.adders;
        let counts = &mut self.counts[axis];
        let strobes = span.strobes();
        if strobes > 0 {
            counts.commit();
        }
        for beat in [DISCARDED_BEAT, POSITION_BEAT] {
            let slot = (axis / adders) as u64;
            let compares = slot * u64::from(TIME_SLOT_CLOCKS) + u64::from(beat);
            let compared = span.clock > compares;
            // The first strobe has committed what had been compared before.
            let ticks = strobes.saturating_sub(compared.into());
            counts.follow(beat, counted, ticks);
            let again = !compared || strobes > 0;
            if again && (span.clock + span.clocks) % span.per_tick > compares {
                counts.compare(beat, counted);
            }
        }
    }

    /// Adds the carries of an axis, forward less backward.
    pub(crate) fn carry(&mut self, axis: usize, carries: i32) {
        self.counts[axis].carry(carries);
    }

    /// Passes this many strobes.
    pub(crate) const fn pass(&mut self, strobes: u64) {
        if strobes > 0 {
            self.ticks = self.ticks.wrapping_add(strobes as u32);
            self.captures = 0;
            self.takes = self.asked;
            self.asked = false;
        }
    }

    /// Advances the levels of switches that are read in one clock and output in a later one by
    /// this many clocks. `motion` is the motion after them.
    pub(crate) fn pass_level(&mut self, motion: &Motion, inputs: &EngineInputs, clocks: u64) {
        self.levels = match motion.time_slot() {
            Some((_, beat @ LEVEL_FROM..=SWITCH_BEAT)) if clocks < u64::from(beat - LOOK_BEAT) => {
                self.levels
            }
            Some((axes, LEVEL_FROM..=SWITCH_BEAT)) => levels(motion, inputs, axes),
            _ => 0,
        };
    }

    /// The beginning of a leap from here.
    pub(crate) fn begin(&self, motion: &Motion) -> Begin {
        Begin {
            clock: motion.clock_of_tick().into(),
            tick_of_round: motion.tick_of_round(),
            levels: self.levels,
        }
    }
}

/// The beat in which the level that was read is in its register.
const LEVEL_FROM: u32 = LOOK_BEAT + 1;

/// The beginning of a leap.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Begin {
    clock: u64,
    tick_of_round: u32,
    levels: u8,
}

impl Begin {
    /// Reports the words of switches that are output in this number of clocks from the beginning
    /// on, of each address the last one. In these clocks the inputs and the debounced states of the
    /// switches are constant, and there is no reset.
    pub(crate) fn switch_words(
        self,
        motion: &Motion,
        inputs: &EngineInputs,
        clocks: u64,
        words: &mut dyn FnMut(StateWord),
    ) {
        let (round, per_tick) = (motion.build().guard.round, u64::from(motion.clocks_per_tick()));
        for row in motion.rows() {
            // Ticks are counted from the one of the beginning.
            let first = u64::from((u32::from(row) + round - self.tick_of_round) % round);
            for axis in 0..motion.build().axes() {
                let at = u64::from(motion.build().first_clock_of(axis) + SWITCH_BEAT);
                let Some(clocks) = (self.clock + clocks).checked_sub(at + 1) else { break };
                let Some(rounds) = (clocks / per_tick).checked_sub(first) else { break };
                let tick = first + rounds / u64::from(round) * u64::from(round);
                if tick == 0 && at < self.clock {
                    continue;
                }
                let is_read = tick == 0 && at < self.clock + u64::from(SWITCH_BEAT - LOOK_BEAT);
                let adder = axis % motion.build().adders;
                let level = if is_read {
                    self.levels >> adder & 1 == 1
                } else {
                    motion.pin(inputs, axis, row)
                };
                switch_word(motion, axis, row, level).into_iter().for_each(&mut *words);
            }
        }
    }
}

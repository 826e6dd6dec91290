//! The fast engine together with the words of state that it outputs for its host. Its registers
//! and outputs are exactly those of [`Engine`](crate::Engine), whatever clock a leap ends in.
//!
//! A memory that keeps the last word of each address misses nothing: a leap reports every word that
//! is the last one of its address among the skipped clocks. To know these words, a leap over
//! several ticks is executed in two parts, the second of which is one whole tick.
//!
//! ```text
//! tick     |    m    |   ...   |   L-1   |    L    |
//! leap          |--------------->                        words of these ticks are not reported,
//!                              |--------->               because this tick outputs all of them again
//!                                        |--->           the next leap
//! ```

mod following;

use super::FastEngine;
use super::edges::Edges;
use crate::engine::{Motion, Readout};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{EngineInputs, EngineOutputs, PUT_BEAT, StateWord};
use following::Following;

/// The engine with its readout, and the number of the clock cycle that it is in.
#[derive(Debug, Clone)]
pub struct HostedEngine {
    engine: FastEngine,
    readout: Readout,
    /// The words of a leap in its tick, each with its clock. Empty between two leaps.
    words: Vec<(u32, StateWord)>,
}

impl HostedEngine {
    /// The engine at configuration, in cycle 0.
    pub fn new(build: &EngineBuild) -> Self {
        Self { engine: FastEngine::new(build), readout: Readout::new(build), words: Vec::new() }
    }

    /// The registers of its motion.
    pub fn core(&self) -> &Motion {
        self.engine.core()
    }

    /// The registers of its readout.
    pub const fn readout(&self) -> &Readout {
        &self.readout
    }

    /// The number of the current cycle, from 0.
    pub fn cycle(&self) -> u64 {
        self.engine.cycle()
    }

    /// The outputs in this cycle for these inputs.
    pub fn outputs(&self, inputs: &EngineInputs) -> EngineOutputs {
        self.readout.outputs(self.core(), inputs)
    }

    /// Number of cycles before the next one in which the engine may have output all words of a tick;
    /// 0 if that may be the present one.
    pub fn until_refresh(&self) -> u64 {
        self.readout.until_refresh(self.core())
    }

    /// Number of cycles before the next one in which the engine reports the room of this axis; 0 if
    /// it does in the present one.
    pub fn until_room(&self, axis: u8) -> u64 {
        let exists = usize::from(axis) < self.core().build().axes();
        if exists { self.core().until(axis.into(), PUT_BEAT) } else { u64::MAX }
    }

    /// Advances by one cycle and reports the edges on the pins to `to`.
    pub fn clock(&mut self, inputs: &EngineInputs, to: &mut dyn Edges) {
        let ending = self.readout.observe(self.engine.core(), inputs);
        self.engine.clock(inputs, to);
        self.readout.clock(self.engine.core(), inputs, ending);
    }

    /// Skips as many cycles as possible, up to `most`, and returns how many they were, as
    /// [`FastEngine::leap`]. `words` receives the words of state that were output in these cycles,
    /// without those that a later one of the same address has replaced. If the result is 0, the
    /// caller must execute the next cycle with [`HostedEngine::clock`].
    pub fn leap(
        &mut self,
        inputs: &EngineInputs,
        most: u64,
        to: &mut dyn Edges,
        words: &mut dyn FnMut(StateWord),
    ) -> u64 {
        if inputs.snapshot {
            return 0;
        }
        let from = self.cycle();
        let begin = self.readout.begin(self.engine.core());
        let skipped = self.readout.is_live(self.engine.core())
            && self.leap_to_whole_tick(inputs, most, to) > 0;
        let first = u64::from(self.core().clock_of_tick());
        let per_tick = u64::from(self.core().clocks_per_tick());
        let end = if skipped { per_tick } else { first.saturating_add(most).min(per_tick) };
        self.words.extend(self.readout.words(self.engine.core(), first..end));
        let passed = first
            + if skipped {
                self.pass_tick(inputs, to)
            } else {
                self.leap_within_tick(inputs, most, to)
            };
        let output = self.words.drain(..).filter(|(clock, _)| u64::from(*clock) < passed);
        output.for_each(|(_, word)| words(word));
        let clocks = self.cycle() - from;
        begin.switch_words(self.engine.core(), inputs, clocks, words);
        clocks
    }

    /// Skips all cycles before the last whole tick of those that can be skipped, if this whole tick
    /// is a later one than the present tick.
    fn leap_to_whole_tick(&mut self, inputs: &EngineInputs, most: u64, to: &mut dyn Edges) -> u64 {
        let per_tick = u64::from(self.core().clocks_per_tick());
        let clock = u64::from(self.core().clock_of_tick());
        let fit = |clocks: u64| {
            let strobes = (clock + clocks) / per_tick;
            if strobes < 2 { 0 } else { (strobes - 1) * per_tick - clock }
        };
        if most < 2 * per_tick - clock {
            return 0;
        }
        self.pass(inputs, most, fit, to)
    }

    /// Passes one tick, from its first cycle on. Returns the number of its cycles.
    fn pass_tick(&mut self, inputs: &EngineInputs, to: &mut dyn Edges) -> u64 {
        let clocks = u64::from(self.core().clocks_per_tick());
        let end = self.cycle() + clocks;
        while self.cycle() < end {
            if self.leap_within_tick(inputs, end - self.cycle(), to) == 0 {
                self.clock(inputs, to);
            }
        }
        clocks
    }

    /// Skips cycles up to the end of the present tick at most.
    fn leap_within_tick(&mut self, inputs: &EngineInputs, most: u64, to: &mut dyn Edges) -> u64 {
        let left = self.core().clocks_per_tick() - self.core().clock_of_tick();
        self.pass(inputs, most.min(left.into()), |clocks| clocks, to)
    }

    fn pass(
        &mut self,
        inputs: &EngineInputs,
        most: u64,
        fit: impl Fn(u64) -> u64,
        to: &mut dyn Edges,
    ) -> u64 {
        let mut following = Following::new(&mut self.readout, &self.engine, to);
        let passed = self.engine.leap_fitting(inputs, most, fit, &mut following);
        following.finish(&self.engine);
        self.readout.pass_level(self.engine.core(), inputs, passed);
        passed
    }
}

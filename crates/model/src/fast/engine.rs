//! The engine's motion without visiting every clock. States, outputs and faults are exactly those
//! of [`Motion`].
//!
//! It leaps over clocks in which the axes only repeat their additions, ramps included. Loads,
//! starts, calls of stops, changes of debounced switches, hits of seeks, edges of the latches and
//! clears are executed by the clock-by-clock model. So are accepted words, unless the host tells
//! which words it offers next.

use super::edges::{self, Edges};
use super::passage::{From, Passages};
use crate::engine::Motion;
use crate::parts::moving::Moving;
use carrystep_core::EngineBuild;
use carrystep_core::engine::{EngineInputs, EngineOutputs, MAX_AXES, Put};

/// The engine without the words of state that only a host reads, and the number of the clock cycle
/// that it is in. [`HostedEngine`](super::HostedEngine) has these words too.
///
/// Inputs are constant during a call. To change them in some cycle, the caller runs to that cycle
/// and then continues with the new inputs.
#[derive(Debug, Clone)]
pub struct FastEngine {
    core: Motion,
    cycle: u64,
    passages: Passages,
    axes: Vec<Moving>,
}

impl FastEngine {
    /// The engine at configuration, in cycle 0.
    pub fn new(build: &EngineBuild) -> Self {
        Self { core: Motion::new(build), cycle: 0, passages: Passages::default(), axes: Vec::new() }
    }

    /// The registers of its motion.
    pub fn core(&self) -> &Motion {
        &self.core
    }

    /// The number of the current cycle, from 0.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// The outputs in this cycle for these inputs, without words of state.
    pub fn outputs(&self, inputs: &EngineInputs) -> EngineOutputs {
        self.core.outputs(inputs)
    }

    /// Runs with these inputs up to cycle `end`, or until a cycle that the host must react to: an
    /// offered word or start is accepted, axes start, or `fault`, `halted`, `idle`, `enabled` or
    /// any output of the seek or of the latches changes after it. Returns the outputs in that
    /// cycle, or `None` if `end` was reached.
    pub fn run(
        &mut self,
        inputs: &EngineInputs,
        end: u64,
        to: &mut impl Edges,
    ) -> Option<EngineOutputs> {
        while self.cycle < end {
            if self.leap(inputs, end - self.cycle, to) > 0 {
                continue;
            }
            let outputs = self.outputs(inputs);
            self.clock(inputs, to);
            let taken = (outputs.put_ready && inputs.put.is_some())
                || (outputs.start_ready && inputs.start.is_some());
            let state = |outputs: EngineOutputs| {
                let EngineOutputs { fault, halted, idle, enabled, .. } = outputs;
                let EngineOutputs { seeking, hits, latch_armed, latch_edges, .. } = outputs;
                let EngineOutputs { latch_records, .. } = outputs;
                let latches = (latch_armed, latch_edges, latch_records);
                (fault, halted, idle, enabled, seeking, hits, latches)
            };
            if taken || outputs.started || state(self.outputs(inputs)) != state(outputs) {
                return Some(outputs);
            }
        }
        None
    }

    /// Advances by one cycle and reports the edges on the pins, and the outputs that have changed,
    /// to `to`.
    pub fn clock(&mut self, inputs: &EngineInputs, to: &mut (impl Edges + ?Sized)) {
        let axes = self.core.build().axes();
        let before: [_; MAX_AXES] =
            std::array::from_fn(|axis| *self.core.shaper(axis.min(axes - 1)));
        let (levels, duty) = (self.core.output_levels(), self.core.duty());
        self.core.clock(inputs);
        self.cycle += 1;
        for (axis, before) in before.iter().enumerate().take(axes) {
            edges::changes(self.cycle, axis as u8, before, self.core.shaper(axis), to);
        }
        if self.core.output_levels() != levels {
            to.levels(self.cycle, self.core.output_levels());
        }
        if self.core.duty() != duty {
            to.duty(self.cycle, self.core.duty(), self.core.pwm());
        }
    }

    /// Skips as many cycles as possible, up to `most`, and returns how many they were. In these
    /// cycles nothing changes but STEP, DIR, the pin of the PWM, the positions, the three `ready`
    /// outputs and `room`, provided that the inputs stay the same; no word and no start is
    /// accepted. If the result is 0, the caller must execute the next cycle with
    /// [`FastEngine::clock`].
    #[inline]
    pub fn leap(&mut self, inputs: &EngineInputs, most: u64, to: &mut impl Edges) -> u64 {
        self.leap_fitting(inputs, most, |clocks| clocks, to)
    }

    /// As [`FastEngine::leap`], but words are accepted in the skipped cycles. `words` are those that
    /// the host offers, the first of them in `inputs`; each is offered from the cycle after the one
    /// in which the word before it was accepted. Returns the number of cycles, and the number of
    /// words that were accepted in them.
    #[inline]
    pub fn leap_taking(
        &mut self,
        inputs: &EngineInputs,
        words: &[Put],
        most: u64,
        to: &mut impl Edges,
    ) -> (u64, usize) {
        self.leap_over(inputs, (words, true), most, |clocks| clocks, to)
    }

    /// As [`FastEngine::leap`], but of the number of cycles that could be skipped, only `fit` of it
    /// are skipped. `fit` must not return more than it is given.
    pub(super) fn leap_fitting(
        &mut self,
        inputs: &EngineInputs,
        most: u64,
        fit: impl Fn(u64) -> u64,
        to: &mut impl Edges,
    ) -> u64 {
        self.leap_over(inputs, (inputs.put.as_slice(), false), most, fit, to).0
    }

    /// Skips cycles, and returns the number of cycles and of words that were accepted in them. The
    /// host offers `words`; if `takes` is false, the last skipped cycle is before the one in which
    /// the first of them is accepted.
    fn leap_over(
        &mut self,
        inputs: &EngineInputs,
        (words, takes): (&[Put], bool),
        most: u64,
        fit: impl Fn(u64) -> u64,
        to: &mut impl Edges,
    ) -> (u64, usize) {
        let plain = self.core.plain_clocks(inputs, most.min(LONGEST));
        let mut clocks = self.core.taking(words, takes, plain).0;
        if clocks > 0 && !self.core.is_still() {
            let clock_of_tick = self.core.clock_of_tick().into();
            self.axes.clear();
            self.axes.extend(self.core.moving());
            let build = self.core.build();
            let from = From { cycle: self.cycle, clock_of_tick };
            let strobes;
            let fit = |longest: u64| fit(self.core.taking(words, takes, longest.min(clocks)).0);
            (clocks, strobes) =
                self.passages.pass(&mut self.axes, from, fit, &build.timebase, &build.pins, to);
            self.core.moved(&self.axes, strobes);
        } else {
            clocks = fit(clocks);
        }
        if clocks == 0 {
            // The inputs of this cycle have no effect before it is executed.
            return (0, 0);
        }
        let (_, taken) = self.core.taking(words, takes, clocks);
        self.core.take(&words[..taken]);
        self.core.pass(inputs, clocks);
        self.cycle += clocks;
        (clocks, taken)
    }
}

/// The greatest number of clocks that one leap skips, so that no sum of cycles overflows.
const LONGEST: u64 = 1 << 48;

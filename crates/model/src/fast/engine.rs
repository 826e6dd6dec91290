//! The engine without visiting every clock: the same states, outputs and faults as [`Engine`], exactly.
//!
//! It leaps over clocks in which nothing happens but plain additions, ramps included. Words that are taken,
//! loads, starts, calls of stops, limits that change and clears are left to the clock-by-clock model.

use super::edges::{self, Edges};
use super::passage::{From, Passages};
use crate::Engine;
use crate::fast::Moving;
use carrystep_core::EngineBuild;
use carrystep_core::engine::{EngineInputs, EngineOutputs, MAX_AXES};

/// The engine, and the clock cycle that it is in.
///
/// Inputs stay what they are until the caller changes them, which it may in any cycle: it goes on to that
/// cycle and then with other inputs.
#[derive(Debug, Clone)]
pub struct FastEngine {
    core: Engine,
    cycle: u64,
    passages: Passages,
    axes: Vec<Moving>,
}

impl FastEngine {
    /// The engine as it is configured, in cycle 0.
    pub fn new(build: &EngineBuild) -> Self {
        Self { core: Engine::new(build), cycle: 0, passages: Passages::default(), axes: Vec::new() }
    }

    /// Its registers.
    pub fn core(&self) -> &Engine {
        &self.core
    }

    /// The cycle it is in.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// The outputs in this cycle, given its inputs.
    pub fn outputs(&self, inputs: &EngineInputs) -> EngineOutputs {
        self.core.outputs(inputs)
    }

    /// Goes on with these inputs to cycle `end`, and stops behind a cycle that the host has to hear of: what it
    /// offers is taken in it, axes are started by it, or `fault`, `halted`, `idle`,
    /// `enabled` or `homing` changes with it.
    /// The outputs in that cycle, or `None` at `end`.
    pub fn run(&mut self, inputs: &EngineInputs, end: u64, to: &mut impl Edges) -> Option<EngineOutputs> {
        while self.cycle < end {
            if self.leap(inputs, end - self.cycle, to) > 0 {
                continue;
            }
            let outputs = self.outputs(inputs);
            self.clock(inputs, to);
            let taken = (outputs.put_ready && inputs.put.is_some()) || (outputs.start_ready && inputs.start.is_some());
            let state = |outputs: EngineOutputs| {
                let EngineOutputs { fault, halted, idle, enabled, homing, .. } = outputs;
                (fault, halted, idle, enabled, homing)
            };
            if taken || outputs.started || state(self.outputs(inputs)) != state(outputs) {
                return Some(outputs);
            }
        }
        None
    }

    /// Goes to the next cycle.
    pub fn clock(&mut self, inputs: &EngineInputs, to: &mut impl Edges) {
        let axes = self.core.build().axes();
        let before: [_; MAX_AXES] = std::array::from_fn(|axis| *self.core.shaper(axis.min(axes - 1)));
        self.core.clock(inputs);
        self.cycle += 1;
        for (axis, before) in before.iter().enumerate().take(axes) {
            edges::changes(self.cycle, axis as u8, before, self.core.shaper(axis), to);
        }
    }

    /// Passes as many cycles as it can, `most` at the most, in which nothing but STEP, DIR, positions, the
    /// three `ready`s, `latch` and `room` changes while the inputs stay; how many they were. No word and no start is taken in them.
    /// After 0 the next cycle needs [`FastEngine::clock`].
    pub fn leap(&mut self, inputs: &EngineInputs, most: u64, to: &mut impl Edges) -> u64 {
        let mut clocks = self.core.plain_clocks(inputs, most.min(LONGEST));
        if clocks > 0 && !self.core.is_still() {
            let clock_of_tick = self.core.clock_of_tick().into();
            self.axes.clear();
            self.axes.extend(self.core.moving());
            let build = self.core.build();
            let from = From { cycle: self.cycle, clock_of_tick };
            let strobes;
            (clocks, strobes) = self.passages.pass(&mut self.axes, from, clocks, &build.timebase, &build.pins, to);
            self.core.moved(&self.axes, strobes);
        }
        self.core.pass(inputs, clocks);
        self.cycle += clocks;
        clocks
    }
}

/// Most clocks of a leap over rest, so that no sum of cycles overflows.
const LONGEST: u64 = 1 << 48;

//! Both cores without visiting every clock: the same states, outputs and faults as [`SixAxis`] and
//! [`Engine`](crate::Engine), exactly.
//!
//! Between two loads an axis is a cubic with integer coefficients, so a *window* of clocks in which
//! nothing but STEP, DIR and positions can change is passed at once, axis by axis. Within it each stretch
//! of V's constant sign is searched for the ticks that step: from edge to edge by a root, guessed in
//! floating point and put right in integers, where edges are far apart; by adding tick after tick
//! where more than one in [a few ticks](crossings) is expected, because an addition a tick is then cheaper
//! than a root an edge. What is taken several at a time by the processor is the edges of one axis, in jumps and in
//! phases, not the axes: side by side they do not tick faster (docs/decisions/0024). The shaper goes from request
//! to request while it is calm. Whatever is not plain (a load, a start, a fault, a frozen core, an owed step) is
//! left to the clock-by-clock code itself: a window ends before it. A window in which a fault turns up is taken
//! back and passed again up to the fault.

mod crossings;
mod cubic;
mod edges;
mod engine;
mod lane;
mod passage;
mod pins;

pub(crate) use cubic::Cubic;
pub use edges::{Change, Edge, Edges};
pub use engine::FastEngine;
pub(crate) use lane::Moving;

use crate::SixAxis;
use carrystep_core::Build;
use carrystep_core::ports::{Inputs, Outputs};
use passage::Passages;

/// The parallel core, and the clock cycle that it is in.
#[derive(Debug, Clone)]
pub struct Fast {
    core: SixAxis,
    cycle: u64,
    passages: Passages,
}

impl Fast {
    /// The core as it is configured, in cycle 0.
    pub fn new(build: &Build) -> Self {
        Self { core: SixAxis::new(build), cycle: 0, passages: Passages::default() }
    }

    /// Its registers.
    pub fn core(&self) -> &SixAxis {
        &self.core
    }

    /// The cycle it is in.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// The outputs in this cycle, given its inputs.
    pub fn outputs(&self, inputs: &Inputs) -> Outputs {
        self.core.outputs(inputs)
    }

    /// Goes to the next cycle.
    pub fn clock(&mut self, inputs: &Inputs, to: &mut impl Edges) {
        let before = self.core.lanes.map(|lane| lane.shaper);
        self.core.clock(inputs);
        self.cycle += 1;
        for ((axis, lane), before) in (0..).zip(&self.core.lanes).zip(&before) {
            edges::changes(self.cycle, axis, before, &lane.shaper, to);
        }
    }

    /// Passes as many cycles as it can, `most` at the most, in which nothing but STEP, DIR and positions
    /// changes while the inputs stay; how many they were. After 0 the next cycle needs [`Fast::clock`].
    pub fn leap(&mut self, inputs: &Inputs, most: u64, to: &mut impl Edges) -> u64 {
        let mut clocks = most;
        if !self.core.is_still(inputs) {
            clocks = if self.core.only_adds(inputs) { most.min(self.clocks_to_load()) } else { 0 };
            let mut lanes = self.core.lanes.map(|lane| lane.moving());
            let build = &self.core.build;
            let from = passage::From { cycle: self.cycle, clock_of_tick: self.core.clock_of_tick() };
            let strobes;
            (clocks, strobes) = self.passages.pass(&mut lanes, from, clocks, &build.timebase, &build.pins, to);
            self.core.lanes.iter_mut().zip(&lanes).for_each(|(lane, moved)| lane.moved(moved, strobes));
        }
        self.cycle += clocks;
        self.core.pass(clocks);
        clocks
    }

    /// Cycles before the strobe that ends the first segment.
    fn clocks_to_load(&self) -> u64 {
        let left =
            |lane: &crate::parallel::six_axis::Lane| lane.axis.running.then_some(lane.axis.left.saturating_sub(1));
        let plain = self.core.lanes.iter().filter_map(left).min().unwrap_or(u32::MAX);
        let clocks = u64::from(self.core.build.timebase.clocks_per_tick());
        (u64::from(plain) + 1) * clocks - 1 - self.core.clock_of_tick()
    }
}

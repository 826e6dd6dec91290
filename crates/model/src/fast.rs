//! Both cores without visiting every clock. States, outputs and faults are exactly those of
//! [`ParallelCore`] and [`Engine`](crate::Engine); only the way to compute them may change here.
//! [`FastEngine`] leaves out the words of state that only a host reads; [`HostedEngine`] has them.
//!
//! Between two loads of a segment, the position of an axis is a cubic with integer coefficients. A
//! *window* is a run of clocks in which the axes only repeat their additions, so that on the pins
//! nothing but STEP and DIR can change. The fast model passes a window at once, axis by axis:
//!
//! - It divides the window into stretches in which V keeps its sign, and finds the ticks of each
//!   stretch that step. Where edges are far apart, it jumps from edge to edge: it guesses each root
//!   in floating point and corrects it in integers.
//! - Where it expects more than one edge in six ticks ([`crossings`]), it adds tick by tick,
//!   because one addition per tick is then cheaper than one root per edge.
//! - Vector instructions work on several edges of one axis, both in jumps and in phases. Running
//!   the axes side by side was not faster (docs/decisions/0024).
//! - The shaper goes from request to request while nothing is held back.
//!
//! All other events (a load, a start, a fault, a frozen core whose pins still move) are executed by
//! the clock-by-clock code; a window ends before them. While a step is held back, the shaper of
//! that axis alone is executed clock by clock within the window. If a fault occurs in a window, the
//! window is undone and passed again up to the fault.

mod crossings;
mod edges;
mod engine;
mod hosted;
mod one_axis;
mod passage;
mod pins;

pub use edges::{Change, Edge, Edges};
pub use engine::FastEngine;
pub use hosted::HostedEngine;

use crate::ParallelCore;
use carrystep_core::Build;
use carrystep_core::ports::{Inputs, Outputs};
use passage::Passages;

/// The parallel core, and the number of the clock cycle that it is in.
#[derive(Debug, Clone)]
pub struct Fast {
    core: ParallelCore,
    cycle: u64,
    passages: Passages,
}

impl Fast {
    /// The core of this number of axes at configuration, as [`ParallelCore::new`] makes it, in
    /// cycle 0.
    pub fn new(build: &Build, axes: usize) -> Self {
        Self { core: ParallelCore::new(build, axes), cycle: 0, passages: Passages::default() }
    }

    /// The registers of the core.
    pub fn core(&self) -> &ParallelCore {
        &self.core
    }

    /// The number of the current cycle, from 0.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// The outputs in this cycle for these inputs.
    pub fn outputs(&self, inputs: &Inputs) -> Outputs {
        self.core.outputs(inputs)
    }

    /// Advances by one cycle and reports the edges on the pins to `to`. The pins are registers, so
    /// an edge has the number of the cycle after the executed one: the first cycle with the new
    /// level.
    pub fn clock(&mut self, inputs: &Inputs, to: &mut impl Edges) {
        let before = self.core.axis_models.map(|axis_model| axis_model.shaper);
        self.core.clock(inputs);
        self.cycle += 1;
        for ((axis, axis_model), before) in (0..).zip(&self.core.axis_models).zip(&before) {
            edges::changes(self.cycle, axis, before, &axis_model.shaper, to);
        }
    }

    /// Skips as many cycles as possible, up to `most`, and returns how many they were. In these
    /// cycles no output changes but STEP, DIR and the positions, provided that the inputs stay the
    /// same. If the result is 0, the caller must execute the next cycle with [`Fast::clock`].
    pub fn leap(&mut self, inputs: &Inputs, most: u64, to: &mut impl Edges) -> u64 {
        let mut clocks = most;
        if !self.core.is_still(inputs) {
            clocks = if self.core.only_adds(inputs) { most.min(self.clocks_to_load()) } else { 0 };
            let mut axis_models = self.core.axis_models.map(|axis_model| axis_model.moving());
            let build = &self.core.build;
            let from =
                passage::From { cycle: self.cycle, clock_of_tick: self.core.clock_of_tick() };
            let strobes;
            (clocks, strobes) = self.passages.pass(
                &mut axis_models,
                from,
                |longest| longest.min(clocks),
                &build.timebase,
                &build.pins,
                to,
            );
            self.core
                .axis_models
                .iter_mut()
                .zip(&axis_models)
                .for_each(|(axis_model, moved)| axis_model.moved(moved, strobes));
        }
        self.cycle += clocks;
        self.core.pass(clocks);
        clocks
    }

    /// Cycles from the present one, itself included, to the strobe that ends the first of the
    /// running segments, that strobe not included. The ticks `left` of a segment include the
    /// present tick.
    fn clocks_to_load(&self) -> u64 {
        let left = |axis_model: &crate::parallel::core::AxisModel| {
            axis_model.axis.running.then_some(axis_model.axis.left.saturating_sub(1))
        };
        let plain = self.core.axis_models.iter().filter_map(left).min().unwrap_or(u32::MAX);
        let clocks = u64::from(self.core.build.timebase.clocks_per_tick());
        (u64::from(plain) + 1) * clocks - 1 - self.core.clock_of_tick()
    }
}

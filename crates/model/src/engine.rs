//! The engine, described by its behaviour rather than by its structure: the motion of up to eight
//! axes, and beside it the readout, which outputs the state of the axes for a host. The readout
//! only observes: nothing that it does changes a pin.
//!
//! ```text
//! inputs ----> Motion -----> pins, queues, stops
//!    |           | P, segments, position, limits found
//!    | snapshot  v
//!    '------> Readout -----> words of state
//! ```

mod motion;
mod readout;

pub use motion::Motion;
pub use readout::Readout;
pub(crate) use readout::{Counted, Span};

use crate::parts::shaper;
use carrystep_core::EngineBuild;
use carrystep_core::engine::{EngineInputs, EngineOutputs};

/// The state of the engine. [`Engine::outputs`] and [`Engine::clock`] together are one clock cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Engine {
    motion: Motion,
    readout: Readout,
}

impl Engine {
    /// The engine at configuration.
    pub fn new(build: &EngineBuild) -> Self {
        Self { motion: Motion::new(build), readout: Readout::new(build) }
    }

    /// The registers of its motion.
    pub const fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The registers of its readout.
    pub const fn readout(&self) -> &Readout {
        &self.readout
    }

    /// P of an axis, in 2^-64 step. Panics if the axis does not exist.
    pub fn fraction(&self, axis: usize) -> u64 {
        self.motion.fraction(axis)
    }

    /// The registers of an axis' step shaper. Panics if the axis does not exist.
    pub fn shaper(&self, axis: usize) -> &shaper::ShaperState {
        self.motion.shaper(axis)
    }

    /// The outputs in this cycle for these inputs.
    pub fn outputs(&self, inputs: &EngineInputs) -> EngineOutputs {
        self.readout.outputs(&self.motion, inputs)
    }

    /// Advances by one cycle.
    pub fn clock(&mut self, inputs: &EngineInputs) {
        let ending = self.readout.observe(&self.motion, inputs);
        self.motion.clock(inputs);
        self.readout.clock(&self.motion, inputs, ending);
    }
}

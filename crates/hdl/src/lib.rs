//! The gateware as Rust-HDL modules: what docs/clock-by-clock.md says, register by register.
//!
//! Read [`axis`] first: the accumulator whose every carry is a step. [`shaper`] keeps the pins' promises,
//! [`tick`] gives the beat, [`six_axis`] puts them together, [`sim`] runs them.
//!
//! What a module promises, and why it holds, is `promises.sv` in its folder: `cargo xtask prove` asks a solver.
//!
//! A module's `Default` is its skeleton, all parameters zero: build modules with `new`.

pub mod axis;
pub mod constant;
pub mod edge;
pub mod engine;
pub mod lanes;
pub mod line;
pub mod link;
pub mod memory;
pub mod register;
pub mod sequencer;
pub mod shaper;
pub mod sim;
pub mod six_axis;
pub mod tick;
pub mod word;

pub use axis::Axis;
pub use engine::{AnyEngine, EngineSim, engine};
pub use line::{Spi, SpiSim, UartLine, UartSim};
pub use link::{AnyLink, LinkSim, link};
pub use sim::{AxisSim, SixAxisSim};
pub use six_axis::SixAxis;

use carrystep_spec::build::MAX_CLOCKS;
use carrystep_spec::engine::EngineError;
use thiserror::Error;

/// Why there is no gateware for a build.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum HdlError {
    /// A pin timing that the timers cannot count.
    #[error("pin timing {name} is {clocks} clocks: from 1 to {MAX_CLOCKS} can be counted")]
    PinTiming {
        /// width, gap, setup or hold.
        name: &'static str,
        /// What was asked for.
        clocks: u32,
    },
    /// Q is not 1, 4 or 16.
    #[error("{0} phases: a tick has 1, 4 or 16 phases")]
    Phases(u32),
    /// The engine has more to do in a tick than the tick has clocks, or counts further than it can.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// Rust-HDL's own check of a module failed.
    #[error("Rust-HDL refuses the module: {0}")]
    Check(String),
}

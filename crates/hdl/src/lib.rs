//! The gateware as Rust-HDL modules: what docs/clock-by-clock.md says, register by register.
//!
//! - [`engine`]: the product. One adder serves up to eight axes in time slots.
//! - [`parallel`]: its sibling, one adder chain an axis, as the article draws it. Read
//!   [`parallel::axis`] first: the accumulator whose every carry is a step.
//! - [`parts`]: what both are made of: the shaper of the pins, the edge, the tick.
//! - [`link`] and [`line`]: the host's requests, and the bytes that carry them.
//! - [`primitives`]: registers, memories, words and constants that Rust-HDL lacks.
//!
//! What a module promises, and why it holds, is `promises.sv` in its folder: `cargo xtask prove` asks a solver.
//!
//! A module's `Default` is its skeleton, all parameters zero: build modules with `new`.

pub mod engine;
pub mod line;
pub mod link;
pub mod parallel;
pub mod parameters;
pub mod parts;
pub mod primitives;
mod sim;

pub use engine::{AnyEngine, EngineSim, engine};
pub use line::{Spi, SpiSim, UartLine, UartSim};
pub use link::{AnyLink, LinkSim, link};
pub use parallel::{Axis, AxisSim, SixAxis, SixAxisSim};

use carrystep_core::build::MAX_CLOCKS;
use carrystep_core::engine::EngineError;
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

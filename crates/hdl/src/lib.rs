//! The gateware of carrystep, written as Rust-HDL modules.
//!
//! The modules implement docs/clock-by-clock.md register by register, and docs/self-test.md. The
//! crate `carrystep-verilog` exports them as Verilog; the `*Sim` types of this crate simulate them
//! clock by clock.
//!
//! - [`mod@engine`]: the product. One adder serves up to eight axes, each in its own time slot.
//! - [`parallel`]: the reference core. Each of up to six axes has its own adders, as the article
//!   draws it. Read [`parallel::axis`] first: it is the accumulator in which every carry is a step.
//! - [`parts`]: the modules of the parallel core that form pulses and divide time: the shaper, the
//!   edge and the tick. The engine uses the tick as well.
//! - [`mod@link`] and [`line`]: the host's requests, and the UART or SPI that carries their bytes.
//! - [`mod@self_test`]: a gateware of its own, with which a meter and a jumper prove the wiring.
//! - [`primitives`]: registers, memories, words and constants that Rust-HDL does not have.
//!
//! The folder of a module contains `promises.sv` where properties of the module are proved; the
//! command `cargo xtask prove` gives them to a solver.
//!
//! Every module has a `Default`, because Rust-HDL requires it. The default leaves all parameters at
//! zero and does not work as gateware; build a module with its `new`.

#[macro_use] // its `dff_setup!` stands in every kernel
pub mod primitives;

pub mod engine;
pub mod line;
pub mod link;
pub mod parallel;
pub mod parameters;
pub mod parts;
pub mod self_test;
mod sim;

#[cfg(not(test))]
pub use engine::sim::{AnyEngine, EngineSim, engine};
pub use line::{Spi, SpiSim, UartLine, UartSim};
#[cfg(not(test))]
pub use link::sim::{AnyLink, LinkSim, link};
pub use parallel::{
    AnyParallelCore, AxisSim, ParallelAxis, ParallelCore, ParallelSim, parallel_core,
};
pub use self_test::{SelfTest, SelfTestSim};

use carrystep_core::build::{MAX_CLOCKS, ParallelAxesError};
use carrystep_core::engine::EngineError;
use thiserror::Error;

/// The reason why a build cannot become gateware.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum HdlError {
    /// A pin timing is outside the range of the timers, 1 to [`MAX_CLOCKS`] clocks.
    #[error("pin timing {name} is {clocks} clocks: from 1 to {MAX_CLOCKS} can be counted")]
    PinTiming {
        /// The name of the timing: step_high, step_low, dir_setup or dir_hold.
        name: &'static str,
        /// The requested time in clocks.
        clocks: u32,
    },
    /// The number of phases per tick, Q, is not 1, 4 or 16.
    #[error("{0} phases: a tick has 1, 4 or 16 phases")]
    Phases(u32),
    /// The parallel core cannot have this number of axes.
    #[error(transparent)]
    ParallelAxes(#[from] ParallelAxesError),
    /// The time slots of all axes do not fit in a tick, or a parameter exceeds the range of its
    /// counter.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The check that Rust-HDL makes of every module has failed; the text is its message.
    #[error("Rust-HDL refuses the module: {0}")]
    Check(String),
}

//! The virtual board: models of the engine and of its host link, with the line between board and
//! host.
//!
//! ```text
//! bytes -> LineSender --rx--> Link ------> HostedEngine -> edges of STEP and DIR
//! bytes <- LineReceiver <---tx----- Link <--------     ^------- e-stop and limits
//! ```
//!
//! [`VerilatedBoard`] uses the exported Verilog instead of the models of link and engine. Time is
//! counted in clocks of the gateware; the caller decides how far the board runs.

mod board;
mod gateware;
mod line;
mod pace;
mod pin_levels;
#[cfg(unix)]
mod real_time;
mod spi;
#[cfg(unix)]
mod terminal;
mod verilated;
mod wire;

pub use board::{ModelBoard, Switches};
pub use carrystep_model::fast::Edges;
pub use gateware::{KEPT, SimulatedBoard};
pub use line::{LineReceiver, LineSender};
pub use pace::{Pace, Walk};
pub use pin_levels::PinLevels;
#[cfg(unix)]
pub use real_time::{RealTimeBoard, RealTimeError};
#[cfg(unix)]
pub use terminal::Terminal;
pub use verilated::VerilatedBoard;

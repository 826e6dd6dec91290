//! The virtual board: models of the engine and of its host link, with the line between board and
//! host.
//!
//! ```text
//! bytes -> Speaker --rx--> Link --------> FastEngine -> edges of STEP and DIR
//! bytes <- Ear <---tx----- Link <--------     ^------- e-stop and limits
//! ```
//!
//! [`VerilatedBoard`] uses the exported Verilog instead of the models of link and engine. Time is
//! counted in clocks of the gateware; the caller decides how far the board runs.

mod board;
#[cfg(unix)]
mod desk;
mod gateware;
mod line;
mod pace;
mod spi;
#[cfg(unix)]
mod terminal;
mod verilated;
mod wire;

pub use board::{Board, Switches};
pub use carrystep_model::fast::Edges;
#[cfg(unix)]
pub use desk::{Desk, DeskError};
pub use gateware::{Gateware, KEPT};
pub use line::{Ear, Speaker};
pub use pace::{Pace, Walk};
#[cfg(unix)]
pub use terminal::Terminal;
pub use verilated::VerilatedBoard;

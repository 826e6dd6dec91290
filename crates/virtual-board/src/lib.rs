//! A board that is not there: the model of the engine and of its host link, with the line between it and its host.
//!
//! ```text
//! bytes -> Speaker --rx--> Link --------> FastEngine -> edges of STEP and DIR
//! bytes <- Ear <---tx----- Link <--------     ^------- e-stop and limits
//! ```
//!
//! [`VerilatedBoard`] has the exported Verilog in the place of link and engine. Time is clocks of the gateware: whoever has
//! a board says how far it runs.

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

//! A board that is not there: the model of the engine and of its host link, with the line between it and its host.
//!
//! ```text
//! bytes -> Speaker --rx--> Link --------> FastEngine -> edges of STEP and DIR
//! bytes <- Ear <---tx----- Link <--------     ^------- e-stop and limits
//! ```
//!
//! Time is clocks of the gateware: whoever has a board says how far it runs.

mod board;
mod line;
mod pace;
#[cfg(unix)]
mod terminal;

pub use board::{Board, Switches};
pub use carrystep_model::fast::Edges;
pub use line::{Ear, Speaker};
pub use pace::{Pace, Walk};
#[cfg(unix)]
pub use terminal::Terminal;

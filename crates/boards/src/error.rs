//! What a board cannot do: each error names what it can.

use super::{boards, names};
use crate::clock::ClockError;
use carrystep_core::tick::mhz;
use carrystep_files::did_you_mean;
use thiserror::Error;

/// What a board cannot do.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum BoardError {
    /// There is no such board.
    #[error("no board is called '{name}'{}; there are {}", did_you_mean(name, boards().iter().map(|board| &*board.name)), names())]
    Unknown {
        /// What was asked for.
        name: String,
    },
    /// It is not sold with this part.
    #[error("{board} has no part '{part}'; there is {}", .parts.join(", "))]
    Part {
        /// The board.
        board: String,
        /// What was asked for.
        part: String,
        /// Those that there are.
        parts: Vec<String>,
    },
    /// More axes than it has pins for.
    #[error("{board} has pins for {has} axes, not for {wanted}: leave out axes, or take another board")]
    Axes {
        /// The board.
        board: String,
        /// STEP and DIR pins.
        has: usize,
        /// What the machine has.
        wanted: usize,
    },
    /// More limit switches than it has pins for.
    #[error("{board} has pins for {low} switches at low ends and {high} at high ends, too few for {wanted}: {instead}")]
    Limits {
        /// The board.
        board: String,
        /// Pins for low ends.
        low: usize,
        /// Pins for high ends.
        high: usize,
        /// What the machine has.
        wanted: String,
        /// What would do.
        instead: &'static str,
    },
    /// A port that is nowhere on it.
    #[error("{board} has no pin for {port}")]
    Port {
        /// The board.
        board: String,
        /// The port.
        port: String,
    },
    /// A baud rate that its serial chip does not take.
    #[error("{board}'s serial chip takes at most {most} baud, not {wanted}: set `baud` in [machine.link]")]
    Baud {
        /// The board.
        board: String,
        /// What it takes.
        most: u32,
        /// What the machine has.
        wanted: u32,
    },
    /// A clock that cannot be made on it.
    #[error("{board}: {source}; it is proposed to run at {proposed}")]
    Clock {
        /// The board.
        board: String,
        /// Why not.
        source: ClockError,
        /// Those that it is known to make.
        proposed: String,
    },
    /// A clock that its part is not fast enough for, as far as it was measured.
    #[error(
        "{board}: nextpnr reaches {} MHz with the shipped gateware, far less than the machine's {} MHz; \
         it is proposed to run at {proposed}",
        mhz(*.measured_hz),
        mhz(*.wanted_hz)
    )]
    Slow {
        /// The board.
        board: String,
        /// What the machine has, Hz.
        wanted_hz: u64,
        /// What was reached, Hz.
        measured_hz: u64,
        /// The clocks that it is known to make.
        proposed: String,
    },
}

//! A board on a desk: the terminal that its host opens, and the time that passes.

use crate::gateware::Gateware;
use crate::pace::Pace;
use crate::terminal::Terminal;
use carrystep_model::fast::Edges;
use carrystep_simulators::LevelError;
use std::io;
use std::time::Duration;
use thiserror::Error;

/// Looks at the host in a second of the board's time.
const LOOKS_PER_SECOND: u64 = 10_000;

/// Bytes on their way to the board from which on the host has to wait.
const FULL: usize = 256;

/// A wait for the time to pass, or for the host.
const NAP: Duration = Duration::from_micros(300);

/// Why a board goes on no more.
#[derive(Debug, Error)]
pub enum DeskError {
    /// What simulates it is gone.
    #[error(transparent)]
    Level(#[from] LevelError),
    /// Its terminal is.
    #[error("the pseudo-terminal is gone: {0}")]
    Terminal(#[from] io::Error),
}

/// Board, terminal and pace.
#[derive(Debug)]
pub struct Desk<B> {
    /// The board.
    pub board: B,
    terminal: Terminal,
    pace: Pace,
    clock_hz: u64,
}

impl<B: Gateware> Desk<B> {
    /// A board of this clock, Hz.
    pub fn new(board: B, terminal: Terminal, pace: Pace, clock_hz: u64) -> Self {
        Self { board, terminal, pace, clock_hz }
    }

    /// Goes on by a ten-thousandth of a second at the most; where the board is ahead of its time, naps.
    ///
    /// # Errors
    /// [`DeskError`].
    pub fn step(&mut self, to: &mut impl Edges) -> Result<(), DeskError> {
        if self.board.unsaid() < FULL {
            let bytes = self.terminal.take();
            if !bytes.is_empty() {
                self.pace.hear(self.board.cycle());
            }
            bytes.into_iter().for_each(|byte| self.board.say(byte));
        }
        let target = self.pace.target(self.board.cycle(), self.board.alone());
        self.board.run(target.min(self.board.cycle() + self.clock_hz / LOOKS_PER_SECOND), to)?;
        let heard: Vec<u8> = std::iter::from_fn(|| self.board.next_byte()).collect();
        if !heard.is_empty() {
            self.terminal.give(&heard)?;
        }
        if self.board.cycle() >= target {
            std::thread::sleep(NAP);
        }
        Ok(())
    }
}

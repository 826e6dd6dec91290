//! Connects a board to a pseudo-terminal that a host opens, and runs it at a pace.

use crate::gateware::SimulatedBoard;
use crate::pace::Pace;
use crate::terminal::Terminal;
use carrystep_model::fast::Edges;
use carrystep_simulators::LevelError;
use std::io;
use std::time::Duration;
use thiserror::Error;

/// Number of exchanges with the host per second of the board's time.
const EXCHANGES_PER_SECOND: u64 = 10_000;

/// Number of bytes that may wait. When as many from the host wait for the line, no more are read from
/// it; when as many from the board wait for the end of an answer, the host is given them.
const FULL: usize = 256;

/// Time to sleep before the next look at the time and at the host.
const NAP: Duration = Duration::from_micros(300);

/// Greatest time for which a board that needs its host waits for a byte before it returns: somebody
/// may want to end it.
const WAIT: Duration = Duration::from_millis(5);

/// Why a board cannot continue.
#[derive(Debug, Error)]
pub enum RealTimeError {
    /// The simulation has failed.
    #[error(transparent)]
    Level(#[from] LevelError),
    /// The pseudo-terminal has failed.
    #[error("the pseudo-terminal is gone: {0}")]
    Terminal(#[from] io::Error),
}

/// A board with its terminal and its pace.
#[derive(Debug)]
pub struct RealTimeBoard<B> {
    /// The board.
    pub board: B,
    terminal: Terminal,
    pace: Pace,
    clock_hz: u64,
    /// Bytes from the board that the host does not have yet.
    heard: Vec<u8>,
}

impl<B: SimulatedBoard> RealTimeBoard<B> {
    /// Connects a board with this clock, Hz, to a terminal.
    pub fn new(board: B, terminal: Terminal, pace: Pace, clock_hz: u64) -> Self {
        Self { board, terminal, pace, clock_hz, heard: Vec::new() }
    }

    /// Runs the board for at most a ten-thousandth of a second. If the board is ahead of its pace,
    /// sleeps for a short time; but a board that runs as fast as possible does not sleep while bytes
    /// are on the line, because the host would wait for them, and send its requests again. It gives
    /// its host whole answers, which wakes the host once and not every ten bytes.
    ///
    /// # Errors
    /// [`RealTimeError`] if the simulation or the terminal has failed.
    pub fn step(&mut self, to: &mut dyn Edges) -> Result<(), RealTimeError> {
        if self.board.unsaid() < FULL {
            self.terminal.take().into_iter().for_each(|byte| self.board.say(byte));
        }
        if self.pace.is_fast() && self.board.talks() {
            self.pace.hear(self.board.cycle());
        }
        if self.pace.is_fast() && !self.terminal.is_open(Duration::ZERO) {
            self.pace.lose();
        }
        let target = self.pace.target(self.board.cycle(), self.board.alone());
        self.board
            .run(target.min(self.board.cycle() + self.clock_hz / EXCHANGES_PER_SECOND), to)?;
        let waits = self.board.cycle() >= target && !(self.pace.is_fast() && self.board.talks());
        self.heard.extend(std::iter::from_fn(|| self.board.next_byte()));
        let is_within_an_answer = self.pace.is_fast() && self.board.is_answering() && !waits;
        if !self.heard.is_empty() && (!is_within_an_answer || self.heard.len() >= FULL) {
            self.terminal.give(&self.heard)?;
            self.heard.clear();
        }
        if waits && !(self.pace.needs_host() && self.terminal.is_open(WAIT)) {
            std::thread::sleep(NAP);
        }
        Ok(())
    }
}

//! A virtual board on its desk: the terminal that its host opens, its switches, and the time that passes.

use crate::failure::Failure;
use crate::interrupt;
use crate::switches::Panel;
use carrystep_board::{Edges, Gateware, Pace, Terminal};
use std::io::Write as _;
use std::sync::atomic::Ordering;
use std::time::Duration;

/// Looks at the host and at the switches in a second of the board's time.
const LOOKS_PER_SECOND: u64 = 10_000;

/// Bytes on their way to the board from which on the host has to wait.
const FULL: usize = 256;

/// A wait for the time to pass, or for the host.
const NAP: Duration = Duration::from_micros(300);

/// All of it.
pub struct Desk<B> {
    pub board: B,
    pub terminal: Terminal,
    pub pace: Pace,
    pub panel: Panel,
    /// Of the board, Hz.
    pub clock_hz: u64,
}

impl<B: Gateware> Desk<B> {
    /// Goes on until the first start; false where it is to end before.
    pub fn until_start(&mut self) -> Result<bool, Failure> {
        while self.board.loads().is_empty() {
            if !self.step(&mut ())? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Goes on a little; false where it is to end.
    pub fn step(&mut self, to: &mut impl Edges) -> Result<bool, Failure> {
        let look = self.panel.look(|axis| self.board.position(axis));
        for line in look.unknown {
            // Nobody is left to tell if this fails.
            let _ = writeln!(std::io::stderr(), "not understood: {line:?}; estop 1, min x 1, max x 0, end are");
        }
        if look.ends || interrupt::watch().load(Ordering::Relaxed) {
            return Ok(false);
        }
        self.board.press(look.switches);
        if self.board.unsaid() < FULL {
            let bytes = self.terminal.take();
            if !bytes.is_empty() {
                self.pace.hear(self.board.cycle());
            }
            bytes.into_iter().for_each(|byte| self.board.say(byte));
        }
        let target = self.pace.target(self.board.cycle(), self.board.to_go());
        self.board.run(target.min(self.board.cycle() + self.clock_hz / LOOKS_PER_SECOND), to)?;
        let heard: Vec<u8> = std::iter::from_fn(|| self.board.next_byte()).collect();
        if !heard.is_empty() {
            self.terminal
                .give(&heard)
                .map_err(|error| Failure::Run(format!("the pseudo-terminal is gone: {error}")))?;
        }
        if self.board.cycle() >= target {
            std::thread::sleep(NAP);
        }
        Ok(true)
    }
}

//! A virtual board together with its operator's switches, and the main loop of
//! `carrystep virtual-board`.

use crate::failure::Failure;
use crate::interrupt;
use crate::switches::{KNOWN, SwitchPanel};
use carrystep_virtual_board::{Edges, RealTimeBoard, RealTimeError, SimulatedBoard};
use std::io::Write as _;
use std::sync::atomic::Ordering;

/// The board at its pseudo-terminal, and its switches.
pub struct OperatedBoard<B> {
    pub real_time: RealTimeBoard<B>,
    pub panel: SwitchPanel,
}

impl<B: SimulatedBoard> OperatedBoard<B> {
    /// Runs until the first start. Returns false if the board is to end before it.
    pub fn until_start(&mut self) -> Result<bool, Failure> {
        while self.real_time.board.loads().is_empty() {
            if !self.step(&mut ())? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Runs for a short time. Returns false if the board is to end.
    pub fn step(&mut self, to: &mut impl Edges) -> Result<bool, Failure> {
        let look = self.panel.look(|axis| self.real_time.board.position(axis));
        for line in look.unknown {
            // If this write fails, there is no channel left to report it.
            let _ = writeln!(std::io::stderr(), "not understood: {line:?}; known are: {KNOWN}");
        }
        if look.ends || interrupt::watch().load(Ordering::Relaxed) {
            return Ok(false);
        }
        self.real_time.board.press(look.switches);
        self.real_time.step(to).map_err(|error| match error {
            RealTimeError::Level(error) => error.into(),
            RealTimeError::Terminal(_) => Failure::Run(error.to_string()),
        })?;
        Ok(true)
    }
}

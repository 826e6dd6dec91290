//! A virtual board whose user is there: presses its switches, and ends it.

use crate::failure::Failure;
use crate::interrupt;
use crate::switches::Panel;
use carrystep_virtual_board::{Desk, DeskError, Edges, Gateware};
use std::io::Write as _;
use std::sync::atomic::Ordering;

/// The board on its desk, and its switches.
pub struct Manned<B> {
    pub desk: Desk<B>,
    pub panel: Panel,
}

impl<B: Gateware> Manned<B> {
    /// Goes on until the first start; false where it is to end before.
    pub fn until_start(&mut self) -> Result<bool, Failure> {
        while self.desk.board.loads().is_empty() {
            if !self.step(&mut ())? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Goes on a little; false where it is to end.
    pub fn step(&mut self, to: &mut impl Edges) -> Result<bool, Failure> {
        let look = self.panel.look(|axis| self.desk.board.position(axis));
        for line in look.unknown {
            // Nobody is left to tell if this fails.
            let _ = writeln!(std::io::stderr(), "not understood: {line:?}; estop 1, min x 1, max x 0, end are");
        }
        if look.ends || interrupt::watch().load(Ordering::Relaxed) {
            return Ok(false);
        }
        self.desk.board.press(look.switches);
        self.desk.step(to).map_err(|error| match error {
            DeskError::Level(error) => error.into(),
            DeskError::Terminal(_) => Failure::Run(error.to_string()),
        })?;
        Ok(true)
    }
}

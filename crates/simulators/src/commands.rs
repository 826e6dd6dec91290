//! The commands that a host sends, as a list or made while they are sent.

use carrystep_core::{Command, Program};
use std::fmt;

/// The commands of a program.
pub trait Commands: fmt::Debug {
    /// All commands in order, from the first one on.
    fn commands(&self) -> Box<dyn Iterator<Item = Command> + '_>;

    /// Number of segments.
    fn segments(&self) -> u64;
}

impl Commands for Program {
    fn commands(&self) -> Box<dyn Iterator<Item = Command> + '_> {
        Box::new(self.iter().copied())
    }

    fn segments(&self) -> u64 {
        self.iter().filter(|command| matches!(command, Command::Segment { .. })).count() as u64
    }
}

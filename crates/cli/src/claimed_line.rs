//! A serial line that marks the claim on its port as ending before the port is closed.
//!
//! ```text
//! claim    held ............................... ending .......... ended
//! port     open ....................................... closed
//! another  "is in use by ..."                   waits             has it
//! ```
//!
//! When the port is closed and the claim has not ended yet, nobody uses the port. The claim may even
//! name another device then: it names a device by its number, and the system gives the number of a
//! pseudo-terminal that is closed at both ends to the next one.

use crate::control::EndMark;
use carrystep_link::{Exchanged, Line};

/// A line to a board, at a port that is claimed.
pub struct ClaimedLine<L> {
    line: L,
    mark: EndMark,
}

impl<L> ClaimedLine<L> {
    /// A line, and the mark of the claim on its port.
    pub const fn new(line: L, mark: EndMark) -> Self {
        Self { line, mark }
    }
}

impl<L: Line> Line for ClaimedLine<L> {
    type Error = L::Error;

    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Self::Error> {
        self.line.exchange(out, into)
    }
}

impl<L> Drop for ClaimedLine<L> {
    fn drop(&mut self) {
        // The fields are dropped afterwards.
        self.mark.set();
    }
}

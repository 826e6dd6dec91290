//! Detects a start that the gateware has cancelled: an axis that hits the source of its seek before
//! an armed start takes effect cancels this start for all its axes, and no answer says so. Segments
//! of the other axes then wait, and nothing moves.

use crate::frame::{Answer, of_axis};
use crate::registers::{MOST_AXES, STATUS, STATUS_RUNS};
use crate::session::Session;

/// What the host has seen since an axis last ran or all queues were empty.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CancelledStart {
    /// Axes that were seen at rest in this round of reads, one bit each.
    resting: u8,
    /// Number of complete rounds in which no axis ran.
    rounds: u8,
}

impl CancelledStart {
    /// Reads whether each axis runs. Called once per period of the host's reads of the state, while
    /// the program is handed over and a seek is under way.
    pub fn ask<const N: usize>(&mut self, session: &mut Session<N>, axes: u8) {
        for axis in 0..axes {
            // An error only means that enough reads are in progress.
            let _ = session.read(of_axis(STATUS, axis));
        }
    }

    /// Processes an answer of a build of `axes` axes.
    pub fn hear(&mut self, answer: &Answer, axes: u8) {
        if answer.idle || answer.armed {
            *self = Self::default();
        }
        let read = (0..axes.min(MOST_AXES)).find(|&axis| answer.is_read_of(of_axis(STATUS, axis)));
        let Some(axis) = read else { return };
        if answer.data & STATUS_RUNS != 0 {
            *self = Self::default();
            return;
        }
        self.resting |= 1 << axis;
        if u32::from(self.resting) == (1_u32 << axes) - 1 {
            self.resting = 0;
            self.rounds = self.rounds.saturating_add(1);
        }
    }

    /// Whether nothing moves although segments wait and no start is armed. One round may be read
    /// between the last tick of an axis and the end of its last pulse; two may not.
    pub const fn is_certain(&self) -> bool {
        self.rounds >= 2
    }
}

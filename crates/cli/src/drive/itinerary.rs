//! What a board is to do: the plan's figures, and its segments in stretches from rest to rest.

use super::outcome::ProgramDriven;
use crate::failure::Failure;
use carrystep_files::Machine;
use carrystep_link::{Queues, SegmentSource};
use carrystep_runner::{BlockAt, Wait};

/// The figures of a plan that has been planned to its end.
pub struct Plan<'a> {
    /// The machine.
    pub machine: &'a Machine,
    /// How long the motion lasts, s.
    pub seconds: f64,
    /// Direction of the first motion of each axis: 1, -1, or 0 if it does not move.
    pub first: &'a [i8],
    /// Steps of each axis from the beginning to the end.
    pub steps: Vec<i64>,
    /// What is reported of a G-code program.
    pub program: Option<ProgramDriven>,
}

/// The segments of a plan, stretch by stretch.
pub trait Itinerary {
    /// Begins the next stretch, and returns what is waited for before. `None` at the end.
    fn begin(&self) -> Option<Vec<Wait>>;

    /// The segments of the stretch that was begun last.
    fn source(&self) -> Box<dyn SegmentSource + '_>;

    /// Ends the present stretch early, on the path. Returns the number of segments of each axis
    /// behind which the board is to cut its queues; `None` if the hold comes behind them, or if the
    /// limits forbid one now.
    fn hold(&self, _queues: Option<Queues>) -> Option<u32> {
        None
    }

    /// Whether a hold ends the present stretch.
    fn is_held(&self) -> bool {
        false
    }

    /// In which block of a program the tool is if the axes have moved by these steps since the
    /// beginning.
    fn block(&self, _moved: &[i32]) -> Option<BlockAt> {
        None
    }

    /// Drops what is left, except that all outputs go off in a last stretch.
    fn end(&self) {}

    /// Checks that nothing was missing.
    ///
    /// # Errors
    /// The file has changed since it was planned first, or cannot be read any more.
    fn whole(&self) -> Result<(), Failure>;
}

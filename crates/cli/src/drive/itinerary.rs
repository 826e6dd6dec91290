//! What a board is to do: the plan's figures, and its segments in stretches from rest to rest.

use super::outcome::ProgramDriven;
use crate::failure::Failure;
use carrystep_files::Machine;
use carrystep_link::SegmentSource;
use carrystep_program::Offsets;
use carrystep_runner::Wait;

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

    /// Ends the present stretch early, on the path. Returns false if it ends by itself before, or
    /// cannot be held.
    fn hold(&self) -> bool {
        false
    }

    /// Drops what is left, except that all outputs go off in a last stretch.
    fn end(&self) {}

    /// Notes that the board rests at one of the places before the stretch, and waits. Returns the
    /// work offsets that are in force there; `None` if they are not kept.
    ///
    /// # Errors
    /// The file has changed.
    fn waits(&self, _at: Wait) -> Result<Option<Offsets>, Failure> {
        Ok(None)
    }

    /// The work offsets behind the whole way; `None` if they stay as they were before.
    fn offsets(&self) -> Option<Offsets> {
        None
    }

    /// Checks that nothing was missing.
    ///
    /// # Errors
    /// The file has changed since it was planned first, or cannot be read any more.
    fn whole(&self) -> Result<(), Failure>;
}

//! What a board is to do: the plan's figures, and its segments in stretches from rest to rest.

use super::outcome::ProgramDriven;
use crate::failure::Failure;
use carrystep_core::Segment;
use carrystep_files::Machine;
use carrystep_link::{Queues, SegmentSource, Status, Wish};
use carrystep_program::{Found, Offsets, Point, ProgramFile, Stop};
use carrystep_runner::{BlockAt, OverrideSetting, Wait};

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

/// The rest of a program that was planned again.
#[derive(Debug)]
pub struct Rest {
    /// Steps of each axis to the end.
    pub steps: Vec<i64>,
    /// How long the motion lasts, s.
    pub seconds: f64,
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

    /// The overrides of what is sent from now on.
    fn overrides(&self) -> OverrideSetting {
        OverrideSetting::NONE
    }

    /// Changes the overrides. Returns the number of segments of each axis behind which the board is
    /// to cut its queues; `None` if the change comes behind them.
    fn set_overrides(&self, _to: OverrideSetting, _queues: Option<Queues>) -> Option<u32> {
        None
    }

    /// Planned seconds that pass in a second of the motion that was sent last.
    fn rate(&self) -> f64 {
        1.0
    }

    /// Where the board rests: how long the motion has lasted since it was planned, s, if this is
    /// known.
    fn gone(&self) -> Option<f64> {
        None
    }

    /// By how much holds have made the motion longer since it was planned, s.
    fn added(&self) -> f64 {
        0.0
    }

    /// In which block of a program the tool is if the axes have moved by these steps since the
    /// beginning.
    fn block(&self, _moved: &[i32]) -> Option<BlockAt> {
        None
    }

    /// Drops what is left, except that all outputs go off in a last stretch.
    fn end(&self) {}

    /// Notes that the board rests at one of the places before the stretch. Returns what is in force
    /// there, and what is read; `None` in a hold.
    ///
    /// # Errors
    /// The file has changed.
    fn waits(&self, _at: Wait) -> Result<Option<Stop>, Failure> {
        Ok(None)
    }

    /// The work offsets behind the whole way, where the board has this state; `None` if they stay
    /// as they were before.
    fn offsets(&self, _end: &Status) -> Option<Offsets> {
        None
    }

    /// Whether the work offsets are kept behind the run.
    fn keeps(&self) -> bool {
        false
    }

    /// The program, as it began, if it is one.
    fn program(&self) -> Option<&ProgramFile> {
        None
    }

    /// Where the board waits: the segments of each axis that bring P to its start value in these
    /// ticks, without a step.
    fn settling(&self, _ticks: u32) -> Vec<Vec<Segment>> {
        Vec::new()
    }

    /// Plans the rest of a program that waits, or that has read something. It begins at this machine
    /// place, in mm and degrees, with these offsets if any were set. Then [`Itinerary::begin`] begins
    /// it. `wish` is called now and then; a stop ends the planning.
    ///
    /// # Errors
    /// The rest cannot be executed from there; then nothing has changed.
    fn resume(
        &self,
        _at: Point,
        _offsets: Option<Offsets>,
        _found: Found,
        _wish: &mut dyn FnMut() -> Wish,
    ) -> Result<Rest, Failure> {
        Err(Failure::Run("only programs go on from another place".into()))
    }

    /// Checks that nothing was missing.
    ///
    /// # Errors
    /// The file has changed since it was planned first, or cannot be read any more.
    fn whole(&self) -> Result<(), Failure>;
}

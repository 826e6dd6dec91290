//! A pause of a program: other commands jog and set work offsets, and behind it the rest of the
//! program is planned from the real place if anything was changed.

use super::itinerary::{Itinerary, Rest};
use super::moves::Moves;
use crate::connection::{ConnectedBoard, ConnectedBoardError};
use crate::control::Control;
use crate::failure::Failure;
use crate::jog;
use crate::limits::ClosedLimits;
use crate::memory::BoardMemory;
use crate::pause::{PauseResult, PauseWish};
use crate::work;
use carrystep_core::Segment;
use carrystep_link::{Answer, Ended, HostError, SegmentSource, Status, Wish};
use carrystep_program::{AXIS_LETTERS, Found, Offsets, Point, ProgramFile};
use std::collections::VecDeque;

/// Time in which P of the axes goes to its start value, s.
pub(super) const SETTLING: f64 = 0.004;

/// A program that waits.
pub(super) struct Pause<'a> {
    itinerary: &'a dyn Itinerary,
    memory: &'a mut BoardMemory,
    axes: &'a [String],
    /// Machine place of the registers' zero, steps.
    zero: &'a [i64],
    /// The work offsets in force; `None` in a hold, in which nothing can be changed.
    offsets: Option<Offsets>,
    /// Whether P of all axes has its start value.
    settled: bool,
    changed: bool,
}

/// Why something was not done: the user's mistake, or the board.
enum Refused {
    Input(String),
    Stopped,
    Board(ConnectedBoardError),
}

impl From<ConnectedBoardError> for Refused {
    fn from(error: ConnectedBoardError) -> Self {
        Self::Board(error)
    }
}

impl From<Failure> for Refused {
    fn from(failure: Failure) -> Self {
        Self::Input(failure.message())
    }
}

impl<'a> Pause<'a> {
    /// The program waits with these offsets; `None` in a hold. `zero` is the machine place of the
    /// registers' zero in steps.
    pub fn new(
        itinerary: &'a dyn Itinerary,
        memory: &'a mut BoardMemory,
        (axes, zero): (&'a [String], &'a [i64]),
        offsets: Option<Offsets>,
    ) -> Self {
        Self { itinerary, memory, axes, zero, offsets, settled: false, changed: false }
    }

    /// Does what was asked if something was, and gives the control the result.
    pub fn look(
        &mut self,
        board: &mut ConnectedBoard,
        control: &mut Control,
        waits: &str,
    ) -> Result<(), ConnectedBoardError> {
        let program = control.program();
        let Some(text) = program.and_then(|program| program.wish().map(str::to_owned)) else {
            return Ok(());
        };
        let (error, stopped) = match self.execute(board, control, &text) {
            Ok(()) => (None, false),
            Err(Refused::Input(message)) => (Some(message), false),
            Err(Refused::Stopped) => {
                let message = "the jog was stopped, and the program ends: the axes rest where they \
                               are, and the positions are valid";
                (Some(message.to_owned()), true)
            }
            Err(Refused::Board(error)) => return Err(error),
        };
        let file = self.itinerary.program();
        let place = file.map(|file| self.place(file, board.status())).unwrap_or_default();
        let letters = file.into_iter().flat_map(|file| file.letters().of_axes());
        let place = letters.map(|&letter| (AXIS_LETTERS[letter], place[letter])).collect();
        let offsets = self.offsets.as_ref().map(work::named).unwrap_or_default();
        let waits = waits.to_owned();
        let result = PauseResult { passed: error.is_none(), error, stopped, waits, place, offsets };
        let result = serde_json::to_string(&result).unwrap_or_default();
        control.program().into_iter().for_each(|program| program.did(result.clone()));
        Ok(())
    }

    /// The rest of the program, planned from the real place if anything was changed.
    ///
    /// # Errors
    /// The rest cannot be executed from there. The program still waits.
    pub fn go_on(
        &mut self,
        status: &Status,
        wish: &mut dyn FnMut() -> Wish,
    ) -> Result<Option<Rest>, Failure> {
        let Some((file, offsets)) =
            self.itinerary.program().zip(self.offsets.clone()).filter(|_| self.changed)
        else {
            return Ok(None);
        };
        let place = self.place(file, status);
        self.itinerary.resume(place, Some(offsets), Found::Nothing, wish).map(Some)
    }

    fn execute(
        &mut self,
        board: &mut ConnectedBoard,
        control: &mut Control,
        text: &str,
    ) -> Result<(), Refused> {
        let wish: PauseWish =
            serde_json::from_str(text).map_err(|error| Refused::Input(error.to_string()))?;
        let Some((file, offsets)) = self.itinerary.program().zip(self.offsets.clone()) else {
            let message = "the program is held on its path: jogs and offsets are possible at M0, M1 \
                           and M6";
            return Err(Refused::Input(message.to_owned()));
        };
        match wish {
            PauseWish::Show => Ok(()),
            PauseWish::Clear => self.set(board, Offsets::default()),
            PauseWish::Set(target, values) => {
                self.settle(board, control)?;
                let at = self.place(file, board.status());
                self.set(board, work::set(&offsets, at, target, &values)?)
            }
            PauseWish::Jog(wish) => {
                let moves = wish.file(file.machine())?;
                jog::within_travel(&moves, &self.places(file, board.status()))?;
                let planned = Moves::in_a_pause(moves.into())?;
                if !wish.into_limit {
                    let closed = ClosedLimits::read(board)?;
                    let (wiring, met) = (file.machine().guard.limits, self.memory.limits());
                    closed.check(wiring, planned.plan().first, &met, self.axes)?;
                }
                self.settle(board, control)?;
                self.changed = true;
                let way = planned.itinerary();
                way.begin();
                stream(board, control, way.source())
            }
        }
    }

    fn set(&mut self, board: &mut ConnectedBoard, offsets: Offsets) -> Result<(), Refused> {
        self.changed = true;
        if self.itinerary.keeps() {
            self.memory.set_work(offsets.clone());
            // At the end the file is written again.
            let _ = self.memory.drives(board);
        }
        self.offsets = Some(offsets);
        Ok(())
    }

    /// Brings P of all axes to its start value, where a jog and the rest of a program begin. No axis
    /// makes a step.
    fn settle(&mut self, board: &mut ConnectedBoard, control: &mut Control) -> Result<(), Refused> {
        if !self.settled
            && let Some(file) = self.itinerary.program()
        {
            let ticks = (SETTLING / file.machine().timebase.tick_seconds()).ceil() as u32;
            stream(board, control, Box::new(Parts::new(self.itinerary.settling(ticks))))?;
            self.settled = true;
        }
        Ok(())
    }

    /// The machine place of the board, mm and degrees.
    fn place(&self, file: &ProgramFile, status: &Status) -> Point {
        let mut at = Point::default();
        let steps = self.zero.iter().zip(status.positions);
        for (&letter, (zero, position)) in file.letters().of_axes().iter().zip(steps) {
            at[letter] = (zero + i64::from(position)) as f64 * file.letters().step()[letter];
        }
        at
    }

    /// The machine places in steps of the axes that `travel` bounds.
    fn places(&self, file: &ProgramFile, status: &Status) -> Vec<Option<i64>> {
        let steps = self.zero.iter().zip(status.positions);
        let axes = file.machine().axes.iter().zip(steps);
        axes.map(|(axis, (zero, position))| axis.travel.map(|_| zero + i64::from(position)))
            .collect()
    }
}

/// Streams a move at rest. A stop, and a signal that ends the program, ramp it down, and then the
/// program is ended.
fn stream<'s>(
    board: &mut ConnectedBoard,
    control: &mut Control,
    source: Box<dyn SegmentSource + 's>,
) -> Result<(), Refused> {
    let mut source = source;
    let ended = board.stream(&mut *source, |progress| {
        let ends = control.program().is_some_and(|program| program.ends());
        match control.wish(progress.status) {
            Wish::GoOn if !ends => Wish::GoOn,
            _ => Wish::Stop,
        }
    })?;
    if ended == Ended::Stopped {
        board.clear()?;
    }
    let answer = board.read_status()?.answer;
    if answer.fault {
        let Answer { cause, culprits, .. } = answer;
        return Err(Refused::Board(HostError::Fault { cause, culprits }));
    }
    if ended == Ended::Stopped { Err(Refused::Stopped) } else { Ok(()) }
}

/// Segments of all axes, which start together.
pub(super) struct Parts {
    segments: Vec<VecDeque<Segment>>,
    start: Option<u8>,
}

impl Parts {
    pub fn new(segments: Vec<Vec<Segment>>) -> Self {
        let start = Some(((1_u16 << segments.len()) - 1) as u8);
        Self { segments: segments.into_iter().map(VecDeque::from).collect(), start }
    }
}

impl SegmentSource for Parts {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        self.segments.get_mut(usize::from(axis))?.pop_front()
    }

    fn start(&mut self) -> Option<u8> {
        self.start.take()
    }
}

//! A pause of a program: other commands jog, probe and set work offsets, and behind it the rest of
//! the program is planned from the real place if anything was changed.

use super::itinerary::{Itinerary, Rest};
use super::moves::Moves;
use super::place::{named_point, point_at};
use super::settle::{Parts, settling_ticks};
use super::touch::{Touched, go, is_closed, touch};
use super::ways::Ways;
use crate::connection::{ConnectedBoard, ConnectedBoardError};
use crate::control::Control;
use crate::failure::Failure;
use crate::jog::{self, JogWish};
use crate::json;
use crate::limits::ClosedLimits;
use crate::memory::{self, BoardMemory};
use crate::pause::{PauseResult, PauseWish};
use crate::probe::ProbeWish;
use crate::work;
use carrystep_files::Axis;
use carrystep_link::{Ended, SegmentSource, Status, Wish};
use carrystep_program::{Found, Offsets, Point, ProgramFile};

/// A program that waits.
pub(super) struct Pause<'a> {
    itinerary: &'a dyn Itinerary,
    memory: &'a mut BoardMemory,
    ways: &'a mut Ways,
    axes: &'a [String],
    /// Machine place of the registers' zero, steps.
    zero: &'a [i64],
    /// The work offsets in force; `None` in a hold, in which nothing can be changed.
    offsets: Option<Offsets>,
    /// Whether P of all axes has its start value.
    settled: bool,
    changed: bool,
    /// Where the probe has ended the move that was wanted last.
    touched: Option<Point>,
}

/// Why something was not done: the user's mistake, or the board.
enum Refused {
    Input(String),
    Missed(String),
    /// The work offsets cannot be written.
    NotKept(String),
    /// What was stopped.
    Stopped(&'static str),
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
        (memory, ways): (&'a mut BoardMemory, &'a mut Ways),
        (axes, zero): (&'a [String], &'a [i64]),
        offsets: Option<Offsets>,
    ) -> Self {
        Self {
            itinerary,
            memory,
            ways,
            axes,
            zero,
            offsets,
            settled: false,
            changed: false,
            touched: None,
        }
    }

    /// Does what was asked if something was, and gives the control the result. Returns whether
    /// something was.
    pub fn look(
        &mut self,
        board: &mut ConnectedBoard,
        control: &mut Control,
        waits: &str,
    ) -> Result<bool, ConnectedBoardError> {
        let program = control.program();
        let Some(text) = program.and_then(|program| program.wish().map(str::to_owned)) else {
            return Ok(false);
        };
        let mut result = PauseResult { waits: waits.to_owned(), ..PauseResult::default() };
        self.touched = None;
        match self.execute(board, control, &text) {
            Ok(()) => result.passed = true,
            Err(Refused::Input(message)) => result.error = Some(message),
            Err(Refused::NotKept(message)) => {
                (result.error, result.unkept) = (Some(message), true);
            }
            Err(Refused::Missed(message)) => {
                (result.error, result.missed) = (Some(message), true);
            }
            Err(Refused::Stopped(what)) => {
                result.error = Some(format!(
                    "the {what} was stopped, and the program ends: the axes rest where they are, and \
                     the positions are valid"
                ));
                result.stopped = true;
            }
            Err(Refused::Board(error)) => return Err(error),
        }
        if let Some(file) = self.itinerary.program() {
            let letters = file.letters();
            result.place = named_point(letters, &self.place(file, board.status()));
            result.touched = self.touched.as_ref().map(|at| named_point(letters, at));
        }
        result.offsets = self.offsets.as_ref().map(work::named).unwrap_or_default();
        let result = json::line(&result).unwrap_or_default();
        control.program().into_iter().for_each(|program| program.did(result.clone()));
        Ok(true)
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
            PauseWish::Set(wish) => {
                self.settle(board, control)?;
                let at = self.place(file, board.status());
                self.set(board, work::set(&offsets, at, &wish)?)
            }
            PauseWish::Jog(wish, then) => {
                let planned = self.planned(board, file, &wish)?;
                if then.is_some() {
                    self.keep(board)?;
                }
                self.settle(board, control)?;
                let way = planned.itinerary();
                way.begin();
                self.stream(board, control, way.source(), "jog")?;
                let Some(then) = then else { return Ok(()) };
                let at = self.place(file, board.status());
                self.set(board, work::set(&offsets, at, &then)?)
            }
            PauseWish::Probe(wish) => self.probe(board, control, (file, &offsets), &wish),
        }
    }

    /// Plans a jog that begins where the board rests.
    fn planned(
        &self,
        board: &mut ConnectedBoard,
        file: &ProgramFile,
        wish: &JogWish,
    ) -> Result<Moves, Refused> {
        let moves = wish.file(file.machine())?;
        jog::within_travel(&moves, &self.places(file, board.status()))?;
        let planned = Moves::unwatched(moves.into())?;
        if !wish.into_limit {
            let closed = ClosedLimits::read(board)?;
            let (wiring, met) = (file.machine().guard.limits, self.memory.limits());
            closed.check(wiring, planned.plan().first, &met, self.axes)?;
        }
        Ok(planned)
    }

    /// Moves an axis until the probe ends the move, and sets what is wanted there.
    fn probe(
        &mut self,
        board: &mut ConnectedBoard,
        control: &mut Control,
        (file, offsets): (&ProgramFile, &Offsets),
        wanted: &ProbeWish,
    ) -> Result<(), Refused> {
        let (machine, letters) = (file.machine(), file.letters());
        let number = wanted.axis(machine)?;
        let planned = self.planned(board, file, &wanted.way())?;
        if is_closed(board)? != wanted.away {
            return Err(Refused::Input(wanted.already()));
        }
        if wanted.target.is_some() {
            self.keep(board)?;
        }
        self.settle(board, control)?;
        let place = |motors: &[f64]| machine.letter_steps(number, motors);
        let began = place(&board.status().positions.map(f64::from));
        let moves = (&planned, !wanted.away);
        let ways = &mut *self.ways;
        let touched = match touch(board, machine, moves, &mut |status| wish(control, ways, status))?
        {
            Touched::At(steps) => steps,
            Touched::Missed => return Err(Refused::Missed(wanted.missed())),
            Touched::Stopped => return Err(Refused::Stopped("probe move")),
        };
        let at = point_at(letters, self.zero, &touched);
        self.touched = Some(at);
        if let Some(offsets) = wanted.offsets(offsets, (machine, letters), at)? {
            self.set(board, offsets)?;
        }
        let rests = place(&board.status().positions.map(f64::from));
        let from = [place(&touched), began, rests];
        let Some(back) = wanted.back(&machine.axes[number], from) else { return Ok(()) };
        let back = Moves::unwatched(back.file(machine)?.into())?;
        let way = back.itinerary();
        way.begin();
        self.stream(board, control, way.source(), "way back from the touched place")
    }

    /// Sets the offsets, unless they cannot be kept: then those of before are in force.
    fn set(&mut self, board: &mut ConnectedBoard, offsets: Offsets) -> Result<(), Refused> {
        if self.itinerary.keeps() {
            self.memory.set_work(offsets.clone());
            if let Err(refused) = self.keep(board) {
                self.offsets.iter().for_each(|before| self.memory.set_work(before.clone()));
                return Err(refused);
            }
        }
        self.changed = true;
        self.offsets = Some(offsets);
        Ok(())
    }

    /// Writes the work offsets if they are kept: before anything moves, and where they change.
    fn keep(&mut self, board: &mut ConnectedBoard) -> Result<(), Refused> {
        if !self.itinerary.keeps() {
            return Ok(());
        }
        let kept = self.memory.drives(board);
        kept.map_err(|error| Refused::NotKept(memory::not_kept(&error).message()))
    }

    /// Brings P of all axes to its start value, where a jog and the rest of a program begin. No axis
    /// makes a step.
    fn settle(&mut self, board: &mut ConnectedBoard, control: &mut Control) -> Result<(), Refused> {
        if !self.settled
            && let Some(file) = self.itinerary.program()
        {
            // The plan goes on from the P of before.
            self.changed = true;
            let parts = self.itinerary.settling(settling_ticks(file.machine()));
            self.stream(board, control, Box::new(Parts::new(parts)), "jog")?;
            self.settled = true;
        }
        Ok(())
    }

    /// Streams a move at rest. A stop, and a signal that ends the program, ramp it down, and then
    /// the program is ended.
    fn stream<'s>(
        &mut self,
        board: &mut ConnectedBoard,
        control: &mut Control,
        source: Box<dyn SegmentSource + 's>,
        what: &'static str,
    ) -> Result<(), Refused> {
        let ways = &mut *self.ways;
        match go(board, source, &mut |status| wish(control, ways, status))? {
            Ended::Stopped => Err(Refused::Stopped(what)),
            Ended::Done | Ended::SeekEnded => Ok(()),
        }
    }

    /// The machine place of the board, mm and degrees.
    fn place(&self, file: &ProgramFile, status: &Status) -> Point {
        let positions = status.positions.map(f64::from);
        point_at(file.letters(), self.zero, &positions)
    }

    /// The machine places in steps of the letters that `travel` bounds.
    fn places(&self, file: &ProgramFile, status: &Status) -> Vec<Option<f64>> {
        let steps = self.zero.iter().zip(status.positions);
        let motors: Vec<f64> = steps.map(|(zero, at)| (zero + i64::from(at)) as f64).collect();
        let machine = file.machine();
        let place = |(number, axis): (usize, &Axis)| {
            axis.travel.map(|_| machine.letter_steps(number, &motors))
        };
        machine.axes.iter().enumerate().map(place).collect()
    }
}

/// What the user wants of a move in a pause, which has this state now.
fn wish(control: &mut Control, ways: &mut Ways, status: &Status) -> Wish {
    ways.see(status);
    let ends = control.program().is_some_and(|program| program.ends());
    if ends { Wish::Stop } else { control.wish(status) }
}

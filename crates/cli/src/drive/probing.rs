//! A probe move of a board that executes no program: the touch, what is set there, and the way
//! back.

use super::itinerary::Itinerary as _;
use super::moves::Moves;
use super::outcome::{Culprit, How, tell_fault};
use super::place::{Place, named_point, point_at};
use super::touch::{Touched, Watch, go, is_closed, touch};
use crate::belt_ways::EITHER;
use crate::connection::{self, ConnectedBoard, ConnectedBoardError, Connection};
use crate::control::StoppedBy;
use crate::failure::Failure;
use crate::found;
use crate::jog;
use crate::limits::ClosedLimits;
use crate::memory::{self, BoardMemory};
use crate::pause::Coordinates;
use crate::probe::ProbeWish;
use crate::work::{self, NamedOffset};
use carrystep_core::engine::Cause;
use carrystep_files::Machine;
use carrystep_link::{Ended, HostError};
use carrystep_program::{Letters, Point};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// The outcome of a probe move; `--json` prints it as it is.
#[derive(Debug, JsonSchema, Serialize)]
pub struct Probed {
    /// The probe has ended the move, and all that was wanted was done.
    pub passed: bool,
    /// The port.
    pub port: String,
    /// The gateware's build id.
    pub build: String,
    /// How it ended.
    pub ended: How,
    /// The source of the stop, if it was requested.
    pub stopped_by: Option<StoppedBy>,
    /// Why the machine stopped by itself, if it did.
    pub cause: Option<&'static str>,
    /// The axes that caused this stop.
    pub culprits: Vec<Culprit>,
    /// What the user must do about it.
    pub remedy: Option<&'static str>,
    /// Machine place at which the probe has ended the move, by letters, x, y, z in mm and a, b, c
    /// in degrees: that of the tick in which the gateware accepted its level. Null if it has not.
    pub touched: Option<BTreeMap<char, f64>>,
    /// Machine place at the end.
    pub place: BTreeMap<char, f64>,
    /// The work offsets that are not zero.
    pub offsets: Vec<NamedOffset>,
}

/// A probe move of a machine that is connected.
pub struct ProbeMove<'a> {
    /// The machine.
    pub machine: &'a Machine,
    /// The letters of its axes.
    pub letters: &'a Letters,
    /// What is wanted.
    pub wish: &'a ProbeWish,
    /// Whether the present place is zero, and no travel bounds the move.
    pub unhomed: bool,
}

/// Moves an axis until the probe ends the move, sets what is wanted there, and goes back.
///
/// # Errors
/// The machine is not homed, the move leads beyond its travel or into a limit, the probe has the
/// wanted state already or does not get it, or the line to the board is lost.
pub fn probe(
    mut connection: Connection,
    mut memory: BoardMemory,
    wanted: &ProbeMove<'_>,
) -> Result<Probed, Failure> {
    let ProbeMove { machine, letters, wish, unhomed } = *wanted;
    let number = wish.axis(machine)?;
    let file = wish.way().file(machine)?;
    let positions = connection.board.status().positions;
    let place = Place::find(machine, letters, &memory, &positions, unhomed)?;
    jog::within_travel(&file, &place.bounded_steps(machine, &positions))?;
    let planned = Moves::unwatched(file.into())?;
    {
        // Before the session is opened: a refusal leaves the board and its memory as they are.
        let Connection { board, axes, .. } = &mut connection;
        let told = |error: ConnectedBoardError| connection::broken(&error, axes);
        let closed = ClosedLimits::read(board).map_err(told)?;
        closed.check(machine.guard.limits, planned.plan().first, &memory.limits(), axes)?;
        if is_closed(board).map_err(told)? != wish.away {
            return Err(Failure::input(wish.already()));
        }
    }
    connection::open(&mut connection)?;
    // `control` is bound before `board` so that it is dropped later: the port is closed before the
    // claim on it ends.
    let Connection { mut control, port, mut board, axes, .. } = connection;
    let facts = *board.facts();
    let mut session = Session {
        board: &mut board,
        memory: &mut memory,
        wanted,
        zero: &place.zero,
        number,
        touched: None,
        way: wish.distance.signum() as i8,
    };
    let outcome = session.execute(&planned, &mut |status| control.wish(status));
    let (touched, way) = (session.touched, session.way);
    let answer = board.status().answer;
    let ended = match outcome {
        Ok(()) => How::Done,
        Err(Halt::Stopped) => How::Stopped,
        Err(Halt::Board(HostError::Fault { .. })) => How::Fault,
        Err(Halt::Board(error)) => return Err(connection::lost(&error, &axes, &facts)),
        Err(Halt::Failed(failure)) => {
            // If the file cannot be written, the old one no longer matches the board and is
            // ignored.
            let _ = memory.keep(&mut board);
            return Err(failure);
        }
    };
    let cause = found::cause(&answer).filter(|_| ended == How::Fault);
    let culprits =
        (0..axes.len()).filter(|axis| cause.is_some() && answer.culprits >> axis & 1 == 1);
    let culprits: Vec<usize> = culprits.collect();
    if ended == How::Fault && memory::freezes(answer.cause, machine.guard.limit_freezes) {
        memory.forget_places();
    }
    if cause == Some(Cause::Limit) {
        for &motor in &culprits {
            // On crossed belts, the other letter rests.
            let axes = machine.belts().filter(|belts| belts.contains(&motor));
            for axis in axes.map_or_else(|| vec![motor], Vec::from) {
                let rests = machine.is_crossed(axis) && axis != number;
                memory.set_limit(axis, Some(if rests { EITHER } else { way }));
            }
        }
    }
    let kept = memory.keep(&mut board);
    if let (Err(error), Some(_), Some(_)) = (&kept, &touched, wish.target) {
        return Err(memory::not_kept(error));
    }
    let positions = board.status().positions.map(f64::from);
    let moves = |motor| machine.coefficient(motor, number) * way;
    Ok(Probed {
        passed: ended == How::Done,
        port,
        build: format!("{:016x}", facts.build),
        ended,
        stopped_by: control.stopped_by().filter(|_| ended == How::Stopped),
        cause: answer.cause_name().filter(|_| ended == How::Fault),
        culprits: culprits
            .into_iter()
            .map(|axis| Culprit { axis: axes[axis].clone(), direction: moves(axis) })
            .collect(),
        remedy: cause.map(Cause::remedy),
        touched: touched.map(|at| named_point(letters, &at)),
        place: named_point(letters, &point_at(letters, &place.zero, &positions)),
        offsets: memory.work().map(work::named).unwrap_or_default(),
    })
}

/// Why a probe move is not done.
enum Halt {
    /// It was stopped on request.
    Stopped,
    /// The probe was missed, or something cannot be done.
    Failed(Failure),
    /// The board has stopped, or is lost.
    Board(ConnectedBoardError),
}

impl From<ConnectedBoardError> for Halt {
    fn from(error: ConnectedBoardError) -> Self {
        Self::Board(error)
    }
}

impl From<Failure> for Halt {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

/// A board during a probe move.
struct Session<'a> {
    board: &'a mut ConnectedBoard,
    memory: &'a mut BoardMemory,
    wanted: &'a ProbeMove<'a>,
    /// Of each axis, the machine place of its register's zero in steps.
    zero: &'a [i64],
    /// The axis.
    number: usize,
    /// Where the probe has ended the move.
    touched: Option<Point>,
    /// The direction of the present move: 1 or -1.
    way: i8,
}

impl Session<'_> {
    fn execute(&mut self, planned: &Moves, watch: &mut Watch<'_>) -> Result<(), Halt> {
        let ProbeMove { machine, letters, wish, .. } = *self.wanted;
        let number = self.number;
        if self.board.enable_while(|progress| watch(progress.status))? == Ended::Stopped {
            return Err(Halt::Stopped);
        }
        // Otherwise, a command that is killed leaves a file that does not match.
        let drives = self.memory.drives(self.board);
        if wish.target.is_some() {
            drives.map_err(|error| memory::not_kept(&error))?;
        }
        // The drivers may have taken seconds to get their power.
        if is_closed(self.board)? != wish.away {
            return Err(Failure::input(wish.already()).into());
        }
        let place = |motors: &[f64]| machine.letter_steps(number, motors);
        let began = place(&self.board.status().positions.map(f64::from));
        let steps = match touch(self.board, machine, (planned, !wish.away), watch)? {
            Touched::At(steps) => steps,
            Touched::Missed => return Err(Failure::Run(wish.missed()).into()),
            Touched::Stopped => return Err(Halt::Stopped),
        };
        let at = point_at(letters, self.zero, &steps);
        self.touched = Some(at);
        let before = self.memory.work().cloned().unwrap_or_default();
        if let Some(offsets) = wish.offsets(&before, (machine, letters), at)? {
            self.memory.set_work(offsets);
            self.memory.drives(self.board).map_err(|error| memory::not_kept(&error))?;
        }
        let rests = place(&self.board.status().positions.map(f64::from));
        let from = [place(&steps), began, rests];
        let Some(back) = wish.back(&machine.axes[number], from) else { return Ok(()) };
        let back = Moves::unwatched(back.file(machine)?.into())?;
        self.way = -self.way;
        let way = back.itinerary();
        way.begin();
        match go(self.board, way.source(), watch)? {
            Ended::Stopped => Err(Halt::Stopped),
            Ended::Done | Ended::SeekEnded => Ok(()),
        }
    }
}

impl fmt::Display for Probed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: build {}", self.port, self.build)?;
        match &self.touched {
            Some(touched) => {
                writeln!(f, "the probe has ended the move at machine{}", Coordinates(touched))?;
            }
            None => writeln!(f, "the probe has not ended the move, and nothing was set")?,
        }
        writeln!(f, "machine place:{}", Coordinates(&self.place))?;
        self.offsets.iter().try_for_each(|offset| writeln!(f, "{offset}"))?;
        match self.ended {
            How::Done => f.write_str("DONE\n"),
            How::Stopped => {
                let by = self.stopped_by.unwrap_or(StoppedBy::Interrupt);
                let when =
                    if self.touched.is_some() { "behind the touch" } else { "before the touch" };
                writeln!(f, "STOPPED by {by} {when}; the positions are valid")
            }
            How::Fault => tell_fault(f, (self.cause, &self.culprits), "", self.remedy),
        }
    }
}

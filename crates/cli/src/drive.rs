//! Drives a board through a plan: it streams the segments, keeps the queues full, watches the
//! board, stops on request and reports the outcome. All checks that refuse a run come before the
//! first segment is sent.

use crate::connection::{self, Connection};
use crate::failure::Failure;
use crate::found;
use crate::job;
use crate::limits::ClosedLimits;
use crate::memory::{self, BoardMemory};
use carrystep_core::engine::Cause;
use carrystep_files::MoveSource;
use carrystep_link::supply::Supply;
use carrystep_link::{Command, Ended, HostError, Status};
use carrystep_plan::{AxisTotals, Survey};
use line::Line;
pub use outcome::{AxisDriven, Culprit, Driven, How};
use program::PlannedProgram;
use std::time::Instant;

mod line;
mod outcome;
mod program;

/// A plan that the link can send.
pub struct Streamed {
    survey: Survey,
    seconds: f64,
    /// Direction of the first motion of each axis: 1, -1, or 0 if it does not move.
    first: Vec<i8>,
}

impl Streamed {
    /// Plans all moves.
    ///
    /// # Errors
    /// A move cannot be made, or the machine's line is too slow to keep the queues full.
    pub fn new(source: MoveSource) -> Result<Self, Failure> {
        let (machine, path) = (&source.machine, source.path.display().to_string());
        let axes = machine.axes.len() as u8;
        let mut supply =
            Some(Supply::new(axes, machine.timebase.tick_ns(), machine.queue, machine.baud));
        // A move that cannot be made is told before a line that is too slow.
        let mut starved = None;
        let survey = job::survey(source, |planned| {
            for command in planned.commands().iter().filter_map(Command::of) {
                if let Some(Err(error)) = supply.as_mut().map(|supply| supply.add(&command)) {
                    starved = Some(error);
                    supply = None;
                }
            }
            Ok(())
        })?;
        let starved = starved.or_else(|| supply.and_then(|supply| supply.finish().err()));
        if let Some(error) = starved {
            return Err(Failure::input(format!("{path}: {error}")));
        }
        let first = |totals: &AxisTotals| {
            totals.travel.first.as_ref().map_or(0, |leg| leg.forward().signum() as i8)
        };
        let first = survey.totals().axes.iter().map(first).collect();
        let seconds = survey.totals().ticks as f64 * survey.build().timebase.tick_seconds();
        Ok(Self { survey, seconds, first })
    }
}

/// The direction in which each axis was last seen moving.
#[derive(Default)]
struct Ways {
    positions: Option<[i32; 8]>,
    last: [i8; 8],
}

impl Ways {
    fn see(&mut self, status: &Status) {
        let before = self.positions.replace(status.positions).unwrap_or(status.positions);
        for (last, (before, now)) in self.last.iter_mut().zip(before.iter().zip(status.positions)) {
            match now.wrapping_sub(*before).signum() {
                0 => {}
                way => *last = way as i8,
            }
        }
    }
}

/// Executes the moves and returns the report. An axis moves further toward a limit that it has met
/// only if `into_limit` is set.
///
/// # Errors
/// The board has stopped already, a limit forbids the motion, or the line to the board is
/// lost.
pub fn drive(
    mut connection: Connection,
    streamed: &Streamed,
    into_limit: bool,
) -> Result<Driven, Failure> {
    let mut memory = BoardMemory::recall(&mut connection);
    if !into_limit {
        // Before the session is opened: a refusal leaves the board and its memory as they are.
        let Connection { board, axes, .. } = &mut connection;
        let closed = ClosedLimits::read(board).map_err(|error| connection::broken(&error, axes))?;
        let wiring = streamed.survey.machine().guard.limits;
        closed.check(wiring, &streamed.first, &memory.limits(), axes)?;
    }
    connection::open(&mut connection)?;
    // `control` is bound before `board` so that it is dropped later: the port is closed before the
    // claim on it ends.
    let Connection { mut control, port, mut board, axes, .. } = connection;
    let begun = Instant::now();
    let facts = *board.facts();
    let told = |error| connection::broken(&error, &axes);
    let start = *board.status();
    let program = PlannedProgram::new(&streamed.survey);
    let line = Line::new(&axes, streamed.seconds);
    let mut ways = Ways::default();
    let powered = board.enable_while(|progress| control.wish(progress.status)).map_err(told)?;
    let mut watch = |progress: &carrystep_link::Progress<'_>| {
        line.show(progress.status);
        ways.see(progress.status);
        control.wish(progress.status)
    };
    let outcome = match powered {
        Ended::Stopped => Ok(Ended::Stopped),
        Ended::Done | Ended::SeekEnded => board.stream(program, &mut watch),
    };
    drop(line);
    let ended = match outcome {
        // The command seeks nothing here; whether all moves were made is judged by the positions.
        Ok(Ended::Done | Ended::SeekEnded) => How::Done,
        Ok(Ended::Stopped) => How::Stopped,
        Err(HostError::Fault { .. }) => How::Fault,
        Err(error) => return Err(connection::lost(&error, &axes, &facts)),
    };
    let end = *board.status();
    ways.see(&end);
    let cause = found::cause(&end.answer).filter(|_| ended == How::Fault);
    if ended == How::Stopped {
        // The stop was requested, so it is cleared here and the next run does not report it.
        board.clear().map_err(told)?;
    }
    if ended == How::Fault && memory::freezes(end.answer.cause, &streamed.survey.machine().guard) {
        memory.forget_places();
    }
    if cause == Some(Cause::Limit) {
        let met = |(number, _): &(usize, &i8)| end.answer.culprits >> number & 1 == 1;
        for (number, &first) in streamed.first.iter().enumerate().filter(met) {
            let direction = if ways.last[number] == 0 { first } else { ways.last[number] };
            memory.set_limit(number, Some(direction));
        }
    }
    // If the file cannot be written, the old one no longer matches the board and is ignored.
    let _ = memory.keep(&mut board);
    let culprit = |(number, axis): (usize, &String)| Culprit {
        axis: axis.clone(),
        direction: ways.last[number],
    };
    let is_culprit =
        |(number, _): &(usize, &String)| cause.is_some() && end.answer.culprits >> number & 1 == 1;
    let culprits = axes.iter().enumerate().filter(is_culprit).map(culprit).collect();
    streamed.survey.whole()?;
    let (machine, totals) = (streamed.survey.machine(), streamed.survey.totals());
    let axis = |(number, name): (usize, String)| AxisDriven {
        axis: name,
        before: start.positions[number],
        position: end.positions[number],
        steps_planned: totals.axes[number].travel.position,
        unit: machine.axes[number].unit.name.clone(),
        steps_per_unit: machine.axes[number].unit.steps,
    };
    let axes: Vec<AxisDriven> = axes.iter().cloned().enumerate().map(axis).collect();
    let moved = |axis: &AxisDriven| {
        i64::from(axis.position.wrapping_sub(axis.before)) == axis.steps_planned
    };
    Ok(Driven {
        passed: ended == How::Done && axes.iter().all(moved),
        port,
        build: format!("{:016x}", facts.build),
        ended,
        stopped_by: control.stopped_by().filter(|_| ended == How::Stopped),
        cause: end.answer.cause_name().filter(|_| ended == How::Fault),
        culprits,
        meaning: cause.map(Cause::meaning),
        remedy: cause.map(Cause::remedy),
        planned_s: streamed.seconds,
        run_s: begun.elapsed().as_secs_f64(),
        axes,
    })
}

//! Drives a board through a plan: it streams the segments, keeps the queues full, watches the
//! board, stops on request and reports the outcome. All checks that refuse a run come before the
//! first segment is sent.

use crate::belt_ways::EITHER;
use crate::connection::{self, Connection};
use crate::failure::Failure;
use crate::found;
use crate::limits::ClosedLimits;
use crate::memory::{self, BoardMemory};
use crate::work;
use carrystep_core::engine::Cause;
use carrystep_link::{Ended, HostError, Status};
use carrystep_program::ProgramFile;
use course::Course;
pub use itinerary::{Itinerary, Plan};
use line::Line;
pub use moves::{Moves, OffsetAtEnd};
pub use outcome::{AxisDriven, Culprit, Driven, How, tell_fault};
pub use place::{Place, point_at};
pub use probing::{ProbeMove, Probed, probe};
pub use program::PlannedProgram;
pub use settle::{exact_position, settle};
use std::time::Instant;
pub use touch::{all_axes, is_closed};
use wait::Keys;
use ways::Ways;

mod course;
mod itinerary;
mod line;
mod moves;
mod outcome;
mod pause;
mod place;
mod probing;
mod program;
mod reading;
mod settle;
mod touch;
mod wait;
mod ways;

/// Executes a plan and returns the report. An axis moves further toward a limit that it has met
/// only if `into_limit` is set.
///
/// # Errors
/// The board has stopped already, a limit forbids the motion, or the line to the board is
/// lost.
pub fn drive(
    mut connection: Connection,
    mut memory: BoardMemory,
    mut plan: Plan<'_>,
    itinerary: &dyn Itinerary,
    into_limit: bool,
) -> Result<Driven, Failure> {
    if !into_limit {
        // Before the session is opened: a refusal leaves the board and its memory as they are.
        let Connection { board, axes, .. } = &mut connection;
        let closed = ClosedLimits::read(board).map_err(|error| connection::broken(&error, axes))?;
        let wiring = plan.machine.guard.limits;
        closed.check(wiring, plan.first, &memory.limits(), axes)?;
    }
    connection::open(&mut connection)?;
    // `control` is bound before `board` so that it is dropped later: the port is closed before the
    // claim on it ends.
    let Connection { mut control, port, mut board, axes, .. } = connection;
    let begun = Instant::now();
    let facts = *board.facts();
    let told = |error| connection::broken(&error, &axes);
    let start = *board.status();
    let (mut ways, seconds) = (Ways::new(plan.machine), plan.seconds);
    let powered = board.enable_while(|progress| control.wish(progress.status)).map_err(told)?;
    let drives = memory.drives(&mut board);
    if let (Err(error), true, None) = (&drives, itinerary.keeps(), itinerary.program()) {
        return Err(memory::not_kept(error));
    }
    // Otherwise, a command that is killed leaves a file that does not match.
    if plan.program.is_some() {
        control.runs_program(plan.machine.output_uses.spindle_rpm.is_some());
    }
    // The command seeks nothing here; whether all moves were made is judged by the positions.
    let (outcome, failed) = if powered == Ended::Stopped {
        (Ok(powered), None)
    } else {
        let course = Course {
            zero: zero(itinerary, &start),
            board: &mut board,
            control: &mut control,
            memory: &mut memory,
            plan: &mut plan,
            line: Line::new(&axes, seconds),
            keys: Keys::listening(),
            ways: &mut ways,
            axes: &axes,
            itinerary,
            start,
            has_moved: false,
            ends: false,
            probe: None,
            failed: None,
        };
        course.follow()
    };
    let ended = match outcome {
        Ok(Ended::Done | Ended::SeekEnded) => How::Done,
        Ok(Ended::Stopped) => How::Stopped,
        Err(HostError::Fault { .. }) => How::Fault,
        Err(error) => return Err(connection::lost(&error, &axes, &facts)),
    };
    let end = *board.status();
    ways.see(&end);
    let mut set = None;
    if ended == How::Done && itinerary.keeps() {
        let offsets = itinerary.offsets(&end);
        // What a program sets is a part of the program; behind a jog it is what was wanted.
        set = offsets.as_ref().filter(|_| itinerary.program().is_none()).map(work::named);
        offsets.into_iter().for_each(|offsets| memory.set_work(offsets));
    }
    let cause = found::cause(&end.answer).filter(|_| ended == How::Fault);
    if ended == How::Stopped {
        // The stop was requested, so it is cleared here and the next run does not report it.
        board.clear().map_err(told)?;
    }
    if ended == How::Fault && memory::freezes(end.answer.cause, plan.machine.guard.limit_freezes) {
        memory.forget_places();
    }
    if cause == Some(Cause::Limit) {
        let met = |(number, _): &(usize, &i8)| end.answer.culprits >> number & 1 == 1;
        let crossed = |number: usize| plan.machine.is_crossed(number);
        let own = plan.first.iter().enumerate().filter(met);
        for (number, &first) in own.filter(|(number, _)| !crossed(*number)) {
            let direction = if ways.last[number] == 0 { first } else { ways.last[number] };
            memory.set_limit(number, Some(direction));
        }
        for (axis, way) in ways.belts.met(end.answer.culprits) {
            memory.set_limit(axis, Some(way));
        }
    }
    // If the file cannot be written, the old one no longer matches the board and is ignored.
    let kept = memory.keep(&mut board);
    if let (Err(error), Some(_)) = (&kept, &set) {
        return Err(memory::not_kept(error));
    }
    let culprit = |(number, axis): (usize, &String)| Culprit {
        axis: axis.clone(),
        direction: ways.last[number],
    };
    let is_culprit =
        |(number, _): &(usize, &String)| cause.is_some() && end.answer.culprits >> number & 1 == 1;
    // Both motors of crossed belts meet the limit of a letter.
    let letters = match cause {
        Some(Cause::Limit) => ways.belts.met(end.answer.culprits),
        _ => Vec::new(),
    };
    let is_letter = |number: usize| letters.iter().any(|(axis, _)| *axis == number);
    let motors = axes.iter().enumerate().filter(is_culprit);
    let motors = motors.filter(|(number, _)| !is_letter(*number)).map(culprit);
    let moved = letters.iter().filter(|(_, way)| *way != EITHER);
    let moved = moved.map(|&(axis, direction)| Culprit { axis: axes[axis].clone(), direction });
    let culprits = motors.chain(moved).collect();
    itinerary.whole()?;
    if let (Some(driven), Some(program)) = (&mut plan.program, control.program()) {
        driven.overrides = program.overrides().into();
    }
    if ended != How::Done
        && let Some(program) = &mut plan.program
    {
        program.block = control.program().and_then(|program| program.block);
    }
    failed.map_or(Ok(()), Err)?;
    let axis = |(number, name): (usize, String)| AxisDriven {
        axis: name,
        before: start.positions[number],
        position: end.positions[number],
        steps_planned: plan.steps[number],
        unit: plan.machine.axes[number].unit.name.clone(),
        steps_per_unit: plan.machine.axes[number].unit.steps,
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
        planned_s: plan.seconds,
        run_s: begun.elapsed().as_secs_f64(),
        program: plan.program,
        offsets: set,
        axes,
    })
}

/// Where the positions of the registers are zero, steps from machine zero.
fn zero(itinerary: &dyn Itinerary, start: &Status) -> Vec<i64> {
    let places = itinerary.program().map(ProgramFile::start_steps).unwrap_or_default();
    places.iter().zip(start.positions).map(|(at, position)| at - i64::from(position)).collect()
}

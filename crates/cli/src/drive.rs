//! Drives a board through a plan: it streams the segments, keeps the queues full, watches the
//! board, stops on request and reports the outcome. All checks that refuse a run come before the
//! first segment is sent.

use crate::connection::{self, ConnectedBoard, ConnectedBoardError, Connection};
use crate::control::Control;
use crate::failure::Failure;
use crate::found;
use crate::limits::ClosedLimits;
use crate::memory::{self, BoardMemory};
use carrystep_core::engine::Cause;
use carrystep_link::{Ended, HostError, Status, Wish};
use carrystep_program::{Found, Input, Point, ProgramFile, Reading};
use itinerary::Rest;
pub use itinerary::{Itinerary, Plan};
use line::Line;
pub use moves::Moves;
pub use outcome::{AxisDriven, Culprit, Driven, How};
use pause::Pause;
pub use place::Place;
pub use program::PlannedProgram;
use reading::{InputRead, Probing, read_input};
use std::time::{Duration, Instant};
use wait::{Keys, Waited};

mod itinerary;
mod line;
mod moves;
mod outcome;
mod pause;
mod place;
mod program;
mod reading;
mod wait;

/// Time between two searches for a hold that the limits forbid now.
const TRY_AGAIN: Duration = Duration::from_millis(20);

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
    let (mut line, mut keys) = (Line::new(&axes, plan.seconds), Keys::listening());
    let mut ways = Ways::default();
    let powered = board.enable_while(|progress| control.wish(progress.status)).map_err(told)?;
    // If the file cannot be written, a command that is killed leaves one that does not match.
    let _ = memory.drives(&mut board);
    if plan.program.is_some() {
        control.runs_program(plan.machine.output_uses.spindle_rpm.is_some());
    }
    // The block in which the tool is, as long as nothing has stopped it.
    let block = |status: &Status| {
        let moved: Vec<i32> = (start.positions.iter().zip(&status.positions))
            .map(|(before, now)| now.wrapping_sub(*before))
            .collect();
        Some(&moved).filter(|_| !status.answer.fault).and_then(|moved| itinerary.block(moved))
    };
    // Where the positions of the registers are zero, steps from machine zero.
    let places = itinerary.program().map(ProgramFile::start_steps).unwrap_or_default();
    let zero: Vec<i64> =
        places.iter().zip(start.positions).map(|(at, position)| at - i64::from(position)).collect();
    let mut changed = Ok(());
    let mut follow = || -> Result<Ended, ConnectedBoardError> {
        let mut ends = false;
        // Whether a stretch was executed, and the probe move in which the machine is.
        let (mut is_moved, mut probe) = (false, None);
        'stretches: while let Some(waits) = itinerary.begin() {
            for at in waits {
                line.rests();
                let stop = itinerary.waits(at).unwrap_or_else(|failure| {
                    changed = Err(failure);
                    None
                });
                let found = match stop.as_ref().and_then(|stop| Some((stop, stop.reading?))) {
                    Some((stop, (Reading::Probe { .. }, _))) => {
                        probe = Probing::of(stop);
                        if let Some(Err(why)) =
                            probe.map(|probe: Probing| probe.check(&mut board)).transpose()?
                        {
                            changed = Err(refused(is_moved, why));
                            (ends, probe) = (true, None);
                            itinerary.end();
                            continue 'stretches;
                        }
                        continue;
                    }
                    Some((stop, (reading @ Reading::Input { input, until, seconds }, _))) => {
                        // Others are refused before anything is sent.
                        let Input::Digital(input) = input else { continue };
                        let wanted = (input, until, seconds);
                        match read_input(&mut board, &mut control, &at.to_string(), wanted)? {
                            InputRead::Value(Some(value)) if value == reading.assumed() => continue,
                            InputRead::Value(value) => Some((stop.at, Found::Input(value))),
                            InputRead::Ends => {
                                itinerary.end();
                                ends = true;
                                continue 'stretches;
                            }
                        }
                    }
                    None => None,
                };
                if let Some((at, found)) = found {
                    match again(itinerary, &mut board, &mut control, at, found) {
                        Ok(rest) => plan.goes_on(rest, &mut line, &start, &board),
                        Err(failure) => {
                            changed = Err(failure);
                            ends = true;
                            itinerary.end();
                        }
                    }
                    continue 'stretches;
                }
                let offsets = stop.map(|stop| stop.offsets);
                plan.program.iter_mut().for_each(|program| program.waits += 1);
                if let Some(offsets) = offsets.clone().filter(|_| itinerary.keeps()) {
                    memory.set_work(offsets);
                    // At the end the file is written again.
                    let _ = memory.drives(&mut board);
                }
                let mut pause = Pause::new(itinerary, &mut memory, (&axes, &zero), offsets);
                let keys = (&mut keys, &line);
                match wait::wait(&mut board, &mut control, keys, (at, &mut pause))? {
                    Waited::GoesOn(None) => {}
                    Waited::GoesOn(Some(rest)) => {
                        plan.goes_on(rest, &mut line, &start, &board);
                        continue 'stretches;
                    }
                    Waited::Ends => {
                        // The outputs go off in a stretch of their own.
                        itinerary.end();
                        ends = true;
                        continue 'stretches;
                    }
                }
            }
            // A probe moves at the feed of the program.
            let scales = !ends && probe.is_none();
            let wanted = control.program().map(|program| program.overrides());
            if let Some(wanted) = wanted.filter(|wanted| scales && *wanted != itinerary.overrides())
            {
                itinerary.set_overrides(wanted, None);
            }
            if let Some(probe) = &probe {
                probe.arm(&mut board)?;
            }
            let mut source = itinerary.source();
            let (mut next_try, mut next_change) = (Instant::now(), Instant::now());
            let mut cuts = 0;
            let streamed = board.stream(&mut *source, |progress| {
                line.show(progress.status, itinerary);
                ways.see(progress.status);
                cuts = progress.queues.map_or(0, |queues| queues.cuts);
                control.reached(block(progress.status));
                match control.wish(progress.status) {
                    // The axes rest while the outputs go off.
                    Wish::Stop if !ends => return Wish::Stop,
                    _ => {}
                }
                let wanted = control.program().map(|program| program.overrides());
                let wanted = wanted.filter(|wanted| scales && *wanted != itinerary.overrides());
                if let Some(wanted) = wanted.filter(|_| Instant::now() >= next_change) {
                    next_change = Instant::now() + TRY_AGAIN;
                    if let Some(keep) = itinerary.set_overrides(wanted, progress.queues) {
                        return Wish::Cut { keep };
                    }
                }
                let holds = control.program().is_some_and(|program| program.holds());
                if ends || !holds || itinerary.is_held() || Instant::now() < next_try {
                    return Wish::GoOn;
                }
                // A later row may begin a hold where the limits forbid one now.
                next_try = Instant::now() + TRY_AGAIN;
                itinerary.hold(progress.queues).map_or(Wish::GoOn, |keep| Wish::Cut { keep })
            })?;
            drop(source);
            plan.program.iter_mut().for_each(|program| program.cuts += cuts);
            if streamed == Ended::Stopped {
                return Ok(Ended::Stopped);
            }
            is_moved = true;
            if let Some((probing, file)) = probe.zip(itinerary.program()) {
                let hit = board.end_seek()?;
                if hit.is_none() && itinerary.is_held() {
                    // The rest of the move follows behind the hold.
                    continue;
                }
                probe = None;
                line.rests();
                let probed = match hit {
                    Some(states) => {
                        Ok(probing.tripped(&mut board, &line, (file, &zero), &states)?)
                    }
                    None => probing.untripped(),
                };
                let rest = probed
                    .map_err(Failure::Run)
                    .and_then(|(at, found)| again(itinerary, &mut board, &mut control, at, found));
                match rest {
                    Ok(rest) => plan.goes_on(rest, &mut line, &start, &board),
                    Err(failure) => {
                        changed = Err(failure);
                        ends = true;
                        itinerary.end();
                    }
                }
                continue;
            }
            if !ends {
                control.reached(block(board.status()));
            }
        }
        if ends {
            // The axes rest anywhere between two steps. A clear takes their places as they are.
            board.stop()?;
        }
        Ok(if ends { Ended::Stopped } else { Ended::Done })
    };
    // The command seeks nothing here; whether all moves were made is judged by the positions.
    let outcome = if powered == Ended::Stopped { Ok(powered) } else { follow() };
    drop(line);
    let ended = match outcome {
        Ok(Ended::Done | Ended::SeekEnded) => How::Done,
        Ok(Ended::Stopped) => How::Stopped,
        Err(HostError::Fault { .. }) => How::Fault,
        Err(error) => return Err(connection::lost(&error, &axes, &facts)),
    };
    let end = *board.status();
    ways.see(&end);
    if ended == How::Done && itinerary.keeps() {
        itinerary.offsets().into_iter().for_each(|offsets| memory.set_work(offsets));
    }
    let cause = found::cause(&end.answer).filter(|_| ended == How::Fault);
    if ended == How::Stopped {
        // The stop was requested, so it is cleared here and the next run does not report it.
        board.clear().map_err(told)?;
    }
    if ended == How::Fault && memory::freezes(end.answer.cause, &plan.machine.guard) {
        memory.forget_places();
    }
    if cause == Some(Cause::Limit) {
        let met = |(number, _): &(usize, &i8)| end.answer.culprits >> number & 1 == 1;
        for (number, &first) in plan.first.iter().enumerate().filter(met) {
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
    itinerary.whole()?;
    if let (Some(driven), Some(program)) = (&mut plan.program, control.program()) {
        driven.overrides = program.overrides().into();
    }
    if ended != How::Done
        && let Some(program) = &mut plan.program
    {
        program.block = control.program().and_then(|program| program.block);
    }
    changed?;
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
        axes,
    })
}

/// What cannot be executed any more: a mistake of the input if nothing has moved.
fn refused(is_moved: bool, why: String) -> Failure {
    if is_moved { Failure::Run(why) } else { Failure::input(why) }
}

/// Plans the rest of a program from what was found.
///
/// # Errors
/// It cannot be executed from there.
fn again(
    itinerary: &dyn Itinerary,
    board: &mut ConnectedBoard,
    control: &mut Control,
    at: Point,
    found: Found,
) -> Result<Rest, Failure> {
    let status = *board.status();
    let mut wish = || {
        let ends = control.program().is_some_and(|program| program.ends());
        if ends { Wish::Stop } else { control.wish(&status) }
    };
    itinerary
        .resume(at, None, found, &mut wish)
        .map_err(|failure| Failure::Run(format!("the machine rests: {}", failure.message())))
}

impl Plan<'_> {
    /// The rest was planned again, from where the board is.
    fn goes_on(&mut self, rest: Rest, line: &mut Line<'_>, start: &Status, board: &ConnectedBoard) {
        let gone = board.status().positions.into_iter().zip(start.positions);
        let gone = gone.map(|(now, from)| i64::from(now.wrapping_sub(from)));
        self.steps = gone.zip(rest.steps).map(|(gone, left)| gone + left).collect();
        self.seconds = line.plans(rest.seconds);
    }
}

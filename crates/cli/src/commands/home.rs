//! `carrystep home`: the axes of a machine find their limit switches, and the command stores where
//! machine zero is.

use crate::arguments::HomeArguments;
use crate::connection::{self, Connection};
use crate::control::StoppedBy;
use crate::drive::{Culprit, How, tell_fault};
use crate::failure::Failure;
use crate::memory::{self, BoardMemory};
use crate::{found, homing, output};
use carrystep_core::engine::Cause;
use carrystep_files::Machine;
use carrystep_files::machine::End;
use carrystep_link::{Ended, Homed, Homing, HomingFault, HomingStage, HostError};
use indicatif::{ProgressBar, ProgressDrawTarget};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::time::Instant;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct HomeReport {
    passed: bool,
    port: String,
    build: String,
    ended: How,
    stopped_by: Option<StoppedBy>,
    cause: Option<&'static str>,
    culprits: Vec<Culprit>,
    remedy: Option<&'static str>,
    run_s: f64,
    axes: Vec<AxisReport>,
}

#[derive(JsonSchema, Serialize)]
struct AxisReport {
    axis: String,
    /// Position register before homing, in steps. `edge` is the position at which the slow approach
    /// found the limit; `position` is the register after homing. On crossed belts these are half the
    /// sum, for y half the difference, of both registers, rounded down.
    before: i32,
    edge: Option<i32>,
    position: i32,
    /// Machine coordinate in units of the axis; null if the axis is not homed.
    machine: Option<f64>,
    /// The unit of the axis.
    unit: String,
    homed: bool,
}

impl fmt::Display for HomeReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: build {}", self.port, self.build)?;
        writeln!(
            f,
            "{:<6}  {:>11}  {:>11}  {:>11}  {:>12}",
            "axis", "before", "switch at", "position", "machine"
        )?;
        for AxisReport { axis, before, edge, position, machine, unit, .. } in &self.axes {
            let edge = edge.map_or_else(|| "-".to_owned(), |edge| edge.to_string());
            let machine =
                machine.map_or_else(|| "-".to_owned(), |machine| format!("{machine:.4} {unit}"));
            writeln!(f, "{axis:<6}  {before:>11}  {edge:>11}  {position:>11}  {machine:>12}")?;
        }
        match self.ended {
            How::Done => f.write_str("HOMED\n"),
            How::Stopped => {
                let by = self.stopped_by.unwrap_or(StoppedBy::Interrupt);
                writeln!(f, "STOPPED by {by}; these axes are not homed")
            }
            How::Fault => {
                let then = "; these axes are not homed";
                tell_fault(f, (self.cause, &self.culprits), then, self.remedy)
            }
        }
    }
}

/// Homes the named axes, or all that have a home table.
pub fn run(arguments: &HomeArguments) -> Result<(), Failure> {
    let machine = Machine::load(&arguments.machine)?;
    let groups = homing::groups(&machine, &arguments.axes)?;
    let mut homing = homing::of(&machine, &groups);
    homing.check().map_err(|(axis, why)| {
        Failure::input(format!("axis {}: {why}", machine.axes[usize::from(axis)].name))
    })?;
    let mut connection =
        connection::to_machine(&arguments.port, &machine, &arguments.machine, "home")?;
    let mut memory = BoardMemory::recall(&mut connection);
    memory.usable()?;
    connection::open(&mut connection)?;
    homing.others = homing::others(&machine, homing.mask(), connection.board.status(), &memory);
    let report = drive(connection, &machine, &homing, &mut memory)?;
    if arguments.json {
        output::print_json(&report)?;
    } else {
        output::print(&report.to_string())?;
    }
    if report.passed { Ok(()) } else { Err(Failure::Check) }
}

fn drive(
    connection: Connection,
    machine: &Machine,
    homing: &Homing<'_>,
    memory: &mut BoardMemory,
) -> Result<HomeReport, Failure> {
    // `control` is bound before `board` so that it is dropped later: the port is closed before the
    // claim on it ends.
    let Connection { mut control, port, mut board, axes, .. } = connection;
    let begun = Instant::now();
    let facts = *board.facts();
    let start = *board.status();
    let line = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(10));
    let powered = board
        .enable_while(|progress| control.wish(progress.status))
        .map_err(|error| connection::broken(&error, &axes))?;
    let mut last = (0, HomingStage::MoveOff);
    let outcome = match powered {
        Ended::Stopped => Ok(Homed::Stopped),
        Ended::Done | Ended::SeekEnded => board.home(homing, |moving, stage, progress| {
            last = (moving, stage);
            line.set_message(format!("{} {stage}", found::names(&axes, moving)));
            line.tick();
            control.wish(progress.status)
        }),
    };
    line.finish_and_clear();
    // On crossed belts, places of letters are in half steps.
    let parts = |number: usize| if machine.is_crossed(number) { 2 } else { 1 };
    let place = |number: usize, positions: &[i32]| {
        let sum = |mask: u8| -> i64 {
            let motors = positions.iter().enumerate();
            motors.filter(|(motor, _)| mask >> motor & 1 == 1).map(|(_, &at)| i64::from(at)).sum()
        };
        let [forward, backward] = machine.homing_motors(number);
        (sum(forward) - sum(backward)).div_euclid(parts(number)) as i32
    };
    // From here until homing has succeeded, the axes to be homed have no machine coordinate.
    homing::forget(memory, machine, homing.mask());
    let mut edges = None;
    let ended = match outcome {
        Ok(Homed::At(places)) => {
            homing::note(memory, machine, homing.mask(), &places);
            edges = Some(places);
            How::Done
        }
        Ok(Homed::Stopped) => {
            board.clear().map_err(|error| connection::broken(&error, &axes))?;
            How::Stopped
        }
        Err(HostError::Fault { cause, .. }) => {
            if memory::freezes(cause, machine.guard.limit_freezes) {
                memory.forget_places();
            }
            How::Fault
        }
        Err(HostError::Homing { axes: mask, why }) => {
            for number in (0..axes.len())
                .filter(|number| why == HomingFault::Closed && mask >> number & 1 == 1)
            {
                memory.set_limit(number, closed(machine, number, last.1));
            }
            // If the file cannot be written, the old one no longer matches the board and is
            // ignored.
            let _ = memory.keep(&mut board);
            return Err(Failure::Run(homing::fault(machine, mask, why)));
        }
        Err(error) => return Err(connection::lost(&error, &axes, &facts)),
    };
    let answer = board.status().answer;
    let cause = found::cause(&answer).filter(|_| ended == How::Fault);
    let kept = memory.keep(&mut board);
    let end = *board.status();
    let is_culprit = |number: usize| cause.is_some() && answer.culprits >> number & 1 == 1;
    let culprits = (0..axes.len()).filter(|&number| is_culprit(number));
    let report = HomeReport {
        passed: ended == How::Done,
        port,
        build: format!("{:016x}", facts.build),
        ended,
        stopped_by: control.stopped_by().filter(|_| ended == How::Stopped),
        cause: answer.cause_name().filter(|_| ended == How::Fault),
        culprits: culprits
            .map(|number| Culprit { axis: axes[number].clone(), direction: 0 })
            .collect(),
        remedy: cause.map(Cause::remedy),
        run_s: begun.elapsed().as_secs_f64(),
        axes: (0..axes.len())
            .filter(|number| homing.mask() >> number & 1 == 1)
            .map(|number| AxisReport {
                axis: axes[number].clone(),
                before: place(number, &start.positions),
                edge: edges.map(|edges| edges[number].div_euclid(parts(number) as i32)),
                position: place(number, &end.positions),
                machine: memory.coordinate(number, &end.positions),
                unit: machine.axes[number].unit.name.clone(),
                homed: edges.is_some(),
            })
            .collect(),
    };
    match kept {
        Err(error) if ended == How::Done => Err(Failure::Run(format!(
            "the axes are homed, but where machine zero is cannot be remembered: {error}; CARRYSTEP_STATE names another folder"
        ))),
        _ => Ok(report),
    }
}

/// The direction in which an axis has met a limit while it moved away from its home switch.
fn closed(machine: &Machine, number: usize, stage: HomingStage) -> Option<i8> {
    let home = machine.axes[number].home.as_ref()?;
    let away = if home.toward == End::Max { -1 } else { 1 };
    (stage != HomingStage::PullOff).then_some(away)
}

//! A plan on a board: streamed with full queues, watched, stopped by Ctrl-C, and what came of it.

use crate::connection::{self, Connection};
use crate::failure::Failure;
use crate::interrupt;
use carrystep_link::{Command, Ended, HostError, Program, Status, Wish, supply};
use carrystep_plan::Plan;
use carrystep_spec::{MoveFile, Unit};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use std::fmt;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// How a drive ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum How {
    /// All moves were made.
    Done,
    /// Stopped as wished: by Ctrl-C.
    Stopped,
    /// The machine stopped by itself.
    Fault,
}

/// What came of it; `--json` prints it as it is.
#[derive(Debug, Serialize)]
pub struct Driven {
    /// All moves were made, and the machine is where they end.
    pub passed: bool,
    /// The port.
    pub port: String,
    /// The gateware's build id.
    pub build: String,
    /// How it ended.
    pub ended: How,
    /// Why the machine stopped, where it did.
    pub cause: Option<&'static str>,
    /// Seconds that the plan takes.
    pub planned_s: f64,
    /// Seconds that it took, power and questions included.
    pub run_s: f64,
    /// Each axis.
    pub axes: Vec<AxisDriven>,
}

/// One axis.
#[derive(Debug, Serialize)]
pub struct AxisDriven {
    /// Its name.
    pub axis: String,
    /// Position register before, steps.
    pub before: i32,
    /// And after.
    pub position: i32,
    /// Steps of the plan.
    pub steps_planned: i64,
    /// What the axis is measured in.
    pub unit: String,
    /// Steps in one of these, as the nearest float.
    pub steps_per_unit: f64,
    /// Position at the limit, where the axis was sent home.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub latched: Option<i32>,
}

impl fmt::Display for Driven {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: build {}", self.port, self.build)?;
        let head = ["before", "planned", "position", "distance", "at"].map(|head| format!("  {head:>11}")).concat();
        writeln!(f, "{:<6}{head}", "axis")?;
        for AxisDriven { axis, before, position, steps_planned, unit, steps_per_unit, latched } in &self.axes {
            let unit = Unit { name: unit.clone(), steps: *steps_per_unit };
            let limit = latched.map_or_else(String::new, |at| format!("  limit at {at}"));
            let [planned, at] = [*steps_planned as f64, f64::from(*position)].map(|steps| unit.own(steps, 0));
            writeln!(
                f,
                "{axis:<6}  {before:>11}  {steps_planned:>+11}  {position:>11}  {planned:>11}  {at:>11}{limit}"
            )?;
        }
        match (self.ended, self.passed) {
            (How::Done, true) => f.write_str("DONE\n"),
            (How::Done, false) => f.write_str("FAILED: the positions are not where the moves end\n"),
            (How::Stopped, _) => f.write_str("STOPPED as asked for; the positions are true\n"),
            (How::Fault, _) => writeln!(
                f,
                "STOPPED by the machine: {}; the positions are true, `carrystep stop --clear` resumes",
                self.cause.unwrap_or("?")
            ),
        }
    }
}

/// A plan as the link has it.
pub struct Streamed {
    commands: Vec<Command>,
    steps: Vec<i64>,
    units: Vec<Unit>,
    seconds: f64,
}

impl Streamed {
    /// The program of a plan, where this machine's line can carry it.
    pub fn new(file: &MoveFile, plan: &Plan, baud: u32) -> Result<Self, Failure> {
        let commands: Vec<Command> = plan.program().iter().filter_map(Command::of).collect();
        let axes = file.machine.axes.len();
        supply::check(&commands, axes as u8, plan.build.timebase.tick_ns(), baud)
            .map_err(|error| Failure::input(format!("{}: {error}", file.source.path.display())))?;
        let steps = (0..axes).map(|axis| plan.moves.iter().map(|planned| planned.axes[axis].steps).sum()).collect();
        let units = file.machine.axes.iter().map(|axis| axis.unit.clone()).collect();
        Ok(Self { commands, steps, units, seconds: plan.total_ticks() as f64 * plan.build.timebase.tick_seconds() })
    }

    /// Segments of the axis that has most, and which it is.
    pub fn most_segments(&self) -> (usize, usize) {
        let of = |axis: usize| {
            let own = |command: &&Command| matches!(command, Command::Segment { axis: other, .. } if usize::from(*other) == axis);
            self.commands.iter().filter(own).count()
        };
        (0..self.steps.len()).map(|axis| (of(axis), axis)).max().unwrap_or_default()
    }

    /// The axes that it moves, a bit each.
    pub fn moving(&self) -> u8 {
        (0..).zip(&self.steps).fold(0, |mask, (axis, &steps)| mask | u8::from(steps != 0) << axis)
    }
}

/// Makes the moves; with `homing`, until these axes have met their limits.
pub fn drive(connection: Connection, port: &str, streamed: &Streamed, homing: Option<u8>) -> Result<Driven, Failure> {
    let Connection { mut board, axes } = connection;
    let begun = Instant::now();
    let told = |error| connection::broken(&error, &axes);
    let start = *board.status();
    if start.answer.fault {
        return Err(told(HostError::Fault { cause: start.answer.cause, culprits: start.answer.culprits }));
    }
    let program = Program::new(&streamed.commands, axes.len() as u8).map_err(|error| told(error.into()))?;
    board.enable().map_err(told)?;
    let asked = interrupt::watch();
    let line = Line::new(&axes, streamed.seconds);
    let mut stopped = false;
    let mut watch = |progress: &carrystep_link::Progress<'_>| {
        line.show(progress.status);
        stopped = asked.load(Ordering::Relaxed);
        if stopped { Wish::Stop } else { Wish::GoOn }
    };
    let outcome = match homing {
        None => board.stream(program, &mut watch).map(|ended| (ended, None)),
        Some(mask) => board.home(mask, program, &mut watch).map(|latched| (Ended::Done, Some(latched))),
    };
    drop(line);
    let (ended, cause, latched) = match outcome {
        Ok((Ended::Done, latched)) => (How::Done, None, latched),
        Err(HostError::NoLimit { .. }) if stopped => (How::Stopped, None, None),
        Ok((Ended::Stopped, _)) => (How::Stopped, None, None),
        Err(HostError::Fault { .. }) => (How::Fault, board.status().answer.cause_name(), None),
        Err(error) => return Err(told(error)),
    };
    if ended == How::Stopped {
        // It was our own stop, and nothing else: the next run need not be told.
        board.clear().map_err(told)?;
    }
    let end = *board.status();
    let axis = |(number, name): (usize, String)| AxisDriven {
        axis: name,
        before: start.positions[number],
        position: end.positions[number],
        steps_planned: streamed.steps[number],
        unit: streamed.units[number].name.clone(),
        steps_per_unit: streamed.units[number].steps,
        latched: latched.filter(|_| homing.is_some_and(|mask| mask >> number & 1 == 1)).map(|at| at[number]),
    };
    let axes: Vec<AxisDriven> = axes.iter().cloned().enumerate().map(axis).collect();
    let moved = |axis: &AxisDriven| i64::from(axis.position.wrapping_sub(axis.before)) == axis.steps_planned;
    Ok(Driven {
        passed: ended == How::Done && (homing.is_some() || axes.iter().all(moved)),
        port: port.to_owned(),
        build: format!("{:016x}", board.facts().build),
        ended,
        cause,
        planned_s: streamed.seconds,
        run_s: begun.elapsed().as_secs_f64(),
        axes,
    })
}

/// One line on a terminal: how far, and where the axes are.
struct Line<'a> {
    bar: ProgressBar,
    axes: &'a [String],
    begun: Instant,
}

impl<'a> Line<'a> {
    fn new(axes: &'a [String], seconds: f64) -> Self {
        // The target hides itself where standard error is no terminal.
        let total = (seconds * 1000.0) as u64;
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr_with_hz(10));
        let style = ProgressStyle::with_template("{bar:20} {percent:>3} % {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { bar, axes, begun: Instant::now() }
    }

    fn show(&self, status: &Status) {
        if self.bar.is_hidden() {
            return;
        }
        let elapsed = self.begun.elapsed().as_millis() as u64;
        let places = self.axes.iter().zip(status.positions).map(|(axis, steps)| format!("{axis} {steps}"));
        self.bar.set_message(places.collect::<Vec<_>>().join("  "));
        self.bar.set_position(elapsed.min(self.bar.length().unwrap_or(0)));
    }
}

impl Drop for Line<'_> {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

//! `carrystep status` and `stop`: what a board does, and that it stops.

use crate::arguments::{Status, Stop};
use crate::connection::{self, Connection};
use crate::failure::Failure;
use crate::output;
use carrystep_link::registers::{DISCARDED, MOST_AXES};
use carrystep_link::{Answer, frame};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write as _;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct Found {
    passed: bool,
    port: String,
    build: String,
    clock_hz: u32,
    tick_ns: u32,
    phases: u32,
    watchdog_ticks: u32,
    /// The drivers have power.
    ready: bool,
    /// All axes are done.
    idle: bool,
    /// A start waits.
    armed: bool,
    /// A stop has been called; only a clear resumes.
    fault: bool,
    /// The stop is over.
    halted: bool,
    cause: Option<&'static str>,
    axes: Vec<AxisFound>,
}

#[derive(JsonSchema, Serialize)]
struct AxisFound {
    axis: String,
    position: i32,
    discarded: u32,
    /// It waits for its limit.
    homing: bool,
    /// The stop came from it.
    culprit: bool,
}

/// Tells what a board does.
pub fn status(arguments: &Status) -> Result<(), Failure> {
    let connection = connection::to_peer(&arguments.peer)?;
    told(connection, &arguments.peer.port.name, arguments.json)
}

/// Stops what moves; resumes and takes the power away where that is wished.
pub fn stop(arguments: &Stop) -> Result<(), Failure> {
    let mut connection = connection::to_peer(&arguments.peer)?;
    let Connection { board, axes } = &mut connection;
    let failed = |error| connection::broken(&error, axes);
    if !board.status().answer.idle {
        board.stop().map_err(failed)?;
    }
    if arguments.clear {
        board.clear().map_err(failed)?;
    }
    if arguments.off {
        board.disable().map_err(failed)?;
    }
    told(connection, &arguments.peer.port.name, arguments.json)
}

fn told(connection: Connection, port: &str, json: bool) -> Result<(), Failure> {
    let found = look(connection, port)?;
    if json { output::print_json(&found) } else { output::print(&text(&found)) }
}

fn look(Connection { mut board, axes }: Connection, port: &str) -> Result<Found, Failure> {
    let failed = |error| connection::broken(&error, &axes);
    let status = board.look().map_err(failed)?;
    let mut discarded = [0; MOST_AXES as usize];
    for (axis, place) in (0..).zip(discarded.iter_mut().take(axes.len())) {
        *place = board.register(frame::of_axis(DISCARDED, axis)).map_err(failed)?;
    }
    let Answer { ready, idle, armed, fault, halted, homing, culprits, .. } = status.answer;
    let facts = board.facts();
    let axis = |(number, axis): (usize, String)| AxisFound {
        axis,
        position: status.positions[number],
        discarded: discarded[number],
        homing: homing >> number & 1 == 1,
        culprit: fault && culprits >> number & 1 == 1,
    };
    Ok(Found {
        passed: true,
        port: port.to_owned(),
        build: format!("{:016x}", facts.build),
        clock_hz: facts.clock_hz,
        tick_ns: facts.tick_ns,
        phases: facts.phases,
        watchdog_ticks: facts.watchdog_ticks,
        ready,
        idle,
        armed,
        fault,
        halted,
        cause: status.answer.cause_name(),
        axes: axes.iter().cloned().enumerate().map(axis).collect(),
    })
}

fn text(found: &Found) -> String {
    let mut text = format!(
        "{}: build {}, clock {} Hz, tick {} ns, {} phases\n",
        found.port, found.build, found.clock_hz, found.tick_ns, found.phases
    );
    let state = match (found.cause, found.halted, found.idle) {
        (Some(cause), true, _) => format!("STOPPED: {cause}; `carrystep stop --clear` resumes"),
        (Some(cause), false, _) => format!("stopping: {cause}"),
        (None, _, true) => "at rest".to_owned(),
        (None, _, false) => "moving".to_owned(),
    };
    let power = if found.ready { "drivers powered" } else { "drivers without power" };
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{state}; {power}");
    let _ = writeln!(text, "{:<6}  {:>11}  {:>9}", "axis", "position", "discarded");
    for AxisFound { axis, position, discarded, homing, culprit } in &found.axes {
        let homing = if *homing { "  waits for its limit" } else { "" };
        let culprit = if *culprit { "  the stop came from it" } else { "" };
        let _ = writeln!(text, "{axis:<6}  {position:>11}  {discarded:>9}{homing}{culprit}");
    }
    text
}

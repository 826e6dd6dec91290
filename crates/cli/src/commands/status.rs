//! `carrystep status`: the state of a board and the positions of its axes.

use crate::arguments::StatusArguments;
use crate::connection::{self, Connection};
use crate::control::{self, ANSWER, Reply, SocketRequest};
use crate::failure::Failure;
use crate::found::{FoundBoard, Known};
use crate::memory::BoardMemory;
use crate::output;
use carrystep_link::frame;
use carrystep_link::registers::{DISCARDED, TICKS};
use std::time::{Duration, Instant};

/// Reports the state of a board. If another command drives the board, the state comes from that
/// command.
pub fn status(arguments: &StatusArguments) -> Result<(), Failure> {
    let begin = Instant::now();
    loop {
        if let Some(found) = asked(&arguments.peer.port.name)? {
            return tell(&found, arguments.json);
        }
        match connection::to_peer(&arguments.peer, arguments.peer.baud, "status") {
            Ok(connection) => return tell(&read_status(connection)?, arguments.json),
            // A command that has just begun will listen; one that has just ended will release the
            // port.
            Err(refused) if refused.busy && begin.elapsed() < ANSWER => {
                std::thread::sleep(Duration::from_millis(5));
            }
            Err(refused) => return Err(refused.failure),
        }
    }
}

/// The state as the driving command reports it; `None` if no command drives the board or it is not
/// yet connected.
fn asked(port: &str) -> Result<Option<FoundBoard>, Failure> {
    let Some(mut caller) = control::call(port) else { return Ok(None) };
    match caller.ask(SocketRequest::Status, ANSWER) {
        Reply::Line(line) if line.is_empty() => Ok(None),
        Reply::Ended => Ok(None),
        Reply::Silent => Err(Failure::Run(connection::hangs(
            port,
            &caller.holder,
            SocketRequest::Status,
            "answer",
        ))),
        Reply::Line(line) => serde_json::from_str(&line).map(Some).map_err(|error| {
            Failure::Run(format!("{} answers with {line:?}: {error}", caller.holder))
        }),
    }
}

/// Prints the state.
pub fn tell(found: &FoundBoard, json: bool) -> Result<(), Failure> {
    if json { output::print_json(found) } else { output::print(&found.to_string()) }
}

/// Reads the whole state from the board and releases the port.
pub fn read_status(mut connection: Connection) -> Result<FoundBoard, Failure> {
    let memory = BoardMemory::recall(&mut connection);
    // `control` is bound before `board` so that it is dropped later: the port is closed before the
    // claim on it ends.
    let Connection { control: _control, mut board, axes, steps_per_unit, port, .. } = connection;
    let failed = |error| connection::broken(&error, &axes);
    let status = board.read_status().map_err(failed)?;
    let ticks = board.register(TICKS).map_err(failed)?;
    let mut discarded = Vec::new();
    for axis in (0..).take(axes.len()) {
        discarded.push(board.register(frame::of_axis(DISCARDED, axis)).map_err(failed)?);
    }
    let known = Known { port, facts: *board.facts(), axes, steps_per_unit };
    let mut found = FoundBoard::new(&status, &known, Some(&discarded));
    found.ticks = Some(ticks);
    for (number, axis) in found.axes.iter_mut().enumerate() {
        axis.machine = memory.coordinate(number, &status.positions);
    }
    Ok(found)
}

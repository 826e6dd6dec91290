//! `carrystep status`: what a board does, and where its axes are.

use crate::arguments::Status;
use crate::connection::{self, Connection};
use crate::control::{self, Reply, Request};
use crate::failure::Failure;
use crate::found::{Found, Known};
use crate::memory::Memory;
use crate::output;
use carrystep_link::frame;
use carrystep_link::registers::DISCARDED;
use std::time::Duration;

/// A command that drives a board looks at its socket every few milliseconds; a busy computer may hold it up.
const ANSWER: Duration = Duration::from_secs(2);

/// Tells what a board does; while another command drives it, that command is asked.
pub fn status(arguments: &Status) -> Result<(), Failure> {
    let port = &arguments.peer.port.name;
    if let Some(mut caller) = control::call(port) {
        match caller.ask(Request::Status, ANSWER) {
            // It has not connected yet, or has ended meanwhile: then the port says more.
            Reply::Line(line) if line.is_empty() => {}
            Reply::Ended => {}
            Reply::Line(line) => {
                let found: Found = serde_json::from_str(&line)
                    .map_err(|error| Failure::Run(format!("{} answers with {line:?}: {error}", caller.holder)))?;
                return tell(&found, arguments.json);
            }
            Reply::Silent => {
                return Err(Failure::Run(connection::hangs(port, &caller.holder, Request::Status, "answer")));
            }
        }
    }
    let connection = connection::to_peer(&arguments.peer, "status")?;
    tell(&look(connection)?, arguments.json)
}

/// Prints it.
pub fn tell(found: &Found, json: bool) -> Result<(), Failure> {
    if json { output::print_json(found) } else { output::print(&found.to_string()) }
}

/// Asks the board for everything, and gives the port back.
pub fn look(connection: Connection) -> Result<Found, Failure> {
    let memory = Memory::recall(&connection);
    let Connection { mut board, axes, steps_per_unit, port, control: _control } = connection;
    let failed = |error| connection::broken(&error, &axes);
    let status = board.look().map_err(failed)?;
    let mut discarded = Vec::new();
    for axis in (0..).take(axes.len()) {
        discarded.push(board.register(frame::of_axis(DISCARDED, axis)).map_err(failed)?);
    }
    let known = Known { port, facts: *board.facts(), axes, steps_per_unit };
    let mut found = Found::new(&status, &known, Some(&discarded));
    for (number, axis) in found.axes.iter_mut().enumerate() {
        axis.machine = memory.coordinate(number, axis.position);
    }
    Ok(found)
}

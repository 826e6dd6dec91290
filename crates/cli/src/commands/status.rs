//! `carrystep status`: what a board does, and where its axes are.

use crate::arguments::Status;
use crate::connection::{self, Connection};
use crate::control::{self, Reply, Request};
use crate::failure::Failure;
use crate::found::{self, Found, Known};
use crate::memory::{self, Memory};
use crate::output;
use carrystep_link::frame;
use carrystep_link::registers::DISCARDED;
use std::time::{Duration, Instant};

/// A command that drives a board looks at its socket every few milliseconds; a busy computer may hold it up.
const ANSWER: Duration = Duration::from_secs(2);

/// Tells what a board does; while another command drives it, that command is asked.
pub fn status(arguments: &Status) -> Result<(), Failure> {
    let begin = Instant::now();
    loop {
        if let Some(found) = asked(&arguments.peer.port.name)? {
            return tell(&found, arguments.json);
        }
        match connection::to_peer(&arguments.peer, arguments.peer.baud, "status") {
            Ok(connection) => return tell(&look(connection)?, arguments.json),
            // A command that has just begun will listen, or one that has just ended will give the port back.
            Err(refused) if refused.busy && begin.elapsed() < ANSWER => std::thread::sleep(Duration::from_millis(5)),
            Err(refused) => return Err(refused.failure),
        }
    }
}

/// What the command says that drives the board at this port; nothing where none does, or knows the board yet.
fn asked(port: &str) -> Result<Option<Found>, Failure> {
    let Some(mut caller) = control::call(port) else { return Ok(None) };
    match caller.ask(Request::Status, ANSWER) {
        Reply::Line(line) if line.is_empty() => Ok(None),
        Reply::Ended => Ok(None),
        Reply::Silent => Err(Failure::Run(connection::hangs(port, &caller.holder, Request::Status, "answer"))),
        Reply::Line(line) => serde_json::from_str(&line)
            .map(Some)
            .map_err(|error| Failure::Run(format!("{} answers with {line:?}: {error}", caller.holder))),
    }
}

/// Prints it.
pub fn tell(found: &Found, json: bool) -> Result<(), Failure> {
    if json { output::print_json(found) } else { output::print(&found.to_string()) }
}

/// Asks the board for everything, and gives the port back.
pub fn look(connection: Connection) -> Result<Found, Failure> {
    let memory = Memory::recall(&connection);
    // The port is closed before the control gives up its claim: what is bound first is dropped last.
    let Connection { control: _control, mut board, axes, steps_per_unit, port } = connection;
    let failed = |error| connection::broken(&error, &axes);
    let status = board.look().map_err(failed)?;
    let mut discarded = Vec::new();
    for axis in (0..).take(axes.len()) {
        discarded.push(board.register(frame::of_axis(DISCARDED, axis)).map_err(failed)?);
    }
    // Motors may have lost steps: the next clear forgets where they are, and nobody should trust it before that.
    let frozen = found::cause(&status.answer).is_some_and(memory::always_freezes);
    let known = Known { port, facts: *board.facts(), axes, steps_per_unit };
    let mut found = Found::new(&status, &known, Some(&discarded));
    for (number, axis) in found.axes.iter_mut().enumerate() {
        axis.machine = memory.coordinate(number, axis.position).filter(|_| !frozen);
    }
    Ok(found)
}

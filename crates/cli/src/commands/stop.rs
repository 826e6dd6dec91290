//! `carrystep stop`: stops what moves, through the command that drives it where there is one.

use crate::arguments::Stop;
use crate::commands::status::{look, tell};
use crate::connection::{self, Connection};
use crate::control::{self, Caller, Holder, Reply, Request};
use crate::failure::Failure;
use crate::interrupt;
use crate::memory::Memory;
use carrystep_link::HostError;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// So long the command that drives may take until it has read the request. It looks every few milliseconds; a busy
/// computer may hold it up.
const TAKEN: Duration = Duration::from_secs(2);
/// So long it may take to ramp down and to end: as the driver waits, and more.
const ENDED: Duration = Duration::from_secs(15);
/// So long a port may stay busy without a command that can be asked: `status`, or one that is about to listen.
const BUSY: Duration = Duration::from_secs(2);

/// Stops what moves; resumes and takes the power away where that is wished.
pub fn stop(arguments: &Stop) -> Result<(), Failure> {
    let (mut connection, stopped) = reach(arguments)?;
    let mut memory = Memory::recall(&connection);
    let Connection { board, axes, .. } = &mut connection;
    let failed = |error| connection::broken(&error, axes);
    if !board.status().answer.idle {
        board.stop().map_err(failed)?;
    }
    if arguments.clear {
        board.clear().map_err(|error| match error {
            HostError::StillPressed => Failure::Run(format!("{error}; then `carrystep stop --clear` again")),
            _ => failed(error),
        })?;
    }
    if arguments.off {
        board.disable().map_err(failed)?;
    }
    // What cannot be written does not match the board, and counts for nothing.
    let _ = memory.keep(board);
    let mut found = look(connection)?;
    found.stopped = stopped;
    tell(&found, arguments.json)
}

/// Makes whoever drives the board stop and end, and takes the port; says whom it has stopped.
fn reach(arguments: &Stop) -> Result<(Connection, Option<Holder>), Failure> {
    let port = &arguments.peer.port.name;
    let mut stopped: Option<Holder> = None;
    let mut begin = Instant::now();
    loop {
        if let Some(mut caller) = control::call(port)
            && ask(port, &mut caller)?
        {
            stopped = Some(caller.holder);
            begin = Instant::now();
        }
        // At the baud rate at which the other command has spoken, where there was one.
        let baud = stopped.as_ref().map_or(arguments.peer.baud, |holder| holder.baud);
        match connection::to_peer(&arguments.peer, baud, "stop") {
            Ok(connection) => return Ok((connection, stopped)),
            // A command that was stopped is about to give the port back; one that has just begun is about to listen.
            Err(refused) if refused.busy && begin.elapsed() < BUSY => {
                if interrupt::watch().load(Ordering::Relaxed) {
                    return Err(Failure::Run("interrupted".to_owned()));
                }
                std::thread::sleep(Duration::from_millis(5));
            }
            Err(refused) if refused.busy && cfg!(not(unix)) => {
                let help = "press Ctrl-C in its terminal: on this system `stop` reaches no other command";
                return Err(Failure::Run(format!("{}; {help}", refused.failure.message())));
            }
            Err(refused) => {
                return Err(match stopped {
                    Some(holder) => {
                        Failure::Run(format!("{holder} was stopped; but then {}", refused.failure.message()))
                    }
                    None => refused.failure,
                });
            }
        }
    }
}

/// Whether that command has taken the stop and ended; false where it had ended before.
fn ask(port: &str, caller: &mut Caller) -> Result<bool, Failure> {
    match caller.ask(Request::Stop, TAKEN) {
        Reply::Line(_) if caller.ends(ENDED) => Ok(true),
        Reply::Line(_) => Err(Failure::Run(connection::hangs(port, &caller.holder, Request::Stop, "end"))),
        Reply::Silent => Err(Failure::Run(connection::hangs(port, &caller.holder, Request::Stop, "answer"))),
        Reply::Ended => Ok(false),
    }
}

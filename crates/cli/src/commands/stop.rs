//! `carrystep stop`: stops all axes of a board, through the command that drives it if there is one,
//! and otherwise by itself, whichever host has opened the session.

use crate::arguments::Stop;
use crate::commands::status::{read_status, tell};
use crate::connection::{self, ConnectedBoard, ConnectedBoardError, Connection};
use crate::control::{self, ANSWER, Caller, Holder, Reply, SocketRequest};
use crate::failure::Failure;
use crate::interrupt;
use crate::memory::BoardMemory;
use carrystep_link::registers::INPUTS;
use carrystep_link::{HostError, random_session};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// The bit of the interlock in the register INPUTS.
const INTERLOCK: u32 = 24;
/// How long it may take to ramp down and to end: longer than the driver's own time-out.
const ENDED: Duration = Duration::from_secs(15);
/// How long a port may stay busy without a command that listens: `status` may hold it, or a command
/// that is about to listen.
const BUSY: Duration = Duration::from_secs(2);

/// Stops all axes; then clears the stop and switches the drivers off, if the arguments say so.
pub fn stop(arguments: &Stop) -> Result<(), Failure> {
    let (mut connection, stopped) = reach(arguments)?;
    if !connection.board.status().answer.idle {
        let Connection { board, axes, .. } = &mut connection;
        board.stop().map_err(|error| connection::broken(&error, axes))?;
    }
    // Of axes that move, the memory cannot tell whether it is right. A stop needs no session.
    let mut memory = BoardMemory::recall(&mut connection);
    let Connection { board, axes, .. } = &mut connection;
    let failed = |error| connection::broken(&error, axes);
    if arguments.clear || arguments.off {
        board.open(random_session()).map_err(failed)?;
    }
    if arguments.clear
        && let Err(error) = board.clear()
    {
        let is_pressed = is_pressed(board, &error).map_err(failed)?;
        if is_pressed {
            // It may have come while the axes ramped down for the cause that the board keeps.
            memory.forget_places();
        }
        // The session is another one. If the file cannot be written, the old one no longer
        // matches the board and is ignored.
        let _ = memory.keep(board);
        let pressed = HostError::<std::io::Error>::StillPressed;
        return Err(match is_pressed {
            true => Failure::Run(format!("{pressed}; then `carrystep stop --clear` again")),
            false => failed(error),
        });
    }
    if arguments.off {
        board.disable().map_err(failed)?;
    }
    // If the file cannot be written, the old one no longer matches the board and is ignored.
    let _ = memory.keep(board);
    let mut found = read_status(connection)?;
    found.stopped = stopped;
    if arguments.off && !found.idle {
        let why = "the drivers keep their power as long as segments of the stopped move wait; \
                   `carrystep stop --clear --off` drops these and switches the drivers off";
        return Err(Failure::Run(why.to_owned()));
    }
    tell(&found, arguments.json)
}

/// Whether the e-stop is what a clear has failed for: the gateware takes one as soon as the axes rest
/// and neither the e-stop nor the interlock is active.
fn is_pressed(
    board: &mut ConnectedBoard,
    error: &ConnectedBoardError,
) -> Result<bool, ConnectedBoardError> {
    Ok(match error {
        HostError::StillPressed => true,
        HostError::TooLong { .. } if board.status().answer.halted => {
            board.register(INPUTS)? >> INTERLOCK & 1 == 0
        }
        _ => false,
    })
}

/// Makes the driving command stop and end, and connects to the port. Also returns the command that
/// was stopped.
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
        // The baud rate is that of the stopped command, if there was one.
        let baud = stopped.as_ref().map_or(arguments.peer.baud, |holder| holder.baud);
        match connection::to_peer(&arguments.peer, baud, "stop") {
            Ok(connection) => return Ok((connection, stopped)),
            // A stopped command is about to release the port; a new one is about to listen.
            Err(refused) if refused.busy && begin.elapsed() < BUSY => {
                if interrupt::watch().load(Ordering::Relaxed) {
                    return Err(Failure::Run("interrupted".to_owned()));
                }
                std::thread::sleep(Duration::from_millis(5));
            }
            Err(refused) if refused.busy && cfg!(not(unix)) => {
                let help =
                    "press Ctrl-C in its terminal: on this system `stop` reaches no other command";
                return Err(Failure::Run(format!("{}; {help}", refused.failure.message())));
            }
            Err(refused) => {
                return Err(match stopped {
                    Some(holder) => Failure::Run(format!(
                        "{holder} was stopped; but then {}",
                        refused.failure.message()
                    )),
                    None => refused.failure,
                });
            }
        }
    }
}

/// Returns true if the command has accepted the stop and ended, and false if it had ended before.
fn ask(port: &str, caller: &mut Caller) -> Result<bool, Failure> {
    match caller.ask(SocketRequest::Stop, ANSWER) {
        Reply::Line(_) if caller.ends(ENDED) => Ok(true),
        Reply::Line(_) => {
            Err(Failure::Run(connection::hangs(port, &caller.holder, SocketRequest::Stop, "end")))
        }
        Reply::Silent => Err(Failure::Run(connection::hangs(
            port,
            &caller.holder,
            SocketRequest::Stop,
            "answer",
        ))),
        Reply::Ended => Ok(false),
    }
}

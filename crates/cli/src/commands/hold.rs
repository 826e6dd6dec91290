//! `carrystep hold` and `resume`: bring the program to rest with which another command drives the
//! board, and let it go on.

use crate::arguments::ProgramPortArguments;
use crate::connection;
use crate::control::{self, ANSWER, BUSY, NOTHING_MOVES, NOTHING_WAITS, Reply, SocketRequest};
use crate::failure::Failure;
use crate::output;

/// Brings the program to rest.
pub fn hold(arguments: &ProgramPortArguments) -> Result<(), Failure> {
    ask(&arguments.port.name, SocketRequest::Hold, "was asked to bring its program to rest")
}

/// Lets the program go on.
pub fn resume(arguments: &ProgramPortArguments) -> Result<(), Failure> {
    ask(&arguments.port.name, SocketRequest::Resume, "goes on")
}

/// Asks the command that drives the board at this port.
fn ask(port: &str, request: SocketRequest, done: &str) -> Result<(), Failure> {
    let state = if request == SocketRequest::Hold { "moves" } else { "waits" };
    if cfg!(not(unix)) {
        let message = "on this system no other command can be reached: use the terminal of `run`";
        return Err(Failure::input(message));
    }
    let nothing = || {
        let then = if request == SocketRequest::Hold {
            ""
        } else {
            "; a program that was stopped or has ended goes on with `carrystep run --from-block`"
        };
        Failure::input(format!(
            "no program {state} at {port}: `carrystep status` shows its state{then}"
        ))
    };
    let Some(mut caller) = control::call(port) else { return Err(nothing()) };
    match caller.ask(request, ANSWER) {
        Reply::Line(line) if [NOTHING_MOVES, NOTHING_WAITS].contains(&&*line) => Err(nothing()),
        Reply::Line(line) if line == BUSY => {
            let message = "a jog, probe or offset of the pause is not done yet: the program goes on \
                           waiting; resume it behind that";
            Err(Failure::input(message))
        }
        Reply::Line(_) => output::print(&format!("{} {done}\n", caller.holder)),
        Reply::Ended => Err(nothing()),
        Reply::Silent => {
            Err(Failure::Run(connection::hangs(port, &caller.holder, request, "answer")))
        }
    }
}

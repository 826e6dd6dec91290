//! `carrystep override`: changes the speed of the program with which another command drives the
//! board.

use crate::arguments::OverrideArguments;
use crate::connection;
use crate::control::{self, ANSWER, NO_SPINDLE, NOTHING_RUNS, OverrideWish, Reply, SocketRequest};
use crate::failure::Failure;
use crate::json;
use crate::output;

/// Sets the overrides of the program.
///
/// # Errors
/// No program runs at this port, or its machine has no output for the speed of the spindle.
pub fn run(arguments: &OverrideArguments) -> Result<(), Failure> {
    let port = &*arguments.port.name;
    if cfg!(not(unix)) {
        return Err(Failure::input("on this system no other command can be reached"));
    }
    let OverrideArguments { feed, rapid, spindle, .. } = *arguments;
    let text = json::line(&OverrideWish { feed, rapid, spindle })
        .map_err(|error| Failure::Run(error.to_string()))?;
    let nothing =
        || Failure::input(format!("no program runs at {port}: `carrystep status` shows its state"));
    let Some(mut caller) = control::call(port) else { return Err(nothing()) };
    let request = SocketRequest::Override;
    match caller.ask_with(request, &text, ANSWER) {
        Reply::Line(line) if line == NOTHING_RUNS || line.is_empty() => Err(nothing()),
        Reply::Line(line) if line == NO_SPINDLE => Err(Failure::input(
            "the machine of this program has no output for the speed of its spindle: set \
             spindle_rpm in [machine.outputs], or leave out --spindle",
        )),
        Reply::Line(line) => output::print(&format!("{}: {line}\n", caller.holder)),
        Reply::Ended => Err(nothing()),
        Reply::Silent => {
            Err(Failure::Run(connection::hangs(port, &caller.holder, request, "answer")))
        }
    }
}

//! The virtual board of `carrystep serve --virtual`, in a thread of this process.

use crate::connection;
use crate::failure::Failure;
use crate::operated::ahead;
use carrystep_files::Machine;
use carrystep_virtual_board::{ModelBoard, Pace, RealTimeBoard, Terminal};
use std::path::Path;

/// Begins to simulate the board of a machine, until the process ends. Returns its port. `name` is
/// the path of the machine file.
///
/// # Errors
/// The machine cannot be built, or the system has no pseudo-terminal.
pub fn simulate(machine: &Machine, name: &Path, fast: bool) -> Result<String, Failure> {
    let (uart, _) = connection::wanted(machine, name)?;
    let terminal =
        Terminal::new().map_err(|error| Failure::Run(format!("no pseudo-terminal: {error}")))?;
    let port = terminal.name().to_owned();
    let build = machine.engine();
    let clock_hz = build.timebase.clock_hz();
    let pace = if fast { Pace::fast(clock_hz, ahead(&build)) } else { Pace::real(clock_hz) };
    let mut board = RealTimeBoard::new(ModelBoard::new(&build, uart), terminal, pace, clock_hz);
    // A board that has failed does not answer any more, and that is reported.
    std::thread::spawn(move || while board.step(&mut ()).is_ok() {});
    Ok(port)
}

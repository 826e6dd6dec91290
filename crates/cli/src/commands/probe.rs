//! `carrystep probe`: moves an axis until the probe ends the move, and sets what the touched place
//! is called: by itself, or through the command whose program waits.

use crate::arguments::ProbeArguments;
use crate::connection;
use crate::drive::{self, ProbeMove};
use crate::failure::Failure;
use crate::memory::BoardMemory;
use crate::output;
use crate::pause::{self, PauseWish};
use crate::probe::ProbeWish;
use carrystep_files::Machine;
use carrystep_program::{Letters, ProgramError};

/// Probes along an axis.
pub fn run(arguments: &ProbeArguments) -> Result<(), Failure> {
    let machine = Machine::load(&arguments.machine)?;
    let fault = |fault| ProgramError::new(&arguments.machine, 0, fault);
    let letters = Letters::new(&machine).map_err(fault)?;
    let wish = ProbeWish {
        axis: arguments.axis.clone(),
        distance: arguments.distance,
        feed: arguments.feed,
        away: arguments.away,
        retract: arguments.retract,
        target: arguments.set.or(arguments.tool),
        plate: arguments.plate,
    };
    wish.axis(&machine)?;
    // What cannot be planned is refused before the board is looked for.
    wish.way().file(&machine)?;
    let port = &arguments.port;
    if pause::ask(&port.name, &PauseWish::Probe(wish.clone()), arguments.json)? {
        return Ok(());
    }
    let mut connection = connection::to_machine(port, &machine, &arguments.machine, "probe")?;
    let memory = BoardMemory::recall(&mut connection);
    memory.usable()?;
    let status = *connection.board.status();
    if !status.answer.idle && !status.answer.fault {
        let message = "axes move or segments wait, of another host: a probe move begins where the \
                       machine rests, so wait for that, or `carrystep stop`";
        return Err(Failure::input(message));
    }
    let unhomed = arguments.unhomed;
    let wanted = ProbeMove { machine: &machine, letters: &letters, wish: &wish, unhomed };
    let probed = drive::probe(connection, memory, &wanted)?;
    if arguments.json {
        output::print_json(&probed)?;
    } else {
        output::print(&probed.to_string())?;
    }
    if probed.passed { Ok(()) } else { Err(Failure::Check) }
}

//! `carrystep run` of G-code programs: find where the machine is, plan the program from there to
//! its end, then stream it while it is planned again.

use crate::arguments::RunArguments;
use crate::confirm::confirm;
use crate::drive::{Driven, Place, PlannedProgram, drive};
use crate::entry::EntryFigures;
use crate::failure::Failure;
use crate::memory::BoardMemory;
use crate::{connection, program, work};
use carrystep_program::{Letters, Offsets, ProgramError, ProgramFile, Settings};
use std::io::{self, Write as _};

/// Runs a program. Nothing moves before it has been planned to its end.
pub fn run(arguments: &RunArguments) -> Result<Driven, Failure> {
    program::refuse(&[("--fit-ns", arguments.fit_ns.is_some())])?;
    let (path, planner) = (&arguments.file, &arguments.planner);
    let (machine_path, machine) = program::machine(path, planner)?;
    let fault = |fault| ProgramError::new(machine_path, 0, fault);
    let letters = Letters::new(&machine).map_err(fault)?;
    // A file that cannot be opened is reported before the board is looked for.
    let _ = carrystep_files::open(path).map_err(|error| Failure::input(error.to_string()))?;
    let mut connection = connection::to_machine(&arguments.port, &machine, machine_path, "run")?;
    let memory = BoardMemory::recall(&mut connection);
    memory.usable()?;
    let status = *connection.board.status();
    if !status.answer.idle && !status.answer.fault {
        let message = "axes move or segments wait, of another host: the program begins where the \
                       machine rests, so wait for that, or `carrystep stop`";
        return Err(Failure::input(message));
    }
    let place = Place::find(&machine, &letters, &memory, &status.positions, arguments.unhomed)?;
    // Without a machine zero, nobody knows where the offsets are.
    let offsets = if arguments.unhomed { Offsets::default() } else { memory.work()?.clone() };
    work::tell(&offsets);
    let from = arguments.from.from();
    let settings = Settings { start: place.start, from, offsets, ..program::settings(planner) };
    let file = ProgramFile::open(path, place.bounded(&machine), machine_path, settings)?;
    let planned = PlannedProgram::new(&file, &place, !arguments.unhomed, || {
        connection.control.wish(&status)
    })?;
    for warning in planned.unswitched().chain(planned.warning()) {
        // If this write fails, there is no channel left to report it.
        let _ = writeln!(io::stderr(), "warning: {warning}");
    }
    if let Some(entry) = EntryFigures::of(&file) {
        confirm(&entry, arguments.yes, || connection.control.wish(&status))?;
    }
    planned.along(|itinerary| {
        drive(connection, memory, planned.plan(), itinerary, arguments.into_limit)
    })
}

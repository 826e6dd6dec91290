//! `carrystep offset`: shows and sets the work offsets that are kept of a board.

use crate::arguments::OffsetArguments;
use crate::connection;
use crate::drive::Place;
use crate::failure::Failure;
use crate::memory::BoardMemory;
use crate::output;
use crate::pause::{self, PauseWish};
use crate::work::{self, NamedOffset};
use carrystep_files::Machine;
use carrystep_gcode::{AXIS_LETTERS, Offsets};
use carrystep_program::{Letters, ProgramError};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct ShownOffsets {
    passed: bool,
    /// The port of the board.
    port: String,
    /// The offsets that are not zero.
    offsets: Vec<NamedOffset>,
}

impl fmt::Display for ShownOffsets {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.offsets.is_empty() {
            return writeln!(f, "{}: no work offsets", self.port);
        }
        writeln!(f, "{}: work offsets in mm and degrees", self.port)?;
        self.offsets.iter().try_for_each(|offset| writeln!(f, "{offset}"))
    }
}

/// Shows the offsets, after it has set them if the arguments say so.
pub fn run(arguments: &OffsetArguments) -> Result<(), Failure> {
    let machine = Machine::load(&arguments.machine)?;
    let fault = |fault| ProgramError::new(&arguments.machine, 0, fault);
    let letters = Letters::new(&machine).map_err(fault)?;
    check(arguments, &machine, &letters)?;
    let wish = match arguments.set {
        None if arguments.clear => PauseWish::Clear,
        None => PauseWish::Show,
        Some(target) => PauseWish::Set(target, arguments.values.clone()),
    };
    if pause::ask(&arguments.port.name, &wish, arguments.json)? {
        return Ok(());
    }
    let mut connection =
        connection::to_machine(&arguments.port, &machine, &arguments.machine, "offset")?;
    let mut memory = BoardMemory::recall(&mut connection);
    memory.usable()?;
    let offsets = match arguments.set {
        None if arguments.clear => Offsets::default(),
        None => memory.work()?.clone(),
        Some(target) => {
            let status = *connection.board.status();
            if !status.answer.idle && !status.answer.halted {
                let message = "axes move, of another host: an offset needs a machine at rest";
                return Err(Failure::input(message));
            }
            let place = Place::find(&machine, &letters, &memory, &status.positions, false)?;
            let before = memory.work().cloned().unwrap_or_default();
            work::set(&before, place.start, target, &arguments.values)?
        }
    };
    if arguments.set.is_some() || arguments.clear {
        memory.set_work(offsets.clone());
        connection::open(&mut connection)?;
        memory
            .keep(&mut connection.board)
            .map_err(|error| Failure::Run(format!("the work offsets cannot be kept: {error}")))?;
    }
    let port = arguments.port.name.clone();
    let shown = ShownOffsets { passed: true, port, offsets: work::named(&offsets) };
    if arguments.json { output::print_json(&shown) } else { output::print(&shown.to_string()) }
}

/// Refuses `--set` without values, and axes that the machine does not have.
fn check(arguments: &OffsetArguments, machine: &Machine, letters: &Letters) -> Result<(), Failure> {
    if arguments.set.is_some() && arguments.values.is_empty() {
        return Err(Failure::input("--set needs values: `carrystep offset --set G54 x=0,z=1.5`"));
    }
    let strange = arguments.values.iter().find(|(letter, _)| letters.axis(*letter).is_none());
    strange.map_or(Ok(()), |&(letter, _)| {
        let (name, axes) = (AXIS_LETTERS[letter], machine.axis_names());
        Err(Failure::input(format!("the machine has no axis {name}: the axes are {axes}")))
    })
}

//! `carrystep offset`: shows and sets the work offsets that are kept of a board.

use crate::arguments::{OffsetArguments, PortArguments};
use crate::connection;
use crate::drive::Place;
use crate::failure::Failure;
use crate::memory::{self, BoardMemory};
use crate::output;
use crate::pause::{self, PauseWish};
use crate::work::{self, NamedOffset, OffsetWish};
use carrystep_files::Machine;
use carrystep_program::{Letters, Offsets, ProgramError};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::path::Path;

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
    let wish = match arguments.set {
        None if arguments.clear => PauseWish::Clear,
        None => PauseWish::Show,
        Some(_) if arguments.values.is_empty() => {
            let message = "--set needs values: `carrystep offset --set G54 x=0,z=1.5`";
            return Err(Failure::input(message));
        }
        Some(target) => PauseWish::Set(OffsetWish { target, values: arguments.values.clone() }),
    };
    change(&machine, &arguments.machine, &wish, (&arguments.port, arguments.json))
}

/// Shows, sets or clears the offsets as `wish` says, and prints them: by itself, or through the
/// command whose program waits. `name` is the path of the machine file.
///
/// # Errors
/// The wish names axes that the machine does not have, or it cannot be met where the machine is.
pub fn change(
    machine: &Machine,
    name: &Path,
    wish: &PauseWish,
    (port, json): (&PortArguments, bool),
) -> Result<(), Failure> {
    let letters = Letters::new(machine).map_err(|fault| ProgramError::new(name, 0, fault))?;
    if let PauseWish::Set(wish) = wish {
        wish.check(machine, &letters)?;
    }
    if pause::ask(&port.name, wish, json)? {
        return Ok(());
    }
    let mut connection = connection::to_machine(port, machine, name, "offset")?;
    let mut memory = BoardMemory::recall(&mut connection);
    memory.usable()?;
    let new = match wish {
        PauseWish::Clear => Some(Offsets::default()),
        PauseWish::Set(wish) => {
            let status = *connection.board.status();
            if !status.answer.idle && !status.answer.halted {
                let message = "axes move, of another host: an offset needs a machine at rest";
                return Err(Failure::input(message));
            }
            let place = Place::find(machine, &letters, &memory, &status.positions, false)?;
            let before = memory.work().cloned().unwrap_or_default();
            Some(work::set(&before, place.start, wish)?)
        }
        PauseWish::Show | PauseWish::Jog(..) | PauseWish::Probe(_) => None,
    };
    let offsets = match &new {
        Some(offsets) => offsets.clone(),
        None => memory.work()?.clone(),
    };
    if let Some(offsets) = new {
        memory.set_work(offsets);
        connection::open(&mut connection)?;
        memory.keep(&mut connection.board).map_err(|error| memory::not_kept(&error))?;
    }
    let shown =
        ShownOffsets { passed: true, port: port.name.clone(), offsets: work::named(&offsets) };
    if json { output::print_json(&shown) } else { output::print(&shown.to_string()) }
}

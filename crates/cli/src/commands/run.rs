//! `carrystep run` of move files, and `jog`: plan the moves, connect to the board, stream them and
//! report the outcome.

use crate::arguments::{Jog, PortArguments, RunArguments};
use crate::commands::run_program;
use crate::connection;
use crate::drive::{Driven, Moves, drive};
use crate::failure::Failure;
use crate::memory::BoardMemory;
use crate::{job, output};
use carrystep_files::{Machine, MoveFile, MoveSource, SourceText, decimal};
use carrystep_program::is_program;
use std::path::Path;

/// Executes the moves of a file, or a program.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    if is_program(&arguments.file) {
        return told(&run_program::run(arguments)?, arguments.json);
    }
    arguments.planner.refuse_for_moves(&[("--unhomed", arguments.unhomed)])?;
    let source = job::load(&arguments.file, arguments.fit_ns)?;
    let name = arguments.file.as_path();
    told(&moved(source, name, &arguments.port, "run", arguments.into_limit)?, arguments.json)
}

/// Moves one axis.
pub fn jog(arguments: &Jog) -> Result<(), Failure> {
    let machine = Machine::load(&arguments.machine)?;
    let Jog { axis, distance, time, .. } = arguments;
    // Quoted as a TOML key, so that the name cannot contain TOML syntax.
    let axis = serde_json::to_string(axis).map_err(|error| Failure::Run(error.to_string()))?;
    let time = time.map_or_else(String::new, |seconds| format!("time = {seconds:?}\n"));
    let text =
        format!("[[move]]\nprofile = \"trapezoid\"\n{time}to = {{ {axis} = {distance:?} }}\n");
    let file = MoveFile::of_moves(machine, SourceText { path: "jog".into(), text: text.into() })?;
    if let Some(failure) = nothing_to_do(&file, arguments) {
        return Err(failure);
    }
    told(
        &moved(file.into(), &arguments.machine, &arguments.port, "jog", arguments.into_limit)?,
        arguments.json,
    )
}

/// Plans and executes the moves. Everything is planned before the port is opened, and nothing moves
/// before the board is identified.
fn moved(
    source: MoveSource,
    name: &Path,
    port: &PortArguments,
    command: &'static str,
    into_limit: bool,
) -> Result<Driven, Failure> {
    let machine = source.machine.clone();
    let moves = Moves::new(source)?;
    let mut connection = connection::to_machine(port, &machine, name, command)?;
    let memory = BoardMemory::recall(&mut connection);
    memory.usable()?;
    drive(connection, memory, moves.plan(), &moves.itinerary(), into_limit)
}

/// The failure for a jog of less than half a step, which states the size of a step.
fn nothing_to_do(file: &MoveFile, arguments: &Jog) -> Option<Failure> {
    let first = file.moves.first().filter(|only| only.steps.iter().all(|&steps| steps == 0))?;
    let (number, axis) =
        (0..).zip(&file.machine.axes).find(|(_, axis)| axis.name == arguments.axis)?;
    let part = first.rounding.get(number).copied().unwrap_or_default().abs();
    let step = 1.0 / decimal::to_f64(&axis.steps_per_unit);
    let Jog { axis, distance, .. } = arguments;
    Some(Failure::input(format!(
        "jog {axis} {distance} is {part:.3} step, which rounds to no step at all: nothing would move. One step of {axis} \
         is {step} of its units"
    )))
}

fn told(driven: &Driven, json: bool) -> Result<(), Failure> {
    if json {
        output::print_json(driven)?;
    } else {
        output::print(&driven.to_string())?;
    }
    if driven.passed { Ok(()) } else { Err(Failure::Check) }
}

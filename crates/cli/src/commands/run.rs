//! `carrystep run` of move files, and `jog`: plan the moves, connect to the board, stream them and
//! report the outcome.

use crate::arguments::{Jog, PortArguments, RunArguments};
use crate::commands::{offset, run_program};
use crate::connection;
use crate::drive::{Driven, Moves, OffsetAtEnd, Place, drive};
use crate::failure::Failure;
use crate::jog::{self, JogWish};
use crate::memory::BoardMemory;
use crate::pause::{self, PauseWish};
use crate::{job, output};
use carrystep_files::{Machine, MoveSource};
use carrystep_program::{Letters, ProgramError, is_program};
use std::path::Path;

/// Executes the moves of a file, or a program.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    if is_program(&arguments.file) {
        return told(&run_program::run(arguments)?, arguments.json);
    }
    arguments.planner.refuse_for_moves(&[
        ("--unhomed", arguments.unhomed),
        ("--from-block", arguments.from.from_block.is_some()),
    ])?;
    let source = job::load(&arguments.file, arguments.fit_ns)?;
    let name = arguments.file.as_path();
    told(
        &moved(source, name, &arguments.port, "run", arguments.into_limit, |_, _| Ok(None))?,
        arguments.json,
    )
}

/// Moves one axis or several, and sets a work offset where they rest: by itself, or through the
/// command whose program waits. Without a move, it only sets the offset.
pub fn jog(arguments: &Jog) -> Result<(), Failure> {
    let machine = Machine::load(&arguments.machine)?;
    let Jog { axis, distance, axes, feed, time, into_limit, .. } = arguments;
    let one = axis.clone().zip(*distance);
    let distances: Vec<_> = one.into_iter().chain(axes.iter().cloned()).collect();
    let (port, name) = (&arguments.port, arguments.machine.as_path());
    let letters = || Letters::new(&machine).map_err(|fault| ProgramError::new(name, 0, fault));
    let set = match &arguments.set[..] {
        [] => None,
        words => {
            let wish = jog::offset_of(words, &distances)?;
            wish.check(&machine, &letters()?)?;
            Some(wish)
        }
    };
    if let (true, Some(wish)) = (distances.is_empty(), &set) {
        let wish = PauseWish::Set(wish.clone());
        return offset::change(&machine, name, &wish, (port, arguments.json));
    }
    let wish = JogWish { distances, feed: *feed, time: *time, into_limit: *into_limit };
    let file = wish.file(&machine)?;
    if pause::ask(&port.name, &PauseWish::Jog(wish, set.clone()), arguments.json)? {
        return Ok(());
    }
    let check = |memory: &BoardMemory, positions: &[i32]| {
        let places: Vec<_> =
            (0..positions.len()).map(|number| memory.place(number, positions)).collect();
        jog::within_travel(&file, &places)?;
        let Some(wish) = set else { return Ok(None) };
        let letters = letters()?;
        let zero = Place::find(&machine, &letters, memory, positions, false)?.zero;
        let before = memory.work().cloned().unwrap_or_default();
        let sets = OffsetAtEnd { wish, before, letters, zero };
        let steps = |number: usize| file.moves.iter().map(|one| one.steps[number]).sum::<i64>();
        let ends = (0..file.machine.axes.len()).zip(positions);
        let ends = ends.map(|(number, &at)| at.saturating_add(steps(number) as i32));
        sets.at(&ends.collect::<Vec<_>>())?;
        Ok(Some(sets))
    };
    let source = file.clone().into();
    told(&moved(source, name, port, "jog", *into_limit, check)?, arguments.json)
}

/// Plans and executes the moves, and sets the offset that `check` returns where they end.
/// Everything is planned before the port is opened, and nothing moves before the board is
/// identified.
fn moved(
    source: MoveSource,
    name: &Path,
    port: &PortArguments,
    command: &'static str,
    into_limit: bool,
    check: impl FnOnce(&BoardMemory, &[i32]) -> Result<Option<OffsetAtEnd>, Failure>,
) -> Result<Driven, Failure> {
    let machine = source.machine.clone();
    let moves = Moves::new(source)?;
    let mut connection = connection::to_machine(port, &machine, name, command)?;
    let memory = BoardMemory::recall(&mut connection);
    memory.usable()?;
    let sets = check(&memory, &connection.board.status().positions)?;
    drive(connection, memory, moves.plan(), &moves.itinerary_and(sets), into_limit)
}

fn told(driven: &Driven, json: bool) -> Result<(), Failure> {
    if json {
        output::print_json(driven)?;
    } else {
        output::print(&driven.to_string())?;
    }
    if driven.passed { Ok(()) } else { Err(Failure::Check) }
}

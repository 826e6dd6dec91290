//! Opens a G-code program for a machine, and plans it once to its end.

use crate::arguments::{PlannerArguments, ProgramArguments};
use crate::failure::Failure;
use crate::progress::PlanProgress;
use crate::recorded::{Recorded, RecordedRows};
use crate::{interrupt, memory, work};
use carrystep_files::{InputError, Machine};
use carrystep_program::{ProgramFile, Row, Settings, Survey};
use carrystep_report::Detail;
use std::path::Path;

/// Opens a program that runs on no board.
pub fn load(path: &Path, arguments: &ProgramArguments) -> Result<ProgramFile, Failure> {
    let (machine_path, machine) = machine(path, &arguments.planner)?;
    let mut settings = settings(&arguments.planner);
    settings.from = arguments.from.from();
    for &(letter, at) in &arguments.at {
        settings.start[letter] = at;
    }
    if let Some(port) = &arguments.offsets_of {
        settings.offsets = memory::kept_offsets(port, &machine, machine_path)?;
        work::tell(&settings.offsets);
    }
    Ok(ProgramFile::open(path, machine, machine_path, settings)?)
}

/// Loads the machine of a program, which the options must name.
pub fn machine<'a>(
    path: &Path,
    arguments: &'a PlannerArguments,
) -> Result<(&'a Path, Machine), Failure> {
    let Some(machine_path) = &arguments.machine else {
        let message = format!("{}: a G-code program needs a machine", path.display());
        return Err(InputError::new(message).help("add --machine MACHINE.toml").into());
    };
    Ok((machine_path, Machine::load(machine_path)?))
}

/// How a program is to be run that begins at machine zero.
pub fn settings(arguments: &PlannerArguments) -> Settings {
    let tolerance_mm = arguments.tolerance;
    let settings = Settings { tolerance_mm, ..Settings::default() };
    Settings { blocks: arguments.blocks.unwrap_or(settings.blocks), ..settings }
}

/// Plans a program to its end, so that a mistake is found before anything is written. `watch` sees
/// each row.
pub fn survey(
    file: &ProgramFile,
    detail: Detail,
    mut watch: impl FnMut(&Row) -> Result<(), Failure>,
) -> Result<(Survey, Recorded), Failure> {
    let mut progress = PlanProgress::of("rows");
    let mut rows = RecordedRows::new(file, detail)?;
    for row in rows.by_ref() {
        progress.one();
        watch(&row?)?;
        interrupt::check()?;
    }
    file.same()?;
    Ok(rows.finish(file))
}

/// Refuses options of move files for a program.
pub fn refuse(options: &[(&str, bool)]) -> Result<(), Failure> {
    match options.iter().find(|(_, given)| *given) {
        None => Ok(()),
        Some((option, _)) => {
            Err(Failure::input(format!("{option} is not available for G-code programs")))
        }
    }
}

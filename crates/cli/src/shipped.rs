//! The machine that is shipped with the command, `sim/six-axis.toml`.

use crate::failure::Failure;
use carrystep_files::{Machine, SourceText};

/// The text of the machine file.
pub const MACHINE: &str = include_str!("../../../sim/six-axis.toml");
/// The name of the machine file in the folder of the demo.
pub const MACHINE_FILE: &str = "six-axis.toml";

/// The shipped machine.
///
/// # Errors
/// None, as long as the shipped file is a machine file; a test of the crate `files` reads it.
pub fn machine() -> Result<Machine, Failure> {
    let source = SourceText { path: MACHINE_FILE.into(), text: MACHINE.into() };
    Ok(Machine::from_source(&source)?)
}

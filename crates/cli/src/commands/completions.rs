//! `carrystep completions`: the script with which a shell completes the command line.

use crate::arguments::{Arguments, Completions};
use crate::failure::Failure;
use crate::output;
use clap::CommandFactory as _;

/// Prints the shell's script, as clap generates it.
pub fn run(arguments: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "carrystep", &mut script);
    output::print(&String::from_utf8_lossy(&script))
}

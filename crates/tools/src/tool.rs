//! Runs a tool in a directory, and reads and writes files there.

use crate::programs::Tool;
pub(crate) use crate::programs::{
    ECPPACK, GOWIN_PACK, ICEBOX_VLOG, ICEPACK, ICETIME, ICEUNPACK, NEXTPNR, NEXTPNR_ECP5,
    NEXTPNR_GOWIN, PYTHON, YOSYS, YOSYS_OF_PIP,
};
use crate::{SynthesisError, kept};
use std::path::Path;

/// Number of lines of a failed tool's output that are kept.
const LAST_LINES: usize = 12;

/// Runs a tool to its end, or takes its kept answer; what it writes to its standard output.
pub(crate) fn run(
    tool: &Tool,
    folder: &Path,
    arguments: &[&str],
) -> Result<String, SynthesisError> {
    let output = kept::output(tool, folder, arguments, |_| true);
    let output = output.map_err(|_| SynthesisError::Missing(*tool))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if output.status.success() {
        return Ok(text(&output.stdout));
    }
    let text = text(&[output.stdout, output.stderr].concat());
    let lines: Vec<&str> = text.trim().lines().collect();
    let mut message = lines[lines.len().saturating_sub(LAST_LINES)..].join("\n");
    if message.is_empty() {
        message = output.status.to_string();
    }
    Err(SynthesisError::Tool { tool: tool.name, message })
}

/// Runs a script of yosys.
pub(crate) fn yosys(folder: &Path, script: &str) -> Result<String, SynthesisError> {
    run(&YOSYS, folder, &["-q", "-p", script])
}

/// Runs a script of yosys of PyPI, with which all figures of iCE40 are made and proved.
pub(crate) fn yosys_of_pip(folder: &Path, script: &str) -> Result<String, SynthesisError> {
    run(&YOSYS_OF_PIP, folder, &["-q", "-p", script])
}

/// Runs a script of yosys of PyPI; where that is not installed, of the other yosys, with which a
/// design may have up to 2 % more cells.
pub(crate) fn newest_yosys(folder: &Path, script: &str) -> Result<String, SynthesisError> {
    let is_found = which::which_global(YOSYS_OF_PIP.name).is_ok();
    if is_found { yosys_of_pip(folder, script) } else { yosys(folder, script) }
}

pub(crate) fn read(folder: &Path, name: &str) -> Result<String, SynthesisError> {
    let context = || format!("cannot read {name}");
    std::fs::read_to_string(folder.join(name))
        .map_err(|source| SynthesisError::Io { context: context(), source })
}

pub(crate) fn read_bytes(folder: &Path, name: &str) -> Result<Vec<u8>, SynthesisError> {
    let context = || format!("cannot read {name}");
    std::fs::read(folder.join(name))
        .map_err(|source| SynthesisError::Io { context: context(), source })
}

pub(crate) fn write(folder: &Path, name: &str, text: &str) -> Result<(), SynthesisError> {
    let context = || format!("cannot write {name}");
    std::fs::write(folder.join(name), text)
        .map_err(|source| SynthesisError::Io { context: context(), source })
}

/// A temporary directory, which is removed when the value is dropped.
pub(crate) fn folder() -> Result<tempfile::TempDir, SynthesisError> {
    let context = || "cannot make a temporary folder".to_owned();
    tempfile::tempdir().map_err(|source| SynthesisError::Io { context: context(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tool_that_fails_silently_is_reported_with_its_status() {
        let silent = Tool { name: "false", version: None, purpose: "", install: &[] };
        let folder = folder().expect("a folder");
        let error = run(&silent, folder.path(), &[]).expect_err("it fails");
        assert!(error.to_string().contains("exit status: 1"), "{error}");
    }
}

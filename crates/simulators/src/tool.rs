//! The external simulators: whether they are installed, and their output if they fail.

use crate::LevelError;
use carrystep_tools::programs::Tool;
pub(crate) use carrystep_tools::programs::{ICARUS, VERILATOR, VVP};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;

/// Checks that a tool can be started, once for each tool of a process.
pub(crate) fn find(tool: &Tool) -> Result<(), LevelError> {
    static FOUND: Mutex<Vec<&str>> = Mutex::new(Vec::new());
    let is_found = FOUND.lock().is_ok_and(|found| found.contains(&tool.name));
    if is_found {
        return Ok(());
    }
    let started = Command::new(tool.name)
        .args(tool.version)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    started.map_err(|_| LevelError::Missing(*tool))?;
    if let Ok(mut found) = FOUND.lock() {
        found.push(tool.name);
    }
    Ok(())
}

/// Runs a command to its end. If it fails, its output becomes the error.
pub(crate) fn complete(tool: &Tool, command: &mut Command) -> Result<(), LevelError> {
    let output = command.output().map_err(|_| LevelError::Missing(*tool))?;
    if output.status.success() {
        return Ok(());
    }
    let text = [output.stdout, output.stderr].concat();
    Err(LevelError::Tool {
        tool: tool.name,
        message: String::from_utf8_lossy(&text).trim().to_owned(),
    })
}

/// An input or output error, with the operation that failed.
pub(crate) fn io(context: impl Into<String>) -> impl FnOnce(std::io::Error) -> LevelError {
    move |source| LevelError::Io { context: context.into(), source }
}

/// Writes files into a directory.
pub(crate) fn put(folder: &Path, files: &[(&str, &str)]) -> Result<(), LevelError> {
    for (name, text) in files {
        std::fs::write(folder.join(name), text).map_err(io(format!("cannot write {name}")))?;
    }
    Ok(())
}

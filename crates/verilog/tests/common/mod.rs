//! Tools that tests run in folders of their own.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

/// Runs a tool in a folder. Returns whether it succeeded, and its output.
pub fn run(tool: &str, arguments: &[impl AsRef<OsStr>], folder: &Path) -> (bool, String) {
    let output = Command::new(tool).args(arguments).current_dir(folder).output();
    let output = output
        .unwrap_or_else(|_| panic!("{tool} is not installed: `cargo xtask tools` installs it"));
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    (output.status.success(), said.into_owned())
}

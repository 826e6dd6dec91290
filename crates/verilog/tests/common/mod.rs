//! Tools that tests run in folders of their own. What a tool has answered before is not asked again
//! (docs/decisions/0053).

use carrystep_tools::kept;
use carrystep_tools::programs::{ICARUS, SH, VERILATOR, VVP, YOSYS};
use std::path::Path;
use std::process::Command;

/// Runs a tool in a folder, which holds everything that the tool reads. Returns whether it succeeded,
/// and its output.
pub fn run(tool: &str, arguments: &[impl AsRef<str>], folder: &Path) -> (bool, String) {
    let arguments: Vec<&str> = arguments.iter().map(AsRef::as_ref).collect();
    let known = [ICARUS, SH, VVP, VERILATOR, YOSYS].into_iter().find(|known| known.name == tool);
    let output = match known {
        Some(known) => kept::output(&known, folder, &arguments, |_| true),
        None => Command::new(tool).args(arguments).current_dir(folder).output(),
    };
    let output = output
        .unwrap_or_else(|_| panic!("{tool} is not installed: `cargo xtask tools` installs it"));
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    (output.status.success(), said.into_owned())
}

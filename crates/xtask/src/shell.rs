//! Runs other programs in the root of the workspace. By hand, because few functions around
//! [`Command`] do all of it; xshell and duct would bring a language of their own for pipes that no
//! task has.

use crate::pip;
use std::ffi::OsString;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// Result of a task; the error is a sentence that says what failed.
pub type TaskResult = Result<(), String>;

/// The root directory of the workspace.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).unwrap_or(here).to_owned()
}

/// Prints a line to standard error for the user.
pub fn say(line: &str) {
    // If standard error cannot be written, there is nowhere to report it.
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// A command that will run in the root of the workspace.
pub fn command(program: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(root()).env("PATH", path());
    command
}

/// The path on which programs are looked for: the user's, and behind it that of PyPI's tools.
pub fn path() -> OsString {
    let users = std::env::var_os("PATH").unwrap_or_default();
    let all = std::env::split_paths(&users).chain([pip::folder().join("bin")]);
    std::env::join_paths(all).unwrap_or(users)
}

/// Runs a command; its output goes to the terminal.
pub fn run(program: &str, arguments: &[&str]) -> TaskResult {
    run_with(&[], program, arguments)
}

/// As [`run`], with additional environment variables.
pub fn run_with(variables: &[(&str, &str)], program: &str, arguments: &[&str]) -> TaskResult {
    let set: String = variables.iter().map(|(name, value)| format!("{name}={value} ")).collect();
    say(&format!("$ {set}{program} {}", arguments.join(" ")));
    let mut command = command(program, arguments);
    let status = command
        .envs(variables.iter().copied())
        .status()
        .map_err(|error| format!("cannot start {program}: {error}"))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("`{program} {}` failed ({status})", arguments.join(" ")))
    }
}

/// Runs a command whose complaints go to the terminal, and takes what it prints to its standard
/// output.
pub fn read_stdout(program: &str, arguments: &[&str]) -> Result<String, String> {
    let output = command(program, arguments).stderr(Stdio::inherit()).output();
    let output = output.map_err(|error| format!("cannot start {program}: {error}"))?;
    if !output.status.success() {
        return Err(format!("`{program} {}` failed ({})", arguments.join(" "), output.status));
    }
    String::from_utf8(output.stdout)
        .map_err(|_| format!("{program} printed something that is not text"))
}

/// What could not be done with a file, and why.
pub fn cannot(what: &str, path: &Path, error: &std::io::Error) -> String {
    format!("cannot {what} {}: {error}", path.display())
}

/// Runs a command and takes what it prints.
pub fn read(program: &str, arguments: &[&str]) -> Result<String, String> {
    let output = command(program, arguments)
        .output()
        .map_err(|error| format!("cannot start {program}: {error}"))?;
    if !output.status.success() {
        let stderr = String::from_utf8_lossy(&output.stderr);
        return Err(format!(
            "`{program} {}` failed ({}): {stderr}",
            arguments.join(" "),
            output.status
        ));
    }
    String::from_utf8(output.stdout)
        .map_err(|_| format!("{program} printed something that is not text"))
}

/// The built command, where a chore has built it already.
static CARRYSTEP: OnceLock<PathBuf> = OnceLock::new();

/// From now on [`carrystep`] runs this file instead of asking cargo for it.
pub fn use_carrystep(built: &Path) {
    // A second one is the same.
    let _ = CARRYSTEP.set(built.to_owned());
}

/// Runs carrystep and takes what it prints.
pub fn carrystep(arguments: &[&str]) -> Result<String, String> {
    match CARRYSTEP.get() {
        Some(built) => read(&built.to_string_lossy(), arguments),
        None => read("cargo", &[&["run", "--quiet", "--release", "--"], arguments].concat()),
    }
}

/// Whether a program can be started.
pub fn is_there(program: &str) -> bool {
    which::which_in_global(program, Some(path())).is_ok_and(|mut found| found.next().is_some())
}

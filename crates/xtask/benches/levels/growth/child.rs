//! Runs a program as a child process and measures the processor time or the memory that it uses.

use nix::sys::resource::{UsageWho, getrusage};
use nix::sys::time::TimeVal;
use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, Stdio};

#[path = "../../../../cli/tests/support/peak.rs"]
mod peak;

/// Runs a program, discards its standard output, and returns its processor time, user and system,
/// of all its threads, in seconds.
///
/// # Errors
/// The program cannot be started, or ends with a status other than 0.
pub fn seconds<A: AsRef<OsStr>>(program: &Path, arguments: &[A]) -> Result<f64, String> {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null());
    let before = of_children()?;
    let output = command.stderr(Stdio::piped()).output();
    let output = output.map_err(|error| format!("{}: {error}", program.display()))?;
    let seconds = of_children()? - before;
    if output.status.success() {
        Ok(seconds)
    } else {
        let said = String::from_utf8_lossy(&output.stderr);
        Err(format!("{command:?} failed ({}): {}", output.status, said.trim()))
    }
}

/// Runs a program, discards its output, and returns the greatest memory that it used, in bytes; 0
/// where the kernel keeps no record of it.
///
/// # Errors
/// The program cannot be started, or ends with a status other than 0.
pub fn memory<A: AsRef<OsStr>>(program: &Path, arguments: &[A]) -> Result<u64, String> {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let ran = peak::memory(&mut command);
    let (status, most) = ran.map_err(|error| format!("{}: {error}", program.display()))?;
    if status.success() { Ok(most) } else { Err(format!("{command:?}: {status}")) }
}

/// Processor time of all child processes that have ended, seconds. No other child ends during a
/// measurement, because the benchmark runs its programs one after another.
fn of_children() -> Result<f64, String> {
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN).map_err(|error| error.to_string())?;
    let seconds = |time: TimeVal| time.tv_sec() as f64 + time.tv_usec() as f64 * 1e-6;
    Ok(seconds(usage.user_time()) + seconds(usage.system_time()))
}

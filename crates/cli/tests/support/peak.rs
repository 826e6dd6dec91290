//! Runs a program as a child process and reads the greatest memory that it used.
//!
//! The tests of the command and the benchmark both include this file.

use std::io;
use std::process::{Command, ExitStatus};
use std::time::Duration;

/// The time between two looks at the memory of a child.
const BETWEEN: Duration = Duration::from_millis(3);

/// Runs a command to its end. Returns its status and the greatest memory that it used, in bytes:
/// the kernel's own record of the peak, which is read until the program ends. The memory is 0 where
/// the kernel has no such record.
///
/// # Errors
/// The program cannot be started.
pub fn memory(command: &mut Command) -> io::Result<(ExitStatus, u64)> {
    let mut child = command.spawn()?;
    let status = format!("/proc/{}/status", child.id());
    let mut most = 0;
    loop {
        // The record is gone when the process is.
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let peak = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kib = peak.and_then(|peak| peak.trim().strip_suffix(" kB")?.parse::<u64>().ok());
        most = most.max(kib.unwrap_or(0) << 10);
        if let Some(status) = child.try_wait()? {
            return Ok((status, most));
        }
        std::thread::sleep(BETWEEN);
    }
}

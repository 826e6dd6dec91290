//! A serial port of the system, and why it cannot be opened.

use super::{Exchanged, Line};
use serialport::{ErrorKind, SerialPort};
use std::borrow::ToOwned;
use std::boxed::Box;
use std::format;
use std::io;
use std::string::{String, ToString};
use std::time::Duration;
use thiserror::Error;

/// So long a read waits where nothing was sent.
const WAIT: Duration = Duration::from_millis(1);

/// Why a port cannot be opened.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum OpenError {
    /// There is none of this name.
    #[error("there is no serial port {port}: is the board plugged in?{others}")]
    Absent {
        /// The name.
        port: String,
        /// The ports that there are, as a sentence.
        others: String,
    },
    /// Another program has it.
    #[error("serial port {port} is in use by another program: close that first")]
    Busy {
        /// The name.
        port: String,
    },
    /// The system does not allow it.
    #[error(
        "serial port {port} may not be opened by this user: on Linux, add yourself to its group (`sudo usermod -aG dialout $USER`) and log in again"
    )]
    NotPermitted {
        /// The name.
        port: String,
    },
    /// It is a file or a folder.
    #[error("{port} is no serial port.{others}")]
    NoPort {
        /// The name.
        port: String,
        /// The ports that there are, as a sentence.
        others: String,
    },
    /// It is there but cannot be used as a serial port, or be set to this baud rate.
    #[error("serial port {port} cannot be used at {baud} baud: {why}")]
    Unusable {
        /// The name.
        port: String,
        /// The baud rate.
        baud: u32,
        /// What the system says.
        why: String,
    },
}

/// Most of the line's time that bytes may wait in the system, ms: a stop goes out behind them.
const AHEAD_MS: u64 = 20;
/// So many bytes may always wait: more than a frame.
const LEAST_AHEAD: usize = 96;

/// Most bytes that are written at full speed while not one comes back: three windows of the longest frames. A
/// pseudo-terminal that nobody reads holds some 20 000, and may block whoever writes more.
const UNHEARD: usize = 8_192;
/// Beyond that so many bytes are written in each exchange that hears nothing, about a millisecond: a line that comes back is
/// noticed.
const TRICKLE: usize = 4;

/// An open serial port: 8 data bits, no parity, one stop bit, of this program alone. On Unix it is locked twice: by
/// `TIOCEXCL`, which keeps away every program but the administrator's, and by an advisory lock (`flock`) on the
/// device's file, which every carrystep host tries; both hold for all symbolic links to the device.
pub struct SerialLine {
    port: Box<dyn SerialPort>,
    /// Bytes that may wait in the system.
    ahead: usize,
    /// Bytes that were written since the last one came.
    unheard: usize,
}

impl SerialLine {
    /// Opens a port by its name and throws away what has come before.
    ///
    /// # Errors
    /// [`OpenError`] names the cause.
    pub fn open(port: &str, baud: u32) -> Result<Self, OpenError> {
        let opened = serialport::new(port, baud).timeout(WAIT).open().map_err(|error| refusal(port, baud, &error))?;
        // Old answers do no harm, so a port that cannot be emptied is as good.
        let _ = opened.clear(serialport::ClearBuffer::Input);
        Ok(Self { port: opened, ahead: ahead(baud), unheard: 0 })
    }

    /// A port that is open already.
    pub fn from_port(port: Box<dyn SerialPort>) -> Self {
        let ahead = port.baud_rate().map_or(usize::MAX, ahead);
        Self { port, ahead, unheard: 0 }
    }
}

/// Bytes of [`AHEAD_MS`] at this baud rate, ten bits each.
fn ahead(baud: u32) -> usize {
    usize::try_from(u64::from(baud) * AHEAD_MS / 10_000).unwrap_or(usize::MAX).max(LEAST_AHEAD)
}

fn refusal(port: &str, baud: u32, error: &serialport::Error) -> OpenError {
    let name = || port.to_owned();
    let exists = || std::path::Path::new(port).exists();
    match error.kind() {
        _ if is_file(port) => OpenError::NoPort { port: name(), others: others() },
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => OpenError::NotPermitted { port: name() },
        ErrorKind::Io(io::ErrorKind::NotFound) => OpenError::Absent { port: name(), others: others() },
        // What is there and cannot be locked, another has locked.
        ErrorKind::NoDevice if exists() => OpenError::Busy { port: name() },
        ErrorKind::NoDevice => OpenError::Absent { port: name(), others: others() },
        _ => OpenError::Unusable { port: name(), baud, why: error.to_string() },
    }
}

/// Whether this is there and no device.
fn is_file(port: &str) -> bool {
    std::fs::metadata(port).is_ok_and(|there| there.is_file() || there.is_dir())
}

fn others() -> String {
    let ports = serialport::available_ports().unwrap_or_default();
    let mut names = ports.iter().map(|port| port.port_name.as_str());
    match names.next() {
        None => String::new(),
        Some(first) => names.fold(format!(" There is {first}"), |list, name| list + ", " + name) + ".",
    }
}

impl Line for SerialLine {
    type Error = io::Error;

    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> io::Result<Exchanged> {
        // Where the system does not say how much waits, it is trusted.
        let waits = if out.is_empty() { 0 } else { self.port.bytes_to_write().map_or(0, |count| count as usize) };
        let most = self.ahead.saturating_sub(waits).min(UNHEARD.saturating_sub(self.unheard));
        let out = out.get(..most).unwrap_or(out);
        let sent = if out.is_empty() { 0 } else { nothing_yet(self.port.write(out))? };
        self.unheard = self.unheard.saturating_add(sent);
        if sent > 0 && self.port.bytes_to_read()? == 0 {
            return Ok(Exchanged { sent, received: 0 });
        }
        let received = nothing_yet(self.port.read(into))?;
        self.unheard = if received > 0 { 0 } else { self.unheard.saturating_sub(TRICKLE) };
        Ok(Exchanged { sent, received })
    }
}

/// No byte in time is no error.
fn nothing_yet(done: io::Result<usize>) -> io::Result<usize> {
    match done {
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted
            ) =>
        {
            Ok(0)
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_waits_in_the_system_takes_20_ms_of_the_line() {
        assert_eq!([9_600, 115_200, 921_600, 3_000_000].map(ahead), [96, 230, 1843, 6000]);
    }

    /// What a port's driver says of a port that is there, but for the last.
    #[test]
    fn the_cause_of_a_refusal_is_named() {
        let refused = |port: &str, kind| refusal(port, 9600, &serialport::Error::new(kind, "so it is"));
        let denied = ErrorKind::Io(io::ErrorKind::PermissionDenied);
        assert!(matches!(refused("/dev/null", denied), OpenError::NotPermitted { .. }));
        assert!(matches!(refused("/dev/null", ErrorKind::NoDevice), OpenError::Busy { .. }));
        assert!(matches!(refused("/dev/null", ErrorKind::Unknown), OpenError::Unusable { .. }));
        assert!(matches!(refused("/dev/no-such-port", ErrorKind::NoDevice), OpenError::Absent { .. }));
        assert!(matches!(refused("/dev", denied), OpenError::NoPort { .. }));
    }
}

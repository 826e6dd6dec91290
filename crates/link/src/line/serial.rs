//! A serial port of the operating system, and the reasons why it cannot be opened.

use super::{Exchanged, Line};
use serialport::{ErrorKind, SerialPort};
use std::borrow::ToOwned;
use std::boxed::Box;
use std::format;
use std::io;
use std::string::{String, ToString};
use std::time::Duration;
use thiserror::Error;

/// Time for which a read waits if nothing was sent.
const WAIT: Duration = Duration::from_millis(1);

/// Why a port cannot be opened.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum OpenError {
    /// No port has this name.
    #[error("there is no serial port {port}: is the board plugged in?{others}")]
    Absent {
        /// Name of the port.
        port: String,
        /// The ports that exist, as a sentence.
        others: String,
    },
    /// Another program uses the port.
    #[error("serial port {port} is in use by another program: close that first")]
    Busy {
        /// Name of the port.
        port: String,
    },
    /// The operating system denies access.
    #[error(
        "serial port {port} may not be opened by this user: on Linux, add yourself to its group (`sudo usermod -aG dialout $USER`) and log in again"
    )]
    NotPermitted {
        /// Name of the port.
        port: String,
    },
    /// The name belongs to a file or a directory.
    #[error("{port} is no serial port.{others}")]
    NoPort {
        /// Name of the port.
        port: String,
        /// The ports that exist, as a sentence.
        others: String,
    },
    /// The device exists but is not a serial port, or does not support this baud rate.
    #[error("serial port {port} cannot be used at {baud} baud: {why}")]
    Unusable {
        /// Name of the port.
        port: String,
        /// Baud rate, bits per second.
        baud: u32,
        /// Message of the operating system.
        why: String,
    },
}

/// Greatest transmission time of the bytes that may wait in the system's buffer, ms. A stop is sent
/// behind them.
const AHEAD_MS: u64 = 20;
/// Number of bytes that may wait in any case; it is more than a frame.
const LEAST_AHEAD: usize = 96;

/// Greatest number of bytes written at full speed while no byte is received: three windows of the
/// longest frames. A pseudo-terminal that nobody reads holds about 20 000 bytes, and may block a
/// program that writes more.
const UNHEARD: usize = 8_192;
/// Number of bytes written per exchange (about a millisecond) beyond [`UNHEARD`] while no byte is
/// received, so that a line that works again is noticed.
const TRICKLE: usize = 4;

/// An open serial port: 8 data bits, no parity, one stop bit, used by this program alone. On Unix
/// it is locked in two ways: by `TIOCEXCL`, which excludes every program except those of the
/// administrator, and by an advisory lock (`flock`) on the device file, which every carrystep host
/// tries to take. Both apply to all symbolic links to the device.
pub struct SerialLine {
    port: Box<dyn SerialPort>,
    /// Number of bytes that may wait in the system's buffer.
    ahead: usize,
    /// Number of bytes written since the last one was received.
    unheard: usize,
}

impl SerialLine {
    /// Opens a port at a baud rate in bits per second, and discards the bytes received earlier.
    ///
    /// # Errors
    /// [`OpenError`] gives the cause.
    pub fn open(port: &str, baud: u32) -> Result<Self, OpenError> {
        let opened = serialport::new(port, baud)
            .timeout(WAIT)
            .open()
            .map_err(|error| refusal(port, baud, &error))?;
        // Old answers are harmless, so an error of this call is ignored.
        let _ = opened.clear(serialport::ClearBuffer::Input);
        Ok(Self { port: opened, ahead: ahead(baud), unheard: 0 })
    }

    /// Uses a port that is open already.
    pub fn from_port(port: Box<dyn SerialPort>) -> Self {
        let ahead = port.baud_rate().map_or(usize::MAX, ahead);
        Self { port, ahead, unheard: 0 }
    }
}

/// Number of bytes that take [`AHEAD_MS`] at this baud rate, with ten bits per byte.
fn ahead(baud: u32) -> usize {
    usize::try_from(u64::from(baud) * AHEAD_MS / 10_000).unwrap_or(usize::MAX).max(LEAST_AHEAD)
}

fn refusal(port: &str, baud: u32, error: &serialport::Error) -> OpenError {
    let name = || port.to_owned();
    let exists = || std::path::Path::new(port).exists();
    match error.kind() {
        _ if is_file(port) => OpenError::NoPort { port: name(), others: others() },
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => OpenError::NotPermitted { port: name() },
        ErrorKind::Io(io::ErrorKind::NotFound) => {
            OpenError::Absent { port: name(), others: others() }
        }
        // A device that exists and cannot be locked is locked by another program.
        ErrorKind::NoDevice if exists() => OpenError::Busy { port: name() },
        ErrorKind::NoDevice => OpenError::Absent { port: name(), others: others() },
        _ => OpenError::Unusable { port: name(), baud, why: error.to_string() },
    }
}

/// Whether this exists and is not a device.
fn is_file(port: &str) -> bool {
    std::fs::metadata(port).is_ok_and(|there| there.is_file() || there.is_dir())
}

fn others() -> String {
    let ports = serialport::available_ports().unwrap_or_default();
    let mut names = ports.iter().map(|port| port.port_name.as_str());
    match names.next() {
        None => String::new(),
        Some(first) => {
            names.fold(format!(" There is {first}"), |list, name| list + ", " + name) + "."
        }
    }
}

impl Line for SerialLine {
    type Error = io::Error;

    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> io::Result<Exchanged> {
        // If the system does not report how many bytes wait, none are assumed.
        let waits = if out.is_empty() {
            0
        } else {
            self.port.bytes_to_write().map_or(0, |count| count as usize)
        };
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

/// Converts a timeout to 0 bytes.
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
    fn bytes_in_the_system_buffer_take_20_ms_of_the_line() {
        assert_eq!([9_600, 115_200, 921_600, 3_000_000].map(ahead), [96, 230, 1843, 6000]);
    }

    /// The errors of the operating system for a port that exists, except in the last row.
    #[test]
    fn open_error_names_the_cause() {
        let refused =
            |port: &str, kind| refusal(port, 9600, &serialport::Error::new(kind, "so it is"));
        let denied = ErrorKind::Io(io::ErrorKind::PermissionDenied);
        assert!(matches!(refused("/dev/null", denied), OpenError::NotPermitted { .. }));
        assert!(matches!(refused("/dev/null", ErrorKind::NoDevice), OpenError::Busy { .. }));
        assert!(matches!(refused("/dev/null", ErrorKind::Unknown), OpenError::Unusable { .. }));
        assert!(matches!(
            refused("/dev/no-such-port", ErrorKind::NoDevice),
            OpenError::Absent { .. }
        ));
        assert!(matches!(refused("/dev", denied), OpenError::NoPort { .. }));
    }
}

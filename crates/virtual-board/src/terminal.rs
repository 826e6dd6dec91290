//! The board's end of a pseudo-terminal, which a host opens as a serial port.

use serialport::{SerialPort as _, TTYPort};
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::time::Duration;

/// Greatest number of bytes read from the host at once, as many as a USB bridge would buffer.
const BYTES: usize = 512;

/// Time for which bytes to a host that reads none are kept waiting.
const PATIENCE: Duration = Duration::from_millis(1);

/// A pseudo-terminal whose other end any host may open, one after the other.
#[derive(Debug)]
pub struct Terminal {
    port: TTYPort,
    name: String,
}

impl Terminal {
    /// Creates a pseudo-terminal.
    ///
    /// # Errors
    /// The system has no more of them.
    pub fn new() -> io::Result<Self> {
        let (mut port, other) = TTYPort::pair()?;
        let name =
            other.name().ok_or_else(|| io::Error::other("the pseudo-terminal has no name"))?;
        port.set_timeout(PATIENCE)?;
        Ok(Self { port, name })
    }

    /// The device name that the host opens.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether a host has the other end open. If it has, waits for bytes from it, but not longer
    /// than this time.
    pub fn is_open(&mut self, wait: Duration) -> bool {
        // Neither fails: a field is set.
        let _ = self.port.set_timeout(wait);
        let looked = self.port.read(&mut []);
        let _ = self.port.set_timeout(PATIENCE);
        !matches!(looked, Err(error) if error.kind() == ErrorKind::BrokenPipe)
    }

    /// The bytes that the host has sent, if any. Does not wait.
    pub fn take(&mut self) -> Vec<u8> {
        let mut bytes = vec![0; BYTES];
        // While no host has the other end open, no bytes arrive.
        let there = self.port.bytes_to_read().unwrap_or(0);
        let come = if there == 0 { 0 } else { self.port.read(&mut bytes).unwrap_or(0) };
        bytes.truncate(come);
        bytes
    }

    /// Sends bytes to the host. They are lost if no host reads them, as on a real line.
    ///
    /// # Errors
    /// The terminal has failed.
    pub fn give(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self.port.write_all(bytes) {
            Err(error)
                // While no host has the other end open, the pipe is broken. This is not an error: a
                // killed host may be followed by another.
                if !matches!(
                    error.kind(),
                    ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::WriteZero | ErrorKind::BrokenPipe
                ) =>
            {
                Err(error)
            }
            _ => Ok(()),
        }
    }
}

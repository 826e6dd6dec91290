//! The board's end of a pseudo-terminal: what a host opens as a serial port.

use serialport::{SerialPort as _, TTYPort};
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::time::Duration;

/// Most bytes that are taken from the host at once: what a bridge would keep.
const BYTES: usize = 512;

/// A pseudo-terminal whose other end anyone may open, one after the other.
#[derive(Debug)]
pub struct Terminal {
    port: TTYPort,
    name: String,
}

impl Terminal {
    /// A new one.
    ///
    /// # Errors
    /// The system has no more of them.
    pub fn new() -> io::Result<Self> {
        let (mut port, other) = TTYPort::pair()?;
        let name = other.name().ok_or_else(|| io::Error::other("the pseudo-terminal has no name"))?;
        port.set_timeout(Duration::from_millis(1))?;
        Ok(Self { port, name })
    }

    /// What the host opens.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Bytes that the host has sent, if any; does not wait.
    pub fn take(&mut self) -> Vec<u8> {
        let mut bytes = vec![0; BYTES];
        // Where nobody has the other end open, nothing comes.
        let there = self.port.bytes_to_read().unwrap_or(0);
        let come = if there == 0 { 0 } else { self.port.read(&mut bytes).unwrap_or(0) };
        bytes.truncate(come);
        bytes
    }

    /// Gives the host bytes; what nobody takes is lost, as on a line that nobody listens to.
    ///
    /// # Errors
    /// The terminal is gone.
    pub fn give(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self.port.write_all(bytes) {
            Err(error)
                // The pipe is broken for as long as no host has the other end open: one was killed, and another comes.
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

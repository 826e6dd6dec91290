//! A pseudo-terminal that senders open as a serial port, one after the other.
//!
//! While no sender has it open, a read fails; so the command knows when one has come and gone. The
//! system forgets the settings of the terminal when the last one closes it, and they are set again
//! then: without them it would echo what is written, and the command would read it as lines.

use rustix::fs::{Mode, OFlags, fcntl_setfl};
use rustix::io::Errno;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use std::fs::File;
use std::io::{self, ErrorKind, Read as _, Write as _};

/// The command's end of a pseudo-terminal.
#[derive(Debug)]
pub struct Pty {
    file: File,
    name: String,
    is_open: bool,
}

impl Pty {
    /// Creates a pseudo-terminal.
    ///
    /// # Errors
    /// The system has no more of them.
    pub fn new() -> io::Result<Self> {
        let file = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY)?;
        grantpt(&file)?;
        unlockpt(&file)?;
        let name = ptsname(&file, Vec::new())?.into_string();
        let name = name.map_err(|_| io::Error::other("the pseudo-terminal has no name"))?;
        // Only after somebody has closed it, the system says that nobody has it open.
        drop(rustix::fs::open(&*name, OFlags::RDWR | OFlags::NOCTTY, Mode::empty())?);
        fcntl_setfl(&file, OFlags::NONBLOCK)?;
        let this = Self { file: file.into(), name, is_open: false };
        this.set_raw()?;
        Ok(this)
    }

    /// The device that senders open.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether a sender has it open, as far as the last read has shown.
    pub const fn is_open(&self) -> bool {
        self.is_open
    }

    fn set_raw(&self) -> io::Result<()> {
        let mut settings = tcgetattr(&self.file)?;
        settings.make_raw();
        Ok(tcsetattr(&self.file, OptionalActions::Now, &settings)?)
    }

    /// Reads what has come, if anything. `None` if no sender has it open.
    ///
    /// # Errors
    /// The terminal has failed.
    pub fn read(&mut self, to: &mut [u8]) -> io::Result<Option<usize>> {
        let read = match self.file.read(to) {
            Ok(0) => None,
            Ok(count) => Some(count),
            Err(error) if error.kind() == ErrorKind::WouldBlock => Some(0),
            Err(error) if error.kind() == ErrorKind::Interrupted => Some(0),
            Err(error) if Errno::from_io_error(&error) == Some(Errno::IO) => None,
            Err(error) => return Err(error),
        };
        if std::mem::replace(&mut self.is_open, read.is_some()) != self.is_open {
            self.set_raw()?;
        }
        Ok(read)
    }

    /// Writes as much as there is room for; 0 if no sender has it open.
    ///
    /// # Errors
    /// The terminal has failed.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.file.write(bytes) {
            Err(error) if error.kind() == ErrorKind::WouldBlock => Ok(0),
            Err(error) if error.kind() == ErrorKind::Interrupted => Ok(0),
            Err(error) if Errno::from_io_error(&error) == Some(Errno::IO) => Ok(0),
            other => other,
        }
    }
}

//! The control on systems without local sockets. The serial port's own lock prevents a second
//! command; `stop` cannot reach the first one.

use super::{Holder, SocketRequest};
use carrystep_link::BuildFacts;
use std::io;
use std::time::Duration;

/// A port that this command holds; the serial port itself is the lock.
pub struct PortClaim {
    holder: Holder,
}

/// Always succeeds: opening the port shows whether it is free.
///
/// # Errors
/// None.
pub fn claim(_: &str, baud: u32, command: &'static str, _: bool) -> io::Result<Option<PortClaim>> {
    let holder = Holder {
        pid: std::process::id(),
        command: command.to_owned(),
        baud,
        listens: false,
        watchdog: None,
    };
    Ok(Some(PortClaim { holder }))
}

impl PortClaim {
    /// This command.
    pub const fn holder(&self) -> &Holder {
        &self.holder
    }

    /// Nothing is to be marked.
    ///
    /// # Errors
    /// None.
    pub fn end_mark(&self) -> io::Result<EndMark> {
        Ok(EndMark)
    }

    pub(super) fn listen(&self) -> io::Result<Option<ControlSocket>> {
        Ok(None)
    }

    pub(super) fn connected(&mut self, facts: &BuildFacts) {
        self.holder.watchdog = Some((facts.watchdog_ticks, facts.tick_ns));
    }
}

/// A mark that nobody reads.
pub struct EndMark;

impl EndMark {
    /// Does nothing.
    pub fn set(&mut self) {}
}

/// Always `None`: the holder of a port is unknown.
pub fn holder(_: &str) -> Option<Holder> {
    None
}

/// A type without values: there is no socket.
pub enum ControlSocket {}

impl ControlSocket {
    /// Never called.
    pub fn poll(&mut self, _: &mut dyn FnMut(SocketRequest, &str) -> String) -> bool {
        match *self {}
    }
}

/// A placeholder: there are no callers.
pub struct Caller {
    /// The command that was called.
    pub holder: Holder,
}

/// The result of a request.
pub enum Reply {
    /// The answer.
    Line(String),
    /// The command has ended.
    Ended,
    /// No answer came.
    Silent,
}

/// Always `None`: no command can be reached.
pub fn call(_: &str) -> Option<Caller> {
    None
}

impl Caller {
    /// Never called.
    pub fn ask(&mut self, _: SocketRequest, _: Duration) -> Reply {
        Reply::Ended
    }

    /// Never called.
    pub fn ask_with(&mut self, _: SocketRequest, _: &str, _: Duration) -> Reply {
        Reply::Ended
    }

    /// Never called.
    pub fn ends(&mut self, _: Duration) -> bool {
        true
    }
}

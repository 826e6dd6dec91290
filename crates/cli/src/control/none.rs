//! Where there are no local sockets: the serial port's own lock keeps a second command away, and `stop` cannot reach
//! the first one.

use super::{Holder, Request};
use carrystep_link::Facts;
use std::io;
use std::time::Duration;

/// A port that this command holds; the serial port itself is the lock.
pub struct Claim {
    holder: Holder,
}

/// Claims nothing: whether the port is free shows when it is opened.
///
/// # Errors
/// None.
pub fn claim(_: &str, baud: u32, command: &'static str, _: bool) -> io::Result<Option<Claim>> {
    let holder = Holder { pid: std::process::id(), command: command.to_owned(), baud, listens: false, watchdog: None };
    Ok(Some(Claim { holder }))
}

impl Claim {
    /// Who this is.
    pub const fn holder(&self) -> &Holder {
        &self.holder
    }

    pub(super) fn listen(&self) -> io::Result<Option<Door>> {
        Ok(None)
    }

    pub(super) fn connected(&mut self, facts: &Facts) {
        self.holder.watchdog = Some((facts.watchdog_ticks, facts.tick_ns));
    }
}

/// Nobody knows who holds a port.
pub fn holder(_: &str) -> Option<Holder> {
    None
}

/// There is none.
pub enum Door {}

impl Door {
    /// Never called.
    pub fn poll(&mut self, _: &mut dyn FnMut(Request) -> String) -> bool {
        match *self {}
    }
}

/// There is none.
pub struct Caller {
    /// Who was called.
    pub holder: Holder,
}

/// What became of a request.
pub enum Reply {
    /// This was answered.
    Line(String),
    /// The command has ended.
    Ended,
    /// Nothing was answered.
    Silent,
}

/// Nobody can be called.
pub fn call(_: &str) -> Option<Caller> {
    None
}

impl Caller {
    /// Never called.
    pub fn ask(&mut self, _: Request, _: Duration) -> Reply {
        Reply::Ended
    }

    /// Never called.
    pub fn ends(&mut self, _: Duration) -> bool {
        true
    }
}

//! One carrystep command at a time drives a board, and the others reach it: `run`, `jog` and `home` listen on a local
//! socket while they hold the port, and `carrystep stop` and `status` talk to them through it.
//!
//! ```text
//! claim    a lock file for each device, by its number: who holds the port
//! door     the socket of the command that drives, looked at once for each exchange with the board
//! caller   the other end: `stop` and `status`
//! folder   where both files are: a folder of this user alone
//! ```
//!
//! Systems other than Unix have the claim's type but neither files nor socket.
#![cfg_attr(not(unix), allow(dead_code, reason = "nobody can be called there"))]

#[cfg(unix)]
mod caller;
#[cfg(unix)]
mod claim;
#[cfg(unix)]
mod door;
#[cfg(unix)]
mod folder;
#[cfg(not(unix))]
mod none;

#[cfg(unix)]
pub use caller::{Caller, Reply, call};
#[cfg(unix)]
pub use claim::{Claim, claim, holder};
#[cfg(unix)]
use door::Door;
#[cfg(not(unix))]
pub use none::{Caller, Claim, Door, Reply, call, claim, holder};

use crate::found::{Found, Known};
use crate::interrupt;
use carrystep_link::{Facts, Status, Wish};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::atomic::Ordering;

/// The command that holds a port, as its lock file says.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
pub struct Holder {
    /// Its process.
    pub pid: u32,
    /// Its subcommand: `run`, `jog`, `home`, `status`, `stop`.
    pub command: String,
    /// The baud rate that it speaks.
    pub baud: u32,
    /// Whether it listens on its socket.
    pub listens: bool,
    /// Ticks of the board's watchdog and the tick's length in ns, as the board said when this command connected;
    /// nothing before that.
    pub watchdog: Option<(u32, u32)>,
}

impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`carrystep {}` (process {})", self.command, self.pid)
    }
}

/// What is asked through the socket; each is a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Request {
    /// What the board does.
    Status,
    /// Stop the axes by their ramps, and end.
    Stop,
}

impl Request {
    /// The line that asks for it, without its end.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Status => "status",
            Self::Stop => "stop",
        }
    }
}

/// Who has stopped a command that drives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum StoppedBy {
    /// Ctrl-C, or a signal that ends programs.
    Interrupt,
    /// `carrystep stop` in another terminal.
    Stop,
}

/// The hold on a port, and for a command that drives the ear for those who want it stopped.
pub struct Control {
    // Fields are dropped in this order: the socket goes before the claim ends.
    door: Option<Door>,
    claim: Claim,
    known: Option<Known>,
    stopped_by: Option<StoppedBy>,
}

impl Control {
    /// A claimed port; `drives`: it listens from now on.
    ///
    /// # Errors
    /// The system refuses a socket.
    pub fn new(claim: Claim, drives: bool) -> std::io::Result<Self> {
        let door = if drives { claim.listen()? } else { None };
        Ok(Self { door, claim, known: None, stopped_by: None })
    }

    /// The board has said what it is; from now on `status` is answered, and `stop` knows the watchdog.
    pub fn connected(&mut self, facts: &Facts, known: Known) {
        self.claim.connected(facts);
        self.known = Some(known);
    }

    /// What they wish who can stop this command: Ctrl-C, and `carrystep stop` through the socket. Call it after every
    /// exchange with the board (`watch` of [`Host::stream`](carrystep_link::Host::stream) is such a place), and
    /// before a new move begins. Requests for the status are answered on the way.
    pub fn wish(&mut self, status: &Status) -> Wish {
        if interrupt::watch().load(Ordering::Relaxed) {
            self.stopped_by.get_or_insert(StoppedBy::Interrupt);
        }
        if let Some(door) = &mut self.door {
            let (known, holder) = (&self.known, self.claim.holder());
            let stop = door.poll(&mut |request| match request {
                Request::Stop => "taken".to_owned(),
                Request::Status => known.as_ref().map_or_else(String::new, |known| {
                    let found = Found { held_by: Some(holder.clone()), ..Found::new(status, known, None) };
                    serde_json::to_string(&found).unwrap_or_default()
                }),
            });
            if stop {
                self.stopped_by.get_or_insert(StoppedBy::Stop);
            }
        }
        if self.stopped_by.is_some() { Wish::Stop } else { Wish::GoOn }
    }

    /// Who has asked this command to stop; nothing where nobody has.
    pub const fn stopped_by(&self) -> Option<StoppedBy> {
        self.stopped_by
    }
}

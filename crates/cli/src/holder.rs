//! The command that holds the port of a board.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The command that holds a port, as its lock file says.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
pub struct Holder {
    /// Its process id.
    pub pid: u32,
    /// Its subcommand: `run`, `serve`, `jog`, `probe`, `home`, `offset`, `status`, `stop`.
    pub command: String,
    /// Its baud rate.
    pub baud: u32,
    /// Whether it listens on its socket.
    pub listens: bool,
    /// Ticks of the board's watchdog and the tick in ns, as the board reported them when this
    /// command connected; `None` before that.
    pub watchdog: Option<(u32, u32)>,
}

impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`carrystep {}` (process {})", self.command, self.pid)
    }
}

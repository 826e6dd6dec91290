//! Why a session does not take a write, and why it ends.

use crate::command::ProgramError;
use crate::frame::Answer;
use crate::window::Full;
use thiserror::Error;

/// Why a write was not accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum WriteError {
    /// There is no room.
    #[error(transparent)]
    Full(#[from] Full),
    /// This host owns no session.
    #[error("this host has not opened a session with the gateware: open one before you write")]
    NoSession,
    /// The write is a START, and the drivers have no power.
    #[error(transparent)]
    NoPower(ProgramError),
}

/// Error: the gateware does not keep the number of this host's session any more. Another host has
/// opened one since, or the gateware was restarted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "another host has taken the gateware, or it was restarted: end one of the two hosts; then \
     stop, clear and begin again"
)]
pub struct SessionLost {
    /// The answer that says so.
    pub answer: Answer,
}

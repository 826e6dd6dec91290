//! Makes sure that one carrystep command at a time drives a board, and lets other commands reach
//! that one: `run`, `jog`, `probe` and `home` listen on a local socket while they hold the port,
//! and `carrystep stop`, `hold`, `resume`, `override` and `status` talk to them through it.
//!
//! ```text
//! claim    a lock file per device, named after its number; it contains the holder of the port
//! control_socket the socket of the driving command, polled once per exchange with the board
//! caller   the other end of the socket, for `stop` and `status`
//! folder   the folder of both files, which only this user can access
//! program  what the user wants of a program: hold, go on, end
//! ```
//!
//! On systems other than Unix, the claim is a type without files and without a socket.
#![cfg_attr(not(unix), allow(dead_code, reason = "nobody can be called there"))]

#[cfg(unix)]
mod caller;
#[cfg(unix)]
mod claim;
#[cfg(unix)]
mod control_socket;
#[cfg(unix)]
mod folder;
#[cfg(not(unix))]
mod none;
mod program;

#[cfg(unix)]
pub use caller::{Caller, Reply, call};
#[cfg(unix)]
pub use claim::{EndMark, PortClaim, claim, holder};
#[cfg(unix)]
use control_socket::ControlSocket;
#[cfg(not(unix))]
pub use none::{Caller, ControlSocket, EndMark, PortClaim, Reply, call, claim, holder};

use crate::found::{BlockFound, FoundBoard, Known};
pub use crate::holder::Holder;
use crate::interrupt;
use crate::json;
use carrystep_link::{BuildFacts, Status, Wish};
use carrystep_runner::BlockAt;
pub use program::{OverrideWish, ProgramControl};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::time::Duration;
use strum::{EnumString, IntoStaticStr};

/// How long the driving command may take to answer. It polls its socket every few milliseconds, but
/// a busy computer may delay it.
pub const ANSWER: Duration = Duration::from_secs(2);

/// A request through the socket; each is one line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, EnumString, IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum SocketRequest {
    /// Report the state of the board.
    Status,
    /// Ramp the axes down and end the command.
    Stop,
    /// Bring a program to rest on its path.
    Hold,
    /// Let a program go on that waits.
    Resume,
    /// Change the overrides of a program as the text behind the word says (an [`OverrideWish`]).
    Override,
    /// Do what the text behind the word says (a [`PauseWish`](crate::pause::PauseWish)) while a
    /// program waits.
    Pause,
    /// Tell how that has ended: an empty line while it goes on.
    Result,
}

/// The answer to a request that was noted.
const TAKEN: &str = "taken";
/// The answer to [`SocketRequest::Hold`] if no program moves.
pub const NOTHING_MOVES: &str = "nothing moves";

/// The answer to [`SocketRequest::Resume`] if nothing waits.
pub const NOTHING_WAITS: &str = "nothing waits";

/// The answer to [`SocketRequest::Override`] if no program runs.
pub const NOTHING_RUNS: &str = "nothing runs";

/// The answer to [`SocketRequest::Override`] if it is about a spindle whose speed no output sets.
pub const NO_SPINDLE: &str = "no spindle";

/// The answer to [`SocketRequest::Pause`] and [`SocketRequest::Resume`] if what was wanted in the
/// pause before is not done.
pub const BUSY: &str = "busy";

/// The answer to a request for a program that waits: whether it was noted, if the program waits.
const fn waited(noted: Option<bool>) -> &'static str {
    match noted {
        Some(true) => TAKEN,
        Some(false) => BUSY,
        None => NOTHING_WAITS,
    }
}

impl SocketRequest {
    /// The word that is sent for the request, without the end of the line.
    pub fn word(self) -> &'static str {
        self.into()
    }
}

/// The source of a requested stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum StoppedBy {
    /// Ctrl-C, or a signal that ends programs.
    Interrupt,
    /// `carrystep stop` in another terminal.
    Stop,
}

impl fmt::Display for StoppedBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Interrupt => "Ctrl-C",
            Self::Stop => "`carrystep stop`",
        })
    }
}

/// The claim on a port and, for a command that drives, its socket.
pub struct Control {
    // Fields are dropped in this order: the socket is removed before the claim ends.
    control_socket: Option<ControlSocket>,
    claim: PortClaim,
    known: Option<Known>,
    stopped_by: Option<StoppedBy>,
    program: Option<ProgramControl>,
}

impl Control {
    /// The control of a claimed port. If `drives`, it listens on the socket from now on.
    ///
    /// # Errors
    /// The system refuses to create the socket.
    pub fn new(claim: PortClaim, drives: bool) -> std::io::Result<Self> {
        let control_socket = if drives { claim.listen()? } else { None };
        Ok(Self { control_socket, claim, known: None, stopped_by: None, program: None })
    }

    /// Stores the constants of the connected board. From now on requests for the status are
    /// answered, and the lock file holds the watchdog's time.
    pub fn connected(&mut self, facts: &BuildFacts, known: Known) {
        self.claim.connected(facts);
        self.known = Some(known);
    }

    /// Returns `Wish::Stop` once all axes are to ramp down: after `carrystep stop` through the
    /// socket, after Ctrl-C while moves run, and after the third one while a program moves. The
    /// caller must call it after every exchange with the board (for example in the `watch` of
    /// [`Host::stream`](carrystep_link::Host::stream)) and before a new move begins. It also answers
    /// requests for the status.
    pub fn wish(&mut self, status: &Status) -> Wish {
        let stops = match &self.program {
            Some(program) => program.stops(),
            None => interrupt::is_asked(),
        };
        if stops {
            self.stopped_by.get_or_insert(StoppedBy::Interrupt);
        }
        if let Some(control_socket) = &mut self.control_socket {
            let (known, holder) = (&self.known, self.claim.holder());
            let program = &mut self.program;
            let stop = control_socket.poll(&mut |request, text| match request {
                SocketRequest::Stop => TAKEN.to_owned(),
                SocketRequest::Hold => {
                    let noted = program.as_mut().is_some_and(ProgramControl::hold);
                    if noted { TAKEN } else { NOTHING_MOVES }.to_owned()
                }
                SocketRequest::Resume => {
                    waited(program.as_mut().and_then(ProgramControl::resume)).to_owned()
                }
                SocketRequest::Override => program
                    .as_mut()
                    .map_or_else(|| NOTHING_RUNS.to_owned(), |program| program.overrides_as(text)),
                SocketRequest::Pause => {
                    waited(program.as_mut().and_then(|program| program.pauses(text))).to_owned()
                }
                SocketRequest::Result => {
                    program.as_mut().map(ProgramControl::fetch).unwrap_or_default()
                }
                SocketRequest::Status => known.as_ref().map_or_else(String::new, |known| {
                    let found = FoundBoard {
                        held_by: Some(holder.clone()),
                        waits: program.as_ref().and_then(|program| program.waits.clone()),
                        waits_for_input: program.as_ref().is_some_and(|program| program.reads),
                        block: program.as_ref().and_then(|program| program.block),
                        overrides: program.as_ref().map(|program| program.overrides().into()),
                        ..FoundBoard::new(status, known, None)
                    };
                    json::line(&found).unwrap_or_default()
                }),
            });
            if stop {
                self.stopped_by.get_or_insert(StoppedBy::Stop);
            }
        }
        if self.stopped_by.is_some() { Wish::Stop } else { Wish::GoOn }
    }

    /// From now on a program runs. While it moves, the first signal that ends programs holds it, the
    /// second one ends it at rest, and the third one ramps the axes down. While it rests, a signal
    /// ends it. `spindle` says whether an output sets the speed of a spindle.
    pub fn runs_program(&mut self, spindle: bool) {
        self.program = Some(ProgramControl::new(spindle));
    }

    /// The program begins anew: nothing is held, and there are no overrides.
    pub fn restart_program(&mut self) {
        self.program.iter_mut().for_each(ProgramControl::restart);
    }

    /// Notes the block in which the tool of a program is, until a stop is requested.
    pub fn reached(&mut self, block: Option<BlockAt>) {
        if let Some(program) = &mut self.program
            && let Some(BlockAt { block: number, line }) = block
            && self.stopped_by.is_none()
        {
            program.block = Some(BlockFound { number, line });
        }
    }

    /// Notes that the user has ended the program that runs.
    pub fn ends_program(&mut self) {
        self.stopped_by.get_or_insert(StoppedBy::Interrupt);
    }

    /// The program, if one runs.
    pub const fn program(&mut self) -> Option<&mut ProgramControl> {
        self.program.as_mut()
    }

    /// The source of the stop, or `None` if no stop was requested.
    pub const fn stopped_by(&self) -> Option<StoppedBy> {
        self.stopped_by
    }
}

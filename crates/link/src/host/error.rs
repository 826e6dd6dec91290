//! Errors between a host and a gateware, one variant for each cause.

use crate::command::ProgramError;
use crate::facts::GatewareMismatch;
use crate::registers::CAUSES;
use crate::session::SessionLost;
use crate::travel::TooLong;
use core::fmt;
use thiserror::Error;

/// Why the driver could not execute a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum HostError<E> {
    /// The line has failed, for example because it was unplugged.
    #[error("the line to the board is gone")]
    Line(E),
    /// No byte was received.
    #[error(
        "nothing has answered for {ms} ms: is the board powered, flashed with the gateware, and is this its port and baud rate?"
    )]
    Silence {
        /// Length of the silence, ms.
        ms: u32,
    },
    /// Bytes were received, but no valid frame.
    #[error(
        "something answers ({bytes} bytes), but not in this protocol: another device, or another baud rate"
    )]
    Noise {
        /// Number of bytes.
        bytes: u32,
    },
    /// The board answered earlier, but not any more.
    #[error(
        "the line to the board is dead: it has answered until now, and nothing that could be understood has come for {ms} ms ({}); look at its cable and power",
        Bytes(*bytes)
    )]
    Lost {
        /// Length of the silence, ms.
        ms: u32,
        /// Number of bytes received meanwhile that belong to no valid frame.
        bytes: u32,
    },
    /// The gateware is not the one that this driver was made for.
    #[error(transparent)]
    Refused(#[from] GatewareMismatch),
    /// The gateware does not keep this host's session any more.
    #[error(transparent)]
    SessionLost(#[from] SessionLost),
    /// The gateware was restarted: it has lost this host's session, and the drivers their power.
    #[error(
        "the gateware was restarted, so the drivers have no power and position and queues are lost: connect again, and home"
    )]
    Restarted,
    /// A write before a session was opened.
    #[error("this host has not opened a session with the gateware: open one before you write")]
    NoSession,
    /// The build does not have a latch with this number.
    #[error("the gateware has no latch {latch}")]
    NoLatch {
        /// Number of the latch, from 0.
        latch: u8,
    },
    /// The gateware opens no session, because it is busy.
    #[error(
        "axes move or segments wait, of another host, for longer than {ms} ms: wait for its end, or stop them (`carrystep stop`)"
    )]
    Occupied {
        /// Time waited, ms.
        ms: u32,
    },
    /// A program was given while the machine is not at rest.
    #[error("the machine moves, or segments wait in its queues: stop and clear it first")]
    NotIdle,
    /// The program cannot be sent.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// A stop came into force.
    #[error("the machine has stopped: {}{}; clear resumes", CAUSES.get(usize::from(*cause)).unwrap_or(&"?"), Axes(", from", *culprits))]
    Fault {
        /// The stop cause: an index of [`CAUSES`].
        cause: u8,
        /// Mask of the axes that caused it.
        culprits: u8,
    },
    /// A clear was requested while the e-stop is pressed.
    #[error("the e-stop is still pressed, so nothing can be cleared: release it")]
    StillPressed,
    /// An expected state was not reached in time.
    #[error("{what} has not come in {ms} ms{}{}", if cause.is_some() { "; the machine stands because of: " } else { "" }, cause.unwrap_or(""))]
    TooLong {
        /// Name of the state.
        what: &'static str,
        /// Name of the stop cause, if a stop is in force.
        cause: Option<&'static str>,
        /// Time waited, ms.
        ms: u32,
    },
    /// Homing ended with an error.
    #[error("homing{}: {why}", Axes(" of", *axes))]
    Homing {
        /// Mask of the axes.
        axes: u8,
        /// The error.
        why: HomingFault,
    },
}

/// Why homing failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum HomingFault {
    /// The axis met no limit within its greatest distance of search.
    #[error("no limit was met within max_travel")]
    NotFound,
    /// A limit closed while the axis moved away from its switch.
    #[error("a limit closed while the axis moved away from its switch")]
    Closed,
    /// The switch did not open when the axis moved away from it by `move_off`.
    #[error("the limit is still closed after moving off")]
    StillClosed,
    /// The slow approach did not meet the limit that the search had met.
    #[error("the slow approach did not find the limit again")]
    NotAgain,
    /// A motor has moved further than the other motors of its letter, by more than it may.
    #[error("a motor moved too far alone")]
    Apart,
    /// A move needs too many ticks.
    #[error(transparent)]
    TooLong(TooLong),
}

/// Displays a number of bytes in words.
struct Bytes(u32);

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            0 => f.write_str("not a byte"),
            count => write!(f, "{count} bytes, of no frame"),
        }
    }
}

/// Displays a word and the numbers of the axes of a mask; displays nothing for an empty mask.
struct Axes(&'static str, u8);

impl fmt::Display for Axes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(word, mask) = self;
        let mut before = word;
        for axis in (0..8).filter(|axis| mask >> axis & 1 == 1) {
            write!(f, "{before} axis {axis}")?;
            before = &" and";
        }
        Ok(())
    }
}

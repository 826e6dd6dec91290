//! What goes wrong between a host and a gateware, by its cause.

use super::homing::HomingFault;
use crate::command::ProgramError;
use crate::facts::Refusal;
use crate::registers::CAUSES;
use crate::window::{Foreign, OutOfStep};
use core::fmt;
use thiserror::Error;

/// Why the driver could not do what was asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum HostError<E> {
    /// The line itself: unplugged, for one.
    #[error("the line to the board is gone")]
    Line(E),
    /// Not a byte came.
    #[error(
        "nothing has answered for {ms} ms: is the board powered, flashed with the gateware, and is this its port and baud rate?"
    )]
    Silence {
        /// For so long.
        ms: u32,
    },
    /// Bytes came, and no frame.
    #[error("something answers ({bytes} bytes), but not in this protocol: another device, or another baud rate")]
    Noise {
        /// So many.
        bytes: u32,
    },
    /// The board has answered before, and does so no more.
    #[error(
        "the line to the board is dead: it has answered until now, and nothing that could be understood has come for {ms} ms ({}); look at its cable and power",
        Bytes(*bytes)
    )]
    Lost {
        /// For so long.
        ms: u32,
        /// Bytes that came meanwhile, of no frame.
        bytes: u32,
    },
    /// Someone answers whom this driver was not made for.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The gateware lost count.
    #[error(transparent)]
    OutOfStep(#[from] OutOfStep),
    /// Another host is answered on this line.
    #[error(transparent)]
    Foreign(#[from] Foreign),
    /// The drivers' power is gone, and this host has not taken it away.
    #[error(
        "the drivers have lost their power without a stop: the gateware was restarted (position and queue are lost: connect again, and home), or another host has taken the power away"
    )]
    Restarted,
    /// A program for a machine that is not at rest.
    #[error("the machine moves, or another host has left segments in its queues: stop and clear it first")]
    NotIdle,
    /// The program cannot be sent.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// The machine stopped.
    #[error("the machine has stopped: {}{}; clear resumes", CAUSES.get(usize::from(*cause)).unwrap_or(&"?"), Axes(", from", *culprits))]
    Fault {
        /// Why: a place in [`CAUSES`].
        cause: u8,
        /// The axes that it came from, a bit each.
        culprits: u8,
    },
    /// A clear while the e-stop is pressed.
    #[error("the e-stop is still pressed, so nothing can be cleared: release it")]
    StillPressed,
    /// What was waited for did not come.
    #[error("{what} has not come in {ms} ms{}{}", if cause.is_some() { "; the machine stands because of: " } else { "" }, cause.unwrap_or(""))]
    TooLong {
        /// What.
        what: &'static str,
        /// Why the machine stands, where it does.
        cause: Option<&'static str>,
        /// For so long.
        ms: u32,
    },
    /// Homing ended before the axes were at their places.
    #[error("homing{}: {why}", Axes(" of", *axes))]
    Homing {
        /// The axes, a bit each.
        axes: u8,
        /// What was wrong.
        why: HomingFault,
    },
}

/// How many bytes came, in words.
struct Bytes(u32);

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            0 => f.write_str("not a byte"),
            count => write!(f, "{count} bytes, of no frame"),
        }
    }
}

/// Axes by their numbers, a bit each, behind a word; nothing where there are none.
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

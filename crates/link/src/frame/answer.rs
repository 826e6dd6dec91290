//! What the gateware answers: its state, and why it has not executed a request.

use super::{FrameError, axis_of_segment, check, word_at};
use crate::registers::{self as map, ANSWER_BYTES, ANSWER_DATA, AXES_AT, MOST_AXES, WRITE};
use core::fmt;

/// Why the gateware has not executed a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Refusal {
    /// A write before this one was lost.
    Sequence,
    /// The request cannot be executed now.
    Busy,
    /// The request does not belong to the session that owns the gateware.
    Session,
    /// The request names an axis that has hit the source of its seek, and the seek is not ended.
    SeekEnded,
    /// A segment that a CUT names neither waits nor runs any more: nothing was dropped.
    Cut,
    /// A reason that this version does not know, by its number.
    Other(u8),
}

impl Refusal {
    /// The refusal with this number in an answer; `None` for 0.
    pub const fn from_number(number: u8) -> Option<Self> {
        match number {
            0 => None,
            map::REASON_SEQUENCE => Some(Self::Sequence),
            map::REASON_BUSY => Some(Self::Busy),
            map::REASON_SESSION => Some(Self::Session),
            map::REASON_SEEK_ENDED => Some(Self::SeekEnded),
            map::REASON_CUT => Some(Self::Cut),
            other => Some(Self::Other(other)),
        }
    }

    /// Its number in an answer.
    pub const fn number(self) -> u8 {
        match self {
            Self::Sequence => map::REASON_SEQUENCE,
            Self::Busy => map::REASON_BUSY,
            Self::Session => map::REASON_SESSION,
            Self::SeekEnded => map::REASON_SEEK_ENDED,
            Self::Cut => map::REASON_CUT,
            Self::Other(number) => number,
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(map::REASONS.get(usize::from(self.number())).unwrap_or(&"?"))
    }
}

/// The gateware's answer to a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Answer {
    /// Sequence number of the request.
    pub sequence: u8,
    /// Address byte of the request.
    pub address: u8,
    /// Sequence number that the next write must have. All writes before it have been executed.
    pub next: u8,
    /// A stop is in force.
    pub fault: bool,
    /// The last CUT was refused.
    pub cut_refused: bool,
    /// The stop is over: no axis moves any more.
    pub halted: bool,
    /// All axes have finished and no start is armed.
    pub idle: bool,
    /// The gateware accepts starts.
    pub ready: bool,
    /// A start is armed; it waits until all its axes rest.
    pub armed: bool,
    /// The stop cause if `fault` is set: an index of [`registers::CAUSES`](map::CAUSES).
    pub cause: u8,
    /// Number of free queue places of the addressed axis.
    pub free: u8,
    /// Why the request was not executed; `None` if it was.
    pub refusal: Option<Refusal>,
    /// The request was a write.
    pub written: bool,
    /// Mask of the axes that caused the stop.
    pub culprits: u8,
    /// Mask of the axes that wait for the source of their seek.
    pub seeking: u8,
    /// Value of the register that was read; after a write, the position of the addressed axis.
    pub data: u32,
}

impl Answer {
    /// Decodes an answer.
    ///
    /// # Errors
    /// [`FrameError`] if the frame must be ignored.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, FrameError> {
        let bytes: &[u8; ANSWER_BYTES] =
            bytes.try_into().map_err(|_| FrameError::Length(bytes.len()))?;
        check(bytes)?;
        Ok(Self {
            sequence: map::sequence(bytes),
            address: map::address(bytes),
            next: map::next(bytes),
            fault: map::fault(bytes),
            cut_refused: map::cut_refused(bytes),
            halted: map::halted(bytes),
            idle: map::idle(bytes),
            ready: map::ready(bytes),
            armed: map::armed(bytes),
            cause: map::cause(bytes),
            free: map::free(bytes),
            refusal: Refusal::from_number(map::reason(bytes)),
            written: map::written(bytes),
            culprits: map::culprits(bytes),
            seeking: map::seeking(bytes),
            data: word_at(bytes, ANSWER_DATA),
        })
    }

    /// The axis whose state the request addressed: that of a register that was read, or of a
    /// segment. `free` and, after a segment, `data` belong to it.
    pub const fn axis(&self) -> Option<u8> {
        match self.written {
            true => axis_of_segment(self.address),
            false if self.address < AXES_AT => None,
            false => Some(self.address & (MOST_AXES - 1)),
        }
    }

    /// Whether this answers a read of this register.
    pub const fn is_read_of(&self, address: u8) -> bool {
        !self.written && self.address == address
    }

    /// Whether this answers a write of this register.
    pub const fn is_write_of(&self, register: u8) -> bool {
        self.written && self.address == register | WRITE
    }

    /// The name of the stop cause; `None` without a fault.
    pub fn cause_name(&self) -> Option<&'static str> {
        if self.fault { map::CAUSES.get(usize::from(self.cause)).copied() } else { None }
    }
}

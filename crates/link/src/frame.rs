//! Requests and answers, and their conversion to and from the bytes of a frame.

use crate::command::Segment;
use crate::registers::{
    self as map, ANSWER_BYTES, ANSWER_DATA, CRC_BYTES, LONGEST_REQUEST, REQUEST_HEAD, WRITE,
};
use crate::registers::{AXES_AT, MOST_AXES, SEGMENT, SEGMENT_FRAME_WORDS};
use crc::{CRC_32_ISO_HDLC, Crc, Table};
use thiserror::Error;

/// CRC with the small table of 16 words, which suits a microcontroller.
static CRC: Crc<u32, Table<0>> = Crc::<u32, Table<0>>::new(&CRC_32_ISO_HDLC);

/// Why a frame is rejected. A rejected frame has no effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum FrameError {
    /// The frame does not have the length that its address requires.
    #[error("a frame of {0} bytes, which none is")]
    Length(usize),
    /// The frame is damaged.
    #[error("a frame with a wrong CRC")]
    Crc,
    /// This kind of write does not exist at this address.
    #[error("nothing is written at {0:#04x} in this way")]
    Address(u8),
}

/// The operation of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Body {
    /// Reads a register.
    Read {
        /// Address of the register.
        address: u8,
    },
    /// Writes a register.
    Write {
        /// Address of the register, without [`WRITE`].
        address: u8,
        /// The new value.
        word: u32,
    },
    /// Appends a segment to the queue of an axis.
    Segment {
        /// Number of the axis, from 0.
        axis: u8,
        /// The segment; it has at least 1 tick.
        segment: Segment,
    },
}

impl Body {
    /// The address byte of the frame.
    pub const fn address(&self) -> u8 {
        match *self {
            Self::Read { address } => address,
            Self::Write { address, .. } => address | WRITE,
            Self::Segment { axis, .. } => WRITE | of_axis(SEGMENT, axis),
        }
    }
}

/// The address of a register of an axis.
pub const fn of_axis(register: u8, axis: u8) -> u8 {
    register + (axis & (MOST_AXES - 1))
}

/// The axis whose segments are written at this address; `None` for the address of another write.
const fn axis_of_segment(address: u8) -> Option<u8> {
    if address < WRITE | SEGMENT { None } else { Some(address & (MOST_AXES - 1)) }
}

/// A request: an operation with its sequence number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Request {
    /// Sequence number. Writes are numbered consecutively; a read may have any number.
    pub sequence: u8,
    /// The operation.
    pub body: Body,
}

/// The bytes of a request with its CRC, before END and ESC are escaped.
#[derive(Debug, Clone, Copy)]
pub struct RequestBytes {
    bytes: [u8; LONGEST_REQUEST],
    length: usize,
}

impl RequestBytes {
    /// The bytes as a slice.
    pub fn as_slice(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or(&self.bytes)
    }

    fn put(&mut self, bytes: &[u8]) {
        for (place, byte) in self.bytes.iter_mut().skip(self.length).zip(bytes) {
            *place = *byte;
        }
        self.length += bytes.len();
    }
}

impl Request {
    /// The bytes of the request, with its CRC.
    pub fn to_bytes(&self) -> RequestBytes {
        let mut frame = RequestBytes { bytes: [0; LONGEST_REQUEST], length: 0 };
        frame.put(&[self.sequence, self.body.address()]);
        match self.body {
            Body::Read { .. } => {}
            Body::Write { word, .. } => frame.put(&word.to_le_bytes()),
            Body::Segment { segment, .. } => {
                frame.put(&segment.ticks.wrapping_sub(1).to_le_bytes());
                for long in [segment.v, segment.a, segment.j] {
                    frame.put(&long.to_le_bytes());
                }
                frame.put(&u32::from(segment.last).to_le_bytes());
            }
        }
        let crc = CRC.checksum(frame.as_slice());
        frame.put(&crc.to_le_bytes());
        frame
    }

    /// Decodes a request. Simulated boards use this.
    ///
    /// # Errors
    /// [`FrameError`] if the frame must not be answered.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, FrameError> {
        let (&[sequence, address, ..], Some((content, _))) =
            (bytes, bytes.split_last_chunk::<CRC_BYTES>())
        else {
            return Err(FrameError::Length(bytes.len()));
        };
        let words = match address {
            _ if bytes.len() == REQUEST_HEAD + CRC_BYTES => 0,
            0..WRITE => return Err(FrameError::Length(bytes.len())),
            _ if axis_of_segment(address).is_none() => 1,
            _ => SEGMENT_FRAME_WORDS,
        };
        if bytes.len() != REQUEST_HEAD + 4 * words + CRC_BYTES {
            return Err(FrameError::Length(bytes.len()));
        }
        check(bytes)?;
        let word = |index: usize| word_at(content, REQUEST_HEAD + 4 * index);
        let long = |index: usize| {
            (u64::from(word(index + 1)) << 32 | u64::from(word(index))).cast_signed()
        };
        let body = match (words, axis_of_segment(address)) {
            (0, _) => Body::Read { address },
            (1, _) => Body::Write { address: address & !WRITE, word: word(0) },
            (_, Some(axis)) if address == WRITE | of_axis(SEGMENT, axis) => {
                let (v, a, j) = (long(1), long(3), long(5));
                Body::Segment {
                    axis,
                    segment: Segment {
                        ticks: word(0).wrapping_add(1),
                        v,
                        a,
                        j,
                        last: word(7) & 1 == 1,
                    },
                }
            }
            _ => return Err(FrameError::Address(address)),
        };
        Ok(Self { sequence, body })
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
    /// The write of this answer was not executed.
    pub refused: bool,
    /// The request was a write.
    pub written: bool,
    /// Mask of the axes that caused the stop.
    pub culprits: u8,
    /// Mask of the axes that still wait for their limit.
    pub homing: u8,
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
            halted: map::halted(bytes),
            idle: map::idle(bytes),
            ready: map::ready(bytes),
            armed: map::armed(bytes),
            cause: map::cause(bytes),
            free: map::free(bytes),
            refused: map::refused(bytes),
            written: map::written(bytes),
            culprits: map::culprits(bytes),
            homing: map::homing(bytes),
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

    /// The name of the stop cause; `None` without a fault.
    pub fn cause_name(&self) -> Option<&'static str> {
        if self.fault { map::CAUSES.get(usize::from(self.cause)).copied() } else { None }
    }
}

/// Checks that the last four bytes are the CRC of those before them.
fn check(bytes: &[u8]) -> Result<(), FrameError> {
    let (content, crc) =
        bytes.split_last_chunk::<CRC_BYTES>().ok_or(FrameError::Length(bytes.len()))?;
    if CRC.checksum(content) == u32::from_le_bytes(*crc) { Ok(()) } else { Err(FrameError::Crc) }
}

/// The word at a place, low byte first. Bytes beyond the end are 0.
fn word_at(bytes: &[u8], at: usize) -> u32 {
    bytes.get(at..).and_then(<[u8]>::first_chunk).map_or(0, |chunk| u32::from_le_bytes(*chunk))
}

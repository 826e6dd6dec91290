//! Requests and answers, and the bytes that they are between END and END.

use crate::command::Segment;
use crate::registers::{self as map, ANSWER_BYTES, ANSWER_DATA, CRC_BYTES, LONGEST_REQUEST, REQUEST_HEAD, WRITE};
use crate::registers::{AXES_AT, MOST_AXES, PER_AXIS, SEGMENT, SEGMENT_FRAME_WORDS};
use crc::{CRC_32_ISO_HDLC, Crc, Table};
use thiserror::Error;

/// The small table: 16 words, for a microcontroller's sake.
static CRC: Crc<u32, Table<0>> = Crc::<u32, Table<0>>::new(&CRC_32_ISO_HDLC);

/// A frame that changes nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum FrameError {
    /// Not as long as its address asks for.
    #[error("a frame of {0} bytes, which none is")]
    Length(usize),
    /// Damaged.
    #[error("a frame with a wrong CRC")]
    Crc,
    /// Nothing is written at this address in this way.
    #[error("nothing is written at {0:#04x} in this way")]
    Address(u8),
}

/// What is asked of the gateware.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Body {
    /// A register is read.
    Read {
        /// Its address.
        address: u8,
    },
    /// A register is written.
    Write {
        /// Its address, without [`WRITE`].
        address: u8,
        /// Its new value.
        word: u32,
    },
    /// A segment goes into a queue.
    Segment {
        /// The axis, from 0.
        axis: u8,
        /// The segment; its ticks are at least 1.
        segment: Segment,
    },
}

impl Body {
    /// The address byte of its frame.
    pub const fn address(&self) -> u8 {
        match *self {
            Self::Read { address } => address & !WRITE,
            Self::Write { address, .. } => address | WRITE,
            Self::Segment { axis, .. } => WRITE | of_axis(SEGMENT, axis),
        }
    }
}

/// The address of an axis' register.
pub const fn of_axis(register: u8, axis: u8) -> u8 {
    register + PER_AXIS * (axis & (MOST_AXES - 1))
}

/// The axis that an address names.
pub const fn axis_of(address: u8) -> Option<u8> {
    let plain = address & !WRITE;
    if plain < AXES_AT { None } else { Some((plain - AXES_AT) / PER_AXIS) }
}

/// A request: a body with its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Request {
    /// Its number: of writes, one after the other; of reads, any.
    pub sequence: u8,
    /// What is asked.
    pub body: Body,
}

/// The bytes of a request, without END and ESC.
#[derive(Debug, Clone, Copy)]
pub struct RequestBytes {
    bytes: [u8; LONGEST_REQUEST],
    length: usize,
}

impl RequestBytes {
    /// The bytes.
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
    /// Its bytes, CRC included.
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

    /// The request that these bytes are; a board in software reads with this.
    ///
    /// # Errors
    /// [`FrameError`]: the frame is not to be answered.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, FrameError> {
        let (&[sequence, address, ..], Some((content, _))) = (bytes, bytes.split_last_chunk::<CRC_BYTES>()) else {
            return Err(FrameError::Length(bytes.len()));
        };
        let words = match address {
            0..WRITE => 0,
            _ if axis_of(address).is_none() => 1,
            _ => SEGMENT_FRAME_WORDS,
        };
        if bytes.len() != REQUEST_HEAD + 4 * words + CRC_BYTES {
            return Err(FrameError::Length(bytes.len()));
        }
        check(bytes)?;
        let word = |index: usize| word_at(content, REQUEST_HEAD + 4 * index);
        let long = |index: usize| (u64::from(word(index + 1)) << 32 | u64::from(word(index))).cast_signed();
        let body = match (words, axis_of(address)) {
            (0, _) => Body::Read { address },
            (1, _) => Body::Write { address: address & !WRITE, word: word(0) },
            (_, Some(axis)) if address == WRITE | of_axis(SEGMENT, axis) => {
                let (v, a, j) = (long(1), long(3), long(5));
                Body::Segment {
                    axis,
                    segment: Segment { ticks: word(0).wrapping_add(1), v, a, j, last: word(7) & 1 == 1 },
                }
            }
            _ => return Err(FrameError::Address(address)),
        };
        Ok(Self { sequence, body })
    }
}

/// What the gateware says to a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Answer {
    /// The request's number.
    pub sequence: u8,
    /// The request's address byte.
    pub address: u8,
    /// The number that the next write must have: all before it have been executed.
    pub next: u8,
    /// A stop has been called.
    pub fault: bool,
    /// No axis moves any more.
    pub halted: bool,
    /// All axes are done, no start is armed.
    pub idle: bool,
    /// Starts are taken.
    pub ready: bool,
    /// A start waits.
    pub armed: bool,
    /// Why, where there is a fault: a place in [`registers::CAUSES`](map::CAUSES).
    pub cause: u8,
    /// Segments that the addressed axis still takes.
    pub free: u8,
    /// This write was not executed.
    pub refused: bool,
    /// The axes that the fault came from.
    pub culprits: u8,
    /// Axes that still wait for their limit.
    pub homing: u8,
    /// The register, or the position of the axis.
    pub data: u32,
}

impl Answer {
    /// The answer that these bytes are.
    ///
    /// # Errors
    /// [`FrameError`]: it is to be ignored.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, FrameError> {
        let bytes: &[u8; ANSWER_BYTES] = bytes.try_into().map_err(|_| FrameError::Length(bytes.len()))?;
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
            culprits: map::culprits(bytes),
            homing: map::homing(bytes),
            data: word_at(bytes, ANSWER_DATA),
        })
    }

    /// Why there is a fault, in a word; nothing where there is none.
    pub fn cause_name(&self) -> Option<&'static str> {
        if self.fault { map::CAUSES.get(usize::from(self.cause)).copied() } else { None }
    }
}

/// The last four bytes are the CRC of those before them.
fn check(bytes: &[u8]) -> Result<(), FrameError> {
    let (content, crc) = bytes.split_last_chunk::<CRC_BYTES>().ok_or(FrameError::Length(bytes.len()))?;
    if CRC.checksum(content) == u32::from_le_bytes(*crc) { Ok(()) } else { Err(FrameError::Crc) }
}

/// The word at a place, low byte first; 0 beyond the end.
fn word_at(bytes: &[u8], at: usize) -> u32 {
    bytes.get(at..).and_then(<[u8]>::first_chunk).map_or(0, |chunk| u32::from_le_bytes(*chunk))
}

//! Requests and answers, and their conversion to and from the bytes of a frame.

mod answer;

pub use answer::{Answer, Refusal};

use crate::command::{CutSlots, OutputChange, Segment, WideSegment};
use crate::registers::{CRC_BYTES, LONGEST_REQUEST, REQUEST_HEAD, WRITE};
use crate::registers::{
    CUT, MOST_AXES, SEGMENT, SEGMENT_FRAME_WORDS, SEGMENTS, SEGMENTS_AXIS_WORDS,
    SEGMENTS_HEAD_WORDS, SESSION_BYTES,
};
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
        /// What changes at the outputs where it begins; for other axes than axis 0, nothing.
        outputs: OutputChange,
    },
    /// Appends a segment to the queue of each of several axes.
    Segments(WideSegment),
    /// Drops the segments behind the named ones.
    Cut(CutSlots),
}

impl Body {
    /// The address byte of the frame.
    pub const fn address(&self) -> u8 {
        match *self {
            Self::Read { address } => address,
            Self::Write { address, .. } => address | WRITE,
            Self::Segment { axis, .. } => WRITE | of_axis(SEGMENT, axis),
            Self::Segments(_) => WRITE | SEGMENTS,
            Self::Cut(_) => WRITE | CUT,
        }
    }

    /// Number of bytes of the frame with its CRC, before END and ESC are escaped; of a read, that
    /// of an owner.
    pub const fn bytes(&self) -> usize {
        let words = match *self {
            Self::Read { .. } => 0,
            Self::Write { .. } => 1,
            Self::Segment { .. } => SEGMENT_FRAME_WORDS,
            Self::Segments(wide) => {
                SEGMENTS_HEAD_WORDS + SEGMENTS_AXIS_WORDS * wide.mask.count_ones() as usize + 1
            }
            Self::Cut(_) => MOST_AXES as usize,
        };
        REQUEST_HEAD + SESSION_BYTES + 4 * words + CRC_BYTES
    }

    /// Whether this is a write.
    pub const fn writes(&self) -> bool {
        !matches!(self, Self::Read { .. })
    }

    /// The axes to whose queues this appends a segment, one bit each.
    pub const fn axes(&self) -> u8 {
        match *self {
            Self::Segment { axis, .. } => 1 << (axis & (MOST_AXES - 1)),
            Self::Segments(wide) => wide.mask,
            Self::Read { .. } | Self::Write { .. } | Self::Cut(_) => 0,
        }
    }
}

/// The address of a register of an axis.
pub const fn of_axis(register: u8, axis: u8) -> u8 {
    register + (axis & (MOST_AXES - 1))
}

/// The axis whose segments are written at this address; `None` for the address of another write.
const fn axis_of_segment(address: u8) -> Option<u8> {
    match address.checked_sub(WRITE | SEGMENT) {
        Some(axis) if axis < MOST_AXES => Some(axis),
        _ => None,
    }
}

/// A request: an operation with its sequence number and its session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Request {
    /// Sequence number. Writes are numbered consecutively; a read may have any number.
    pub sequence: u8,
    /// Number of the host's session. A read with 0 is free: it belongs to no session.
    pub session: u16,
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

    fn put_cubic(&mut self, cubic: [i64; 3]) {
        cubic.into_iter().for_each(|long| self.put(&long.to_le_bytes()));
    }
}

impl Request {
    /// The bytes of the request, with its CRC.
    pub fn to_bytes(&self) -> RequestBytes {
        let mut frame = RequestBytes { bytes: [0; LONGEST_REQUEST], length: 0 };
        frame.put(&[self.sequence, self.body.address()]);
        if self.session != 0 || self.body.writes() {
            frame.put(&self.session.to_le_bytes());
        }
        match self.body {
            Body::Read { .. } => {}
            Body::Write { word, .. } => frame.put(&word.to_le_bytes()),
            Body::Segment { segment: Segment { ticks, v, a, j, last }, outputs, .. } => {
                frame.put(&ticks.wrapping_sub(1).to_le_bytes());
                frame.put_cubic([v, a, j]);
                frame.put(&(u32::from(last) | outputs.word()).to_le_bytes());
            }
            Body::Segments(wide) => {
                frame.put(&u32::from(wide.mask).to_le_bytes());
                frame.put(&wide.ticks.wrapping_sub(1).to_le_bytes());
                wide.axes().for_each(|(_, cubic)| frame.put_cubic(cubic));
                frame.put(&(u32::from(wide.last) | wide.outputs.word()).to_le_bytes());
            }
            Body::Cut(slots) => {
                slots.words().iter().for_each(|word| frame.put(&word.to_le_bytes()));
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
        let wrong = FrameError::Length(bytes.len());
        let (&[sequence, address, ..], Some((content, _))) =
            (bytes, bytes.split_last_chunk::<CRC_BYTES>())
        else {
            return Err(wrong);
        };
        let content = content.get(REQUEST_HEAD..).ok_or(wrong)?;
        let (session, words) = content.split_at_checked(SESSION_BYTES).unwrap_or((&[], content));
        let word = |index: usize| word_at(words, 4 * index);
        let expected = match address {
            _ if words.is_empty() => 0,
            0..WRITE => return Err(wrong),
            _ if address == WRITE | SEGMENTS => {
                let axes = (word(0) as u8).count_ones() as usize;
                SEGMENTS_HEAD_WORDS + SEGMENTS_AXIS_WORDS * axes + 1
            }
            _ if axis_of_segment(address).is_some() => SEGMENT_FRAME_WORDS,
            _ if address == WRITE | CUT => MOST_AXES.into(),
            _ => 1,
        };
        if words.len() != 4 * expected || matches!(session.len(), 1) {
            return Err(wrong);
        }
        check(bytes)?;
        let cubic = |index: usize| {
            let long = |at| (u64::from(word(at + 1)) << 32 | u64::from(word(at))).cast_signed();
            [long(index), long(index + 2), long(index + 4)]
        };
        let body = match axis_of_segment(address) {
            _ if words.is_empty() => Body::Read { address },
            Some(axis) => {
                let ([v, a, j], ticks) = (cubic(1), word(0).wrapping_add(1));
                let (last, outputs) = (word(7) & 1 == 1, OutputChange::of_word(word(7)));
                Body::Segment { axis, segment: Segment { ticks, v, a, j, last }, outputs }
            }
            None if address == WRITE | SEGMENTS => {
                let mut wide = WideSegment {
                    mask: word(0) as u8,
                    ticks: word(1).wrapping_add(1),
                    last: word(expected - 1) & 1 == 1,
                    outputs: OutputChange::of_word(word(expected - 1)),
                    ..WideSegment::default()
                };
                let mut at = SEGMENTS_HEAD_WORDS;
                for (axis, place) in (0..MOST_AXES).zip(&mut wide.cubics) {
                    if wide.mask >> axis & 1 == 1 {
                        *place = cubic(at);
                        at += SEGMENTS_AXIS_WORDS;
                    }
                }
                Body::Segments(wide)
            }
            None if address == WRITE | CUT => {
                Body::Cut(CutSlots::of_words(core::array::from_fn(word)))
            }
            None if address < WRITE | SEGMENT => {
                Body::Write { address: address & !WRITE, word: word(0) }
            }
            None => return Err(FrameError::Address(address)),
        };
        let session = session.first_chunk().map_or(0, |number| u16::from_le_bytes(*number));
        Ok(Self { sequence, session, body })
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

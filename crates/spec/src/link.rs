//! What the host and the gateware's link must agree on: frames, registers, the build id (docs/protocol.md).
//!
//! ```text
//! line      END, then the frame with END and ESC escaped, then END         RFC 1055
//! request   sequence 1 | address 1 | words, 4 each, low byte first | CRC 4
//! answer    sequence 1 | address 1 | next 1 | state 1 | free 1 | culprits 1 | homing 1 | data 4 | CRC 4
//! ```

mod build_id;
pub mod registers;

pub use build_id::BuildId;

/// Ends a frame, and begins one.
pub const END: u8 = 0xc0;
/// Says that the next byte stands for another.
pub const ESC: u8 = 0xdb;
/// After [`ESC`]: END.
pub const ESC_END: u8 = 0xdc;
/// After [`ESC`]: ESC.
pub const ESC_ESC: u8 = 0xdd;

/// CRC-32 of Ethernet and zlib, reflected: polynomial.
pub const CRC_POLYNOMIAL: u32 = 0xedb8_8320;
/// What its register holds, not yet inverted, after a frame and its CRC.
pub const CRC_RESIDUE: u32 = 0xdebb_20e3;
/// Bytes of a CRC.
pub const CRC_BYTES: usize = 4;

/// Set in an address: the frame writes.
pub const WRITE: u8 = 0x80;
/// Sequence and address.
pub const REQUEST_HEAD: usize = 2;
/// Words of a segment, the commit included.
pub const SEGMENT_FRAME_WORDS: usize = 8;
/// The longest request, without END and ESC.
pub const LONGEST_REQUEST: usize = REQUEST_HEAD + 4 * SEGMENT_FRAME_WORDS + CRC_BYTES;
/// An answer, without END and ESC.
pub const ANSWER_BYTES: usize = 15;

/// Frames by which a repeated one may lie behind the next; so many may be on their way.
pub const WINDOW: u8 = 127;

/// A place in a byte of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Its name, in the documentation and in C.
    pub name: &'static str,
    /// Byte of the answer.
    pub byte: usize,
    /// Lowest bit.
    pub bit: u8,
    /// How many bits.
    pub bits: u8,
    /// What it says.
    pub what: &'static str,
}

const fn field(name: &'static str, byte: usize, bit: u8, bits: u8, what: &'static str) -> Field {
    Field { name, byte, bit, bits, what }
}

/// The answer, byte by byte; data (low byte first) and CRC follow.
pub const ANSWER: [Field; 13] = [
    field("sequence", 0, 0, 8, "the request's sequence number"),
    field("address", 1, 0, 8, "the request's address"),
    field("next", 2, 0, 8, "the sequence number that the next write must have: all before it have been executed"),
    field("fault", 3, 0, 1, "a stop has been called; segments and starts are dropped until a clear"),
    field("halted", 3, 1, 1, "the stop is over: no axis moves any more"),
    field("idle", 3, 2, 1, "all axes are done, and no start is armed"),
    field("ready", 3, 3, 1, "the drivers have had power for long enough: starts are taken"),
    field("armed", 3, 4, 1, "a start waits; another is refused as busy"),
    field("cause", 3, 5, 3, "why, where there is a fault"),
    field("free", 4, 0, 3, "segments that the addressed axis still takes"),
    field("refused", 4, 3, 1, "this write was not executed: out of sequence, or busy"),
    field("culprits", 5, 0, 8, "where there is a fault: the axes that it came from"),
    field("homing", 6, 0, 8, "axes that still wait for their limit"),
];

/// First byte of an answer's data.
pub const ANSWER_DATA: usize = 7;

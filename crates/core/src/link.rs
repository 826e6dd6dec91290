//! The definitions that the host and the gateware's link share: frames, registers and the build id
//! (docs/protocol.md).
//!
//! ```text
//! line      END, then the frame with END and ESC escaped, then END         RFC 1055
//! read      sequence 1 | address 1 | CRC 4                   of the owner: session 2 before the CRC
//! write     sequence 1 | address 1 | session 2 | words, 4 each, low byte first | CRC 4
//! answer    sequence 1 | address 1 | next 1 | flags 1 | free 1 | culprits 1 | homing 1 |
//!           cause and reason 1 | data 4 | CRC 4
//! ```
//!
//! The numbers are lengths in bytes. A change of the register map or of a build parameter changes
//! the build id, so that a driver refuses the gateware that it was not made for.

mod answer;
mod assembler;
mod build_id;
mod facts;
mod line;
mod ports;
pub mod processor;
mod program;
mod refusal;
pub mod registers;
mod uart;

pub use answer::{ANSWER, Field};
pub use assembler::Image;
pub use build_id::BuildId;
pub use facts::facts;
pub use line::LineKind;
pub use ports::{BYTE_PORTS, LinkInputs, LinkOutputs, line_pins, line_ports, link_ports};
pub use program::image;
pub use refusal::{REFUSALS, Refusal};
pub use uart::{BAUD_PERCENT, BaudError, DEFAULT_BAUD, MAX_BIT_CLOCKS, MIN_BIT_CLOCKS, Uart};

use crate::engine::MAX_AXES;

/// A number that both sides of the link use; it is generated into the clients' languages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LinkConstant {
    /// Name of the constant.
    pub name: &'static str,
    /// Its type in Rust: `u8`, `u32` or `usize`.
    pub kind: &'static str,
    /// Its value.
    pub value: u64,
    /// Its meaning.
    pub what: &'static str,
}

/// Declares each constant once, together with its row of the table.
macro_rules! constants {
    ($($name:ident: $kind:ident = $value:expr, $what:literal;)*) => {
        $(#[doc = $what] pub const $name: $kind = $value;)*

        /// The constants above as a table, for the generator.
        pub const CONSTANTS: &[$crate::link::LinkConstant] = &[$($crate::link::LinkConstant {
            name: stringify!($name),
            kind: stringify!($kind),
            value: $name as u64,
            what: $what,
        }),*];
    };
}
pub(crate) use constants;

constants! {
    END: u8 = 0xc0, "Byte that begins and ends a frame.";
    ESC: u8 = 0xdb, "Escape byte: with the next byte it stands for END or ESC in a frame.";
    ESC_END: u8 = 0xdc, "After ESC: the pair stands for END.";
    ESC_ESC: u8 = 0xdd, "After ESC: the pair stands for ESC.";
    CRC_POLYNOMIAL: u32 = 0xedb8_8320, "Polynomial of the CRC-32 of Ethernet and zlib, reflected.";
    CRC_RESIDUE: u32 = 0xdebb_20e3,
        "Value of the CRC register, before its inversion, after a frame and its CRC.";
    CRC_BYTES: usize = 4, "Length of a CRC in bytes.";
    WRITE: u8 = 0x80, "Bit that the address of every write has.";
    REQUEST_HEAD: usize = 2, "Length of the sequence number and the address of a request in bytes.";
    SESSION_BYTES: usize = 2, "Length of the session number in a request in bytes.";
    SEGMENT_FRAME_WORDS: usize = 8, "Number of words of a SEGMENT frame, the commit included.";
    SEGMENTS_HEAD_WORDS: usize = 2,
        "Number of words of a SEGMENTS frame before its axes: the mask, and ticks - 1.";
    SEGMENTS_AXIS_WORDS: usize = 6, "Number of words for each axis of a SEGMENTS frame: V, A, J.";
    LONGEST_REQUEST: usize = REQUEST_HEAD + SESSION_BYTES
        + 4 * (SEGMENTS_HEAD_WORDS + SEGMENTS_AXIS_WORDS * MAX_AXES + 1) + CRC_BYTES,
        "Length of the longest request (SEGMENTS for eight axes) in bytes, without END and ESC.";
    ANSWER_BYTES: usize = 16, "Length of an answer in bytes, without END and ESC.";
    ANSWER_DATA: usize = 8, "Number of the first data byte in an answer.";
    WINDOW: u8 = 127,
        "Number of writes that may be unacknowledged, and by which a repeated one may lie behind.";
}

//! The definitions that the host and the gateware's link share: frames, registers and the build id
//! (docs/protocol.md).
//!
//! ```text
//! line      END, then the frame with END and ESC escaped, then END         RFC 1055
//! request   sequence 1 | address 1 | words, 4 each, low byte first | CRC 4
//! answer    sequence 1 | address 1 | next 1 | state 1 | free 1 | culprits 1 | homing 1 | data 4 |
//!           CRC 4
//! ```
//!
//! The numbers are lengths in bytes. A change of the register map or of a build parameter changes
//! the build id, so that a driver refuses the gateware that it was not made for.

mod assembler;
mod build_id;
mod facts;
mod line;
mod ports;
pub mod processor;
mod program;
pub mod registers;
mod uart;

pub use assembler::Image;
pub use build_id::BuildId;
pub use facts::facts;
pub use line::LineKind;
pub use ports::{BYTE_PORTS, LinkInputs, LinkOutputs, line_pins, line_ports, link_ports};
pub use program::image;
pub use uart::{BAUD_PERCENT, BaudError, DEFAULT_BAUD, MAX_BIT_CLOCKS, MIN_BIT_CLOCKS, Uart};

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
    SEGMENT_FRAME_WORDS: usize = 8, "Number of words of a segment, the commit included.";
    LONGEST_REQUEST: usize = REQUEST_HEAD + 4 * SEGMENT_FRAME_WORDS + CRC_BYTES,
        "Length of the longest request in bytes, without END and ESC.";
    ANSWER_BYTES: usize = 15, "Length of an answer in bytes, without END and ESC.";
    ANSWER_DATA: usize = 7, "Number of the first data byte in an answer.";
    WINDOW: u8 = 127,
        "Number of writes that may be unacknowledged, and by which a repeated one may lie behind.";
}

/// A field in the bytes of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Name of the field, in the documentation and in C.
    pub name: &'static str,
    /// Number of the byte in the answer, from 0.
    pub byte: usize,
    /// Lowest bit of the field.
    pub bit: u8,
    /// Number of bits.
    pub bits: u8,
    /// Byte and bit of one more bit, above the others, if the field has one at another place.
    pub top: Option<(usize, u8)>,
    /// Meaning of the field.
    pub what: &'static str,
}

const fn field(name: &'static str, byte: usize, bit: u8, bits: u8, what: &'static str) -> Field {
    Field { name, byte, bit, bits, top: None, what }
}

/// The fields of an answer, byte by byte. The data (low byte first) and the CRC follow them.
pub const ANSWER: [Field; 14] = [
    field("sequence", 0, 0, 8, "the sequence number of the request"),
    field("address", 1, 0, 8, "the address of the request"),
    field(
        "next",
        2,
        0,
        8,
        "number of the next write; all before it were executed, or dropped during a fault",
    ),
    field(
        "fault",
        3,
        0,
        1,
        "a stop has been triggered; segments and starts are dropped until a clear",
    ),
    field("halted", 3, 1, 1, "the stop is complete: no axis moves any more"),
    field("idle", 3, 2, 1, "no axis moves, no queue holds a segment, and no start is armed"),
    field("ready", 3, 3, 1, "the drivers have had power for the enable time, as a start requires"),
    field("armed", 3, 4, 1, "a start is armed; another start is refused as busy"),
    Field {
        top: Some((4, 4)),
        ..field("cause", 3, 5, 3, "the cause of the stop, if `fault` is set; otherwise 0")
    },
    field("free", 4, 0, 3, "number of segments for which the queue of the addressed axis has room"),
    field("refused", 4, 3, 1, "this write was not executed: out of sequence, or busy"),
    field("written", 4, 7, 1, "the request was a write; a read of the same address has 0 here"),
    field(
        "culprits",
        5,
        0,
        8,
        "the axes that caused overrun, overspeed, limit or underrun, one bit each; else 0",
    ),
    field("homing", 6, 0, 8, "the axes that still wait for their limit, one bit each"),
];

//! The fields of an answer, byte by byte. The data (low byte first) and the CRC follow them.

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
    /// Meaning of the field.
    pub what: &'static str,
}

const fn field(name: &'static str, byte: usize, bit: u8, bits: u8, what: &'static str) -> Field {
    Field { name, byte, bit, bits, what }
}

/// The fields of an answer.
pub const ANSWER: [Field; 15] = [
    field("sequence", 0, 0, 8, "the sequence number of the request"),
    field("address", 1, 0, 8, "the address of the request"),
    field(
        "next",
        2,
        0,
        8,
        "number of the owner's next write; all before it were executed, or dropped during a fault",
    ),
    field(
        "fault",
        3,
        0,
        1,
        "a stop has been triggered; segments and starts are dropped until a clear",
    ),
    field("ready", 3, 1, 1, "the drivers have had power for the enable time, as a start requires"),
    field("armed", 3, 2, 1, "a start is armed; another start is refused as busy"),
    field("written", 3, 3, 1, "the request was a write; a read of the same address has 0 here"),
    field("cut_refused", 3, 4, 1, "the last CUT was refused; always 1 in a build without cuts"),
    field("idle", 3, 6, 1, "no axis moves, no queue holds a segment, and no start is armed"),
    field("halted", 3, 7, 1, "the stop is complete: no axis moves any more"),
    field(
        "free",
        4,
        0,
        8,
        "number of segments for which the queue of the addressed axis has room; of SEGMENTS the \
         least of its axes",
    ),
    field(
        "culprits",
        5,
        0,
        8,
        "the axes that caused overrun, overspeed, limit or underrun, one bit each; else 0",
    ),
    field("seeking", 6, 0, 8, "the axes that wait for the source of their seek, one bit each"),
    field("cause", 7, 0, 4, "the cause of the stop, if `fault` is set; otherwise 0"),
    field("reason", 7, 4, 4, "why the request was refused; 0 if it was not"),
];

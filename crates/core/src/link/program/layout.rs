//! The layout of the data memory: the program's variables, the request, the answer, and the tables
//! among the constants.
//!
//! ```text
//! variables   00 .. 1a   the program's variables
//!             1b .. ef   the request: sequence, address, session, words, CRC
//!             f0 .. ff   the answer; before that the commit of a segment
//! constants   00 .. 08   BELOW: n ones
//!             23 .. 3f   NAMED: at every fourth address an axis
//!             7c .. 7f   RESIDUE
//!             80 .. 91   FRAMES: two bytes for each number of axes of a SEGMENTS frame
//!             a0 .. a3   ROWS: a byte for each row of switches
//!             f8 .. ff   BITS: one bit for each axis
//! ```

use crate::engine::{MAX_AXES, SWITCH_ROWS};
use crate::link::assembler::Assembler;
use crate::link::processor::{REQUEST, REQUEST_END};
use crate::link::registers::switch_address;
use crate::link::{
    ANSWER_BYTES, ANSWER_DATA, CRC_BYTES, CRC_RESIDUE, LONGEST_REQUEST, REQUEST_HEAD,
    SEGMENTS_AXIS_WORDS, SEGMENTS_HEAD_WORDS, SESSION_BYTES,
};

pub(super) const SEQUENCE: u8 = REQUEST;
pub(super) const ADDRESS: u8 = REQUEST + 1;
/// Address of the two bytes of the request's session.
pub(super) const SESSION: u8 = REQUEST + REQUEST_HEAD as u8;
/// Address of the request's words.
pub(super) const WORDS: u8 = SESSION + SESSION_BYTES as u8;
/// Address of the answer while it is assembled; the answer ends where bit 7 of X becomes 0.
pub(super) const ANSWER: u8 = REQUEST_END;
/// Address of the answer's data.
pub(super) const DATA: u8 = ANSWER + ANSWER_DATA as u8;
/// Address of the answer's CRC.
pub(super) const CHECKED: u8 = ANSWER + (ANSWER_BYTES - CRC_BYTES) as u8;
/// Address of the commit of a segment while its words are put. X is then at or behind
/// [`REQUEST_END`], where no other word of a segment is.
pub(super) const COMMIT: u8 = REQUEST_END;

// Addresses of the program's variables.
pub(super) const BYTE: u8 = 0x00; // a byte under examination
pub(super) const LENGTH: u8 = 0x01; // the address behind the request's last byte
pub(super) const WRITTEN: u8 = 0x02; // WRITTEN_BIT; 0 for a read
pub(super) const REASON: u8 = 0x03; // the reason of a refusal, in bits 7..4
pub(super) const NEXT: u8 = 0x04; // the sequence number that the next write must have
pub(super) const OWNER: u8 = 0x05; // two bytes: the session number of the owner; 0: nobody
pub(super) const POWER: u8 = 0x07; // the control register
pub(super) const MASK: u8 = 0x08; // the axes of the request, one bit each
pub(super) const AXIS: u8 = 0x09; // an address in BITS, whose bits 2..0 are the axis
pub(super) const LEVELS: u8 = 0x0a; // a byte of INPUTS
pub(super) const ANSWERS: u8 = 0x0b; // 0 while the room is examined before a segment is put
pub(super) const TICKS: u8 = 0x0c; // four bytes: the first word of a segment
pub(super) const BASE: u8 = 0x10; // the address of a word of a segment
pub(super) const LAST: u8 = 0x11; // the address of the commit in the request
pub(super) const WANTED: u8 = 0x12; // the bit of a switch's word that is read
pub(super) const ROW: u8 = 0x13; // an address in ROWS

/// Bit of an answer's flags: a stop has been triggered.
pub(super) const FAULT_BIT: u8 = 1 << 0;
/// Bit of an answer's flags: the drivers are ready.
pub(super) const READY_BIT: u8 = 1 << 1;
/// Bit of an answer's flags: a start is armed.
pub(super) const ARMED_BIT: u8 = 1 << 2;
/// Bit of an answer's flags: the last cut was refused.
pub(super) const CUT_REFUSED_BIT: u8 = 1 << 4;
/// Bit of an answer's flags: the request was a write.
pub(super) const WRITTEN_BIT: u8 = 1 << 3;
/// Bits of an answer's flags: nothing moves and nothing waits, or a stop is complete.
pub(super) const AT_REST: u8 = 1 << 6 | 1 << 7;

/// Table: as many ones as the index says, 0 to 8. The number of axes leads to the bits of those
/// that exist.
const BELOW: u8 = 0x00;
/// Table: by the address behind a word of a CUT frame, the axis to which it belongs. Bit 3 is 0, as
/// a word that names a slot requires; only the last entry is 0xc0 or more.
pub(super) const NAMED: u8 = WORDS + 4;
/// Table: the bytes of the CRC's residue. Bit 7 of X becomes 1 behind the last one.
pub(super) const RESIDUE: u8 = 0x7c;
/// Table: the address behind a SEGMENTS frame and that of its last word, by its number of axes.
pub(super) const FRAMES: u8 = 0x80;
/// Table: by the row of a switch, the address of its word exclusive or [`BITS`], for axis 0. Its
/// entries and the bytes of the answer's data have the same lowest three bits.
pub(super) const ROWS: u8 = 0xa0 | DATA & 7;
/// Table: the bits of the axes. Bit 7 of X becomes 0 behind the last one.
pub(super) const BITS: u8 = 0xf8;

/// The address behind a request of this many words after its session.
pub(super) const fn end(words: usize) -> u8 {
    WORDS + (4 * words + CRC_BYTES) as u8
}

/// The address of the last word of a request that ends at this address.
pub(super) const fn last_of(end: u8) -> u8 {
    end - 4 - CRC_BYTES as u8
}

/// Places the tables.
pub(super) fn tables(a: &mut Assembler) {
    a.table(BELOW, &core::array::from_fn::<u8, 9, _>(|count| ((1_u32 << count) - 1) as u8));
    for axis in 0..MAX_AXES as u8 {
        let last = usize::from(axis) == MAX_AXES - 1;
        a.table(NAMED + 4 * axis, &[if last { 0xc0 | axis } else { axis }]);
    }
    a.table(RESIDUE, &CRC_RESIDUE.to_le_bytes());
    for axes in 0..=MAX_AXES {
        let end = end(SEGMENTS_HEAD_WORDS + SEGMENTS_AXIS_WORDS * axes + 1);
        a.table(FRAMES + 2 * axes as u8, &[end, last_of(end)]);
    }
    a.table(
        ROWS,
        &core::array::from_fn::<u8, { SWITCH_ROWS as usize }, _>(|row| {
            BITS ^ switch_address(row as u8)
        }),
    );
    a.table(BITS, &core::array::from_fn::<u8, 8, _>(|axis| 1 << axis));
}

const _: () = assert!(ANSWER as usize + ANSWER_BYTES == 256, "the answer ends where X wraps");
const _: () = assert!(
    REQUEST as usize + LONGEST_REQUEST < REQUEST_END as usize,
    "an over-long frame ends at another address than the longest request"
);

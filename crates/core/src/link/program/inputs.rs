//! The registers that the program puts together from several words: CAPTURES, INPUTS and
//! INPUT_LEVELS.

use super::layout::{ADDRESS, AXIS, BITS, DATA, LEVELS, ROW, ROWS, WANTED, WRITTEN};
use crate::engine::{SWITCH_LEVEL, SWITCH_ROWS, SWITCH_STATE};
use crate::link::assembler::Assembler;
use crate::link::processor::Condition::{X7, Zero};
use crate::link::processor::{CRC_BEGIN, CRC_FEED, HITS, INX, LATCH, TAX, ValueSource};
use crate::link::registers::{CAPTURES, INPUT_LEVELS, INPUTS};

/// Replaces the data of the answer if one of these registers is read.
pub(super) fn put_together(a: &mut Assembler) {
    a.load(WRITTEN);
    a.jump_unless(Zero, "data known");
    a.load(ADDRESS);
    a.xor_number(CAPTURES);
    a.jump_if(Zero, "captures");
    a.xor_number(CAPTURES ^ INPUTS);
    a.jump_if(Zero, "states");
    a.xor_number(INPUTS ^ INPUT_LEVELS);
    a.jump_unless(Zero, "data known");
    a.load_number(SWITCH_LEVEL as u8);
    a.jump("switches");
    a.label("captures");
    a.load_from(ValueSource::Engine, HITS);
    a.store(DATA);
    a.load_from(ValueSource::Engine, LATCH);
    a.store(DATA + 1);
    a.jump("data known");
    a.label("states");
    a.load_number(SWITCH_STATE as u8);
    a.label("switches");
    a.store(WANTED);
    switches(a);
    a.label("data known");
}

/// Puts a byte for each row into the data: a bit for each axis, the wanted bit of its switch in
/// this row. [`ROW`] goes through the table of rows, and ends with the number of the byte.
fn switches(a: &mut Assembler) {
    a.load_number(ROWS);
    a.label("row");
    a.store(ROW);
    a.store_number(LEVELS, 0);
    a.load_number(BITS);
    a.label("switch");
    a.store(AXIS);
    // The address of the axis' bit is BITS + axis, that of its switch the row's + axis.
    a.index(ROW);
    a.load(AXIS);
    a.xor_table();
    a.acts(TAX);
    a.acts(CRC_BEGIN | CRC_FEED);
    a.index(AXIS);
    a.load_from(ValueSource::Crc, 0);
    a.and(WANTED);
    a.jump_if(Zero, "inactive");
    a.load(LEVELS);
    a.xor_table();
    a.store(LEVELS);
    a.label("inactive");
    a.acts(INX);
    a.load_x();
    a.jump_if(X7, "switch");
    // The row's byte of the data has the address of its entry in the table, in upper memory.
    a.load(ROW);
    a.xor_number(ROWS ^ DATA);
    a.acts(TAX);
    a.load(LEVELS);
    a.store_next();
    // X is behind that byte, as the next row is behind this one.
    a.load_x();
    a.xor_number(DATA ^ ROWS ^ (ROWS + SWITCH_ROWS));
    a.jump_if(Zero, "data known");
    a.xor_number(ROWS + SWITCH_ROWS);
    a.jump("row");
}

const _: () = assert!(BITS & 7 == 0, "an address in BITS ends with the number of the axis");
const _: () = assert!(
    ROWS & 7 == DATA & 7 && DATA & 4 == 0,
    "entries of the table of rows and bytes of the data have the same lowest bits"
);

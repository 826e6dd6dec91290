//! Checks the length and the CRC of the request, and finds the axes that it names.
//!
//! A request without words is a read. The length of a SEGMENTS frame follows from its mask.

use super::layout::{
    ADDRESS, ANSWERS, AXIS, BASE, BITS, FRAMES, LAST, LENGTH, MASK, REASON, RESIDUE, WORDS,
    WRITTEN, WRITTEN_BIT, end, last_of,
};
use crate::link::assembler::Assembler;
use crate::link::processor::Condition::{X7, Zero};
use crate::link::processor::{CRC_STEP, INX, TAX, ValueSource};
use crate::link::registers::{SEGMENT, SEGMENTS};
use crate::link::{SEGMENT_FRAME_WORDS, SESSION_BYTES, WRITE};

/// The address behind a read without a session.
pub(super) const FREE_READ: u8 = end(0) - SESSION_BYTES as u8;

pub(super) fn check(a: &mut Assembler) {
    a.label("ended");
    a.store_number(REASON, 0);
    a.store(ANSWERS);
    a.load_x();
    a.store(LENGTH);
    a.xor_number(FREE_READ);
    a.jump_if(Zero, "of its axis");
    a.xor_number(FREE_READ ^ end(0));
    a.jump_if(Zero, "of its axis");
    a.index(ADDRESS);
    a.jump_unless(X7, "begin");
    a.and_number(SEGMENT);
    a.jump_if(Zero, "one word");
    a.load(ADDRESS);
    a.xor_number(WRITE | SEGMENTS);
    a.jump_if(Zero, "several axes");
    a.store_number(BASE, WORDS);
    a.load_number(last_of(end(SEGMENT_FRAME_WORDS)));
    a.store(LAST);
    a.load_number(end(SEGMENT_FRAME_WORDS));
    a.xor(LENGTH);
    a.jump_unless(Zero, "begin");
    a.load_number(WRITTEN_BIT);
    a.jump("of its axis");
    a.label("one word");
    a.load_number(end(1));
    a.xor(LENGTH);
    a.jump_unless(Zero, "begin");
    a.store_number(WRITTEN, WRITTEN_BIT);
    a.load_number(0);
    a.jump("one axis");
    // A is 0 for a read.
    a.label("of its axis");
    a.store(WRITTEN);
    a.load(ADDRESS);
    a.and_number(7);
    a.label("one axis");
    a.xor_number(BITS);
    a.acts(TAX);
    a.load_from(ValueSource::ConstantAtX, 0);
    a.store(MASK);
    a.jump("length known");

    // X goes through the bits of the axes, `LAST` through the table of frames.
    a.label("several axes");
    a.store_number(WRITTEN, WRITTEN_BIT);
    a.load(WORDS);
    a.store(MASK);
    a.store_number(BASE, WORDS + 4);
    a.store_number(LAST, FRAMES);
    a.load_number(BITS);
    a.label("count");
    a.store(AXIS);
    a.acts(TAX);
    a.load(MASK);
    a.and_table();
    a.jump_if(Zero, "not counted");
    a.index(LAST);
    a.acts(INX);
    a.store_next_x(LAST);
    a.label("not counted");
    a.index(AXIS);
    a.acts(INX);
    a.load_x();
    a.jump_if(X7, "count");
    a.index(LAST);
    a.load_from(ValueSource::ConstantAtX, 0);
    a.xor(LENGTH);
    a.jump_unless(Zero, "begin");
    a.acts(INX);
    a.load_from(ValueSource::ConstantAtX, 0);
    a.store(LAST);

    a.label("length known");
    a.index_number(RESIDUE);
    a.label("residue");
    a.load_from(ValueSource::Crc, 0);
    a.xor_table();
    a.jump_unless(Zero, "begin");
    a.acts(CRC_STEP | INX);
    a.jump_unless(X7, "residue");
}

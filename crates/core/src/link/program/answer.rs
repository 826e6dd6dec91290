//! Assembles the answer.

use super::inputs;
use super::layout::{
    ADDRESS, ANSWER, ANSWERS, CHECKED, DATA, FAULT_BIT, NEXT, REASON, SEQUENCE, WRITTEN,
};
use super::segments::rooms;
use crate::link::assembler::Assembler;
use crate::link::processor::Condition::{X7, Zero};
use crate::link::processor::{
    CAUSE, CRC_BEGIN, CRC_FEED, CRC_STEP, CULPRITS, SEEKING, STATE, TAX, ValueSource, WAIT,
};
use crate::link::registers::{CUT, POSITION, SEGMENT, SEGMENTS};

pub(super) fn answer(a: &mut Assembler) {
    a.label("answer");
    a.load_from(ValueSource::Engine, STATE);
    a.xor(WRITTEN);
    a.store(ANSWER + 3);
    a.store_number(ANSWERS, 1);
    rooms(a);
    a.store(ANSWER + 4);
    register(a);
    // The flags are sampled before this wait, and every live word is stored again during it. The
    // position of an axis that the flags report at rest is therefore its final one. The first wait
    // may end at once, because it begins within a tick. A and X are unchanged.
    a.acts(WAIT);
    a.acts(WAIT);
    // Without a fault in the flags, cause and culprits are 0, even if one has come since.
    a.load(ANSWER + 3);
    a.and_number(FAULT_BIT);
    a.jump_if(Zero, "no fault");
    a.load_from(ValueSource::Engine, CULPRITS);
    a.store(ANSWER + 5);
    a.load_from(ValueSource::Engine, CAUSE);
    a.jump("cause");
    a.label("no fault");
    a.store(ANSWER + 5);
    a.label("cause");
    a.xor(REASON);
    a.store(ANSWER + 7);
    a.load_from(ValueSource::Engine, SEEKING);
    a.store(ANSWER + 6);
    a.acts(CRC_BEGIN | CRC_FEED);
    for byte in 0..4 {
        a.load_from(ValueSource::Crc, 0);
        a.store(DATA + byte);
        a.acts(CRC_STEP);
    }
    inputs::put_together(a);
    for (at, from) in [SEQUENCE, ADDRESS, NEXT].into_iter().enumerate() {
        a.load(from);
        a.store(ANSWER + at as u8);
    }
    a.load_number(ANSWER);
    a.acts(TAX | CRC_BEGIN);
    a.label("sum");
    a.load_next();
    a.acts(CRC_STEP | CRC_FEED);
    a.load_x();
    a.xor_number(CHECKED);
    a.jump_unless(Zero, "sum");
    a.label("its CRC");
    a.load_from(ValueSource::Crc, 0);
    a.xor_number(0xff);
    a.store_next();
    a.acts(CRC_STEP);
    a.jump_if(X7, "its CRC");
}

/// X <= the address of the register to read: the one of the request, or after a write the position
/// of the axis that its address names, or else of axis 0.
fn register(a: &mut Assembler) {
    a.load(WRITTEN);
    a.jump_if(Zero, "as asked");
    a.load(ADDRESS);
    a.and_number(SEGMENT);
    a.jump_if(Zero, "of axis 0");
    a.load(ADDRESS);
    a.and_number(7);
    a.label("of axis 0");
    a.xor_number(POSITION);
    a.jump("place");
    a.label("as asked");
    a.load(ADDRESS);
    a.label("place");
    a.acts(TAX);
}

const _: () = assert!(
    SEGMENT == 0x40 && SEGMENTS & 7 == 0 && CUT & 7 == 0,
    "bit 6 of a write's address says that bits 2..0 are the axis"
);

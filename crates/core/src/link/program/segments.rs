//! Puts the segments of one or of several axes into their queues: all of them, or none.
//!
//! The words of an axis go one per tick: its ticks, V, A and J, and the commit. A frame of one axis
//! has them in this order. In a frame of several axes the ticks come first and the commit last; the
//! ticks are copied in front of each axis' own words, where only used words are.

use super::layout::{
    ANSWERS, AXIS, BASE, BELOW, BITS, COMMIT, LAST, LEAST, MASK, ROOM_BITS, TICKS,
};
use crate::link::assembler::Assembler;
use crate::link::processor::Condition::{Commit, Fault, Full, X7, Zero};
use crate::link::processor::{
    BROKEN, CRC_BEGIN, CRC_FEED, CRC_STEP, FOR_ROOM, HITS, INX, PUTS, ROOM, TAX, ValueSource, WAIT,
};
use crate::link::registers::AXIS_COUNT;

pub(super) fn segments(a: &mut Assembler) {
    a.label("segments");
    a.jump_if(Fault, "done");
    // An axis that does not exist, or none at all.
    a.index_number(AXIS_COUNT);
    a.load(MASK);
    a.jump_if(Zero, "broken");
    a.acts(CRC_BEGIN | CRC_FEED);
    a.load_from(ValueSource::Crc, 0);
    a.acts(TAX);
    a.load(MASK);
    a.and_table();
    a.xor(MASK);
    a.jump_unless(Zero, "broken");
    a.load_from(ValueSource::Engine, HITS);
    a.and(MASK);
    a.jump_unless(Zero, "seek ended");
    // A segment of 0 ticks has all ones as its first word, which is ticks minus one.
    a.index(BASE);
    copy(a, TICKS);
    a.load(TICKS);
    for byte in 1..4 {
        a.and(TICKS + byte);
    }
    a.xor_number(0xff);
    a.jump_if(Zero, "broken");
    a.store_number(ANSWERS, 0);
    a.jump("rooms");
    a.label("room for one");
    a.load(LEAST);
    a.jump_unless(Zero, "put");
    a.label("broken");
    a.acts(BROKEN);
    a.jump("done");

    a.label("put");
    a.index(LAST);
    copy(a, COMMIT);
    a.load_number(BITS);
    a.label("axis");
    a.store(AXIS);
    a.acts(TAX);
    a.load(MASK);
    a.and_table();
    a.jump_if(Zero, "next axis");
    a.index(BASE);
    for byte in 0..4 {
        a.load(TICKS + byte);
        a.store_next();
    }
    a.index(BASE);
    a.label("word");
    // In the end this is the last word before the commit: the next axis' words follow it.
    a.load_x();
    a.store(BASE);
    a.label("bytes");
    for _ in 0..4 {
        a.load_next();
        a.acts(CRC_STEP);
    }
    a.load(AXIS);
    a.acts(PUTS | WAIT);
    a.jump_if(Full, "next axis");
    a.jump_unless(Commit, "word");
    a.index_number(COMMIT);
    a.jump("bytes");
    a.label("next axis");
    a.index(AXIS);
    a.acts(INX);
    a.load_x();
    a.jump_if(X7, "axis");
    a.jump("done");
}

/// Copies the four bytes at X to this address. X is then behind them.
fn copy(a: &mut Assembler, to: u8) {
    for byte in 0..4 {
        a.load_next();
        a.store(to + byte);
    }
}

/// Finds how many segments each queue of the mask has room for.
pub(super) fn rooms(a: &mut Assembler) {
    a.label("rooms");
    a.store_number(LEAST, 0x7f);
    a.load_number(BITS);
    a.label("room");
    a.store(AXIS);
    a.acts(TAX);
    a.load(MASK);
    a.and_table();
    a.jump_if(Zero, "next room");
    a.load(AXIS);
    // The first wait may end with `refreshed` before the axis of A has reported; the room would
    // then be another axis'. An axis that does not exist never reports.
    a.acts(WAIT | FOR_ROOM);
    a.acts(WAIT | FOR_ROOM);
    a.load_from(ValueSource::Engine, ROOM);
    a.and_number(ROOM_BITS);
    a.acts(TAX);
    a.load(LEAST);
    a.and_table();
    a.store(LEAST);
    a.label("next room");
    a.index(AXIS);
    a.acts(INX);
    a.load_x();
    a.jump_if(X7, "room");
    a.load(ANSWERS);
    a.jump_if(Zero, "room for one");
    // X <= the number of ones.
    a.index_number(BELOW);
    a.label("ones");
    a.load_from(ValueSource::ConstantAtX, 0);
    a.xor(LEAST);
    a.jump_if(Zero, "rooms known");
    a.acts(INX);
    a.jump("ones");
    a.label("rooms known");
}

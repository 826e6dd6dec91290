//! Puts the segments of one or of several axes into their queues: all of them, or none.
//!
//! The words of an axis go one per tick: its ticks, V, A and J, and the commit. A frame of one axis
//! has them in this order. In a frame of several axes the ticks come first and the commit last; the
//! ticks are copied in front of each axis' own words, where only used words are. The commit of a
//! frame of several axes changes outputs as that of its first axis.

use super::layout::{ANSWERS, AXIS, BASE, BITS, COMMIT, LAST, MASK, TICKS};
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
    // A is the last of these bytes.
    copy(a, TICKS);
    for byte in 0..3 {
        a.and(TICKS + byte);
    }
    a.xor_number(0xff);
    a.jump_if(Zero, "broken");
    a.jump("rooms");
    a.label("its room");
    a.load_from(ValueSource::Engine, ROOM);
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
    a.jump_if(Full, "committed");
    a.jump_unless(Commit, "word");
    a.index_number(COMMIT);
    a.jump("bytes");
    // Only the first axis of a frame changes outputs.
    a.label("committed");
    a.load(COMMIT);
    a.and_number(1);
    a.store(COMMIT);
    a.load_number(0);
    for byte in 1..4 {
        a.store(COMMIT + byte);
    }
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

/// A <= the number of segments for which every queue of the mask has room.
pub(super) fn rooms(a: &mut Assembler) {
    a.label("rooms");
    a.acts(CRC_BEGIN);
    a.load_number(BITS);
    a.label("room");
    a.store(AXIS);
    a.acts(TAX);
    a.load(MASK);
    a.and_table();
    a.jump_if(Zero, "next room");
    a.load(AXIS);
    // The first wait may end with `refreshed` before the axis of A has reported. An axis that does
    // not exist never reports.
    a.acts(WAIT | FOR_ROOM);
    a.acts(WAIT | FOR_ROOM);
    a.label("next room");
    a.index(AXIS);
    a.acts(INX);
    a.load_x();
    a.jump_if(X7, "room");
    a.load(ANSWERS);
    a.jump_if(Zero, "its room");
    a.load_from(ValueSource::Engine, ROOM);
}

//! Executes a write of one word.

use super::layout::{ADDRESS, ARMED_BIT, POWER, READY_BIT, WORDS};
use crate::link::WRITE;
use crate::link::assembler::Assembler;
use crate::link::processor::Condition::{Fault, Zero};
use crate::link::processor::{
    BROKEN, CLEARING, CONTROL, HITS, KICK, STARTS, STATE, ValueSource, WAIT,
};
use crate::link::registers::{
    CLEAR, CONTROL as CONTROL_REGISTER, CUT, LATCH as LATCH_REGISTER, SEEK, SEGMENT, SNAPSHOT,
    START,
};

/// Number of waits during which a clear is asserted. Each of them but the first contains a strobe;
/// the engine accepts a clear at one strobe and ends the stop at the next.
const CLEAR_WAITS: usize = 6;

/// `several_latches` is true for a build that has several latches.
pub(super) fn execute(a: &mut Assembler, several_latches: bool) {
    a.label("execute");
    a.load(ADDRESS);
    a.xor_number(WRITE | CUT);
    a.jump_if(Zero, "cut");
    // The address of a CUT has the bit of a segment too.
    a.and_number(SEGMENT);
    a.jump_if(Zero, "segments");
    // A is the address exclusive or all registers that were compared so far.
    let mut compared = 0;
    a.load(ADDRESS);
    for (register, label) in [
        (CONTROL_REGISTER, "control"),
        (START, "start"),
        (CLEAR, "clear"),
        (SEEK, "seek"),
        (SNAPSHOT, "snapshot"),
    ] {
        let address = WRITE | register;
        a.xor_number(compared ^ address);
        a.jump_if(Zero, label);
        compared = address;
    }
    a.xor_number(compared ^ (WRITE | LATCH_REGISTER));
    if several_latches {
        // The word says which latches are armed, and whose record is read from now on.
        a.jump_unless(Zero, "done");
        a.load(WORDS);
        latch(a);
    } else {
        a.jump_if(Zero, "latch");
        a.jump("done");
    }

    a.label("control");
    a.load(WORDS);
    a.store(POWER);
    a.acts(CONTROL);
    a.jump("done");

    a.label("seek");
    a.load(WORDS + 1);
    a.acts(CONTROL | KICK | BROKEN);
    a.load(WORDS);
    a.acts(CONTROL | KICK);
    a.jump("done");

    if !several_latches {
        latch(a);
    }

    a.label("snapshot");
    // The engine takes the snapshot in one of the next ticks, whose live words are not output; the
    // wait of the answer lasts longer.
    a.acts(CONTROL | BROKEN);
    a.jump("done");

    a.label("clear");
    a.load(POWER);
    a.acts(CONTROL | CLEARING);
    for _ in 0..CLEAR_WAITS {
        a.acts(WAIT);
    }
    a.acts(CONTROL);
    a.jump("done");

    a.label("start");
    a.jump_if(Fault, "done");
    a.load_from(ValueSource::Engine, HITS);
    a.and(WORDS);
    a.jump_unless(Zero, "seek ended");
    a.load_from(ValueSource::Engine, STATE);
    a.and_number(READY_BIT | ARMED_BIT);
    a.xor_number(READY_BIT);
    a.jump_unless(Zero, "busy");
    a.load(WORDS);
    a.acts(STARTS | WAIT);
    a.jump("done");
}

/// Arms the latch, or those latches that A names.
fn latch(a: &mut Assembler) {
    a.label("latch");
    a.acts(KICK | CLEARING);
    a.jump("done");
}

//! A CUT: names the slot of the last segment that each axis keeps, and requests the cut.
//!
//! The frame has a word for each axis: its lowest byte is the slot, and its highest byte is 0 if
//! the axis takes no part. The engine examines all named slots and then drops the segments behind
//! them, or refuses ("Cut" in docs/clock-by-clock.md).

use super::layout::{CUT_REFUSED_BIT, WORDS};
use crate::link::assembler::Assembler;
use crate::link::processor::Condition::{Fault, Special, Zero};
use crate::link::processor::{
    BROKEN, CLEARING, CONTROL, CRC_STEP, PUTS, STATE, TAX, ValueSource, WAIT,
};

/// Number of waits after which a cut is decided. Each of them but the first contains a strobe; the
/// engine examines the slots in the tick after the request.
const CUT_WAITS: usize = 3;

pub(super) fn cut(a: &mut Assembler) {
    a.label("cut");
    a.load_number(WORDS);
    a.acts(TAX);
    a.label("slot");
    for _ in 0..4 {
        a.load_next();
        a.acts(CRC_STEP);
    }
    // A is the highest byte of the word, and X the address behind it: an entry of NAMED.
    a.jump_if(Zero, "no part");
    a.load_from(ValueSource::ConstantAtX, 0);
    a.acts(PUTS | WAIT);
    a.label("no part");
    a.load_from(ValueSource::ConstantAtX, 0);
    a.jump_unless(Special, "slot");
    a.acts(CONTROL | BROKEN | CLEARING);
    for _ in 0..CUT_WAITS {
        a.acts(WAIT);
    }
    // In a stop the engine takes no names; a clear empties all queues anyway.
    a.jump_if(Fault, "done");
    a.load_from(ValueSource::Engine, STATE);
    a.and_number(CUT_REFUSED_BIT);
    a.jump_unless(Zero, "cut refused");
    a.jump("done");
}

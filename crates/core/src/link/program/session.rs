//! Decides whose request it is: a read of anyone, STOP and OPEN, or a request of the owner, which
//! restarts the watchdog.

use super::check::FREE_READ;
use super::layout::{ADDRESS, AT_REST, LENGTH, NEXT, OWNER, REASON, SESSION, WORDS, WRITTEN};
use crate::link::assembler::Assembler;
use crate::link::processor::Condition::Zero;
use crate::link::processor::{BROKEN, CONTROL, KICK, STATE, ValueSource};
use crate::link::registers::{OPEN, OPEN_FORCE, STOP};
use crate::link::{Refusal, WRITE};

/// A stop of all axes.
const STOPS: u16 = KICK | BROKEN;

pub(super) fn session(a: &mut Assembler) {
    a.load(WRITTEN);
    a.jump_if(Zero, "a read");
    a.load(ADDRESS);
    a.xor_number(WRITE | STOP);
    a.jump_unless(Zero, "claim");
    a.acts(STOPS);
    a.jump("answer");
    a.label("a read");
    a.load(LENGTH);
    a.xor_number(FREE_READ);
    a.jump_if(Zero, "answer");

    // Session 0 is nobody's.
    a.label("claim");
    a.load(SESSION);
    a.jump_unless(Zero, "somebody");
    a.load(SESSION + 1);
    a.jump_if(Zero, "stranger");
    a.label("somebody");
    a.load(WRITTEN);
    a.jump_if(Zero, "compare");
    a.load(ADDRESS);
    a.xor_number(WRITE | OPEN);
    a.jump_if(Zero, "open");
    a.label("compare");
    for byte in 0..2 {
        a.load(SESSION + byte);
        a.xor(OWNER + byte);
        a.jump_unless(Zero, "stranger");
    }
    a.acts(KICK);
    a.load(WRITTEN);
    a.jump_if(Zero, "answer");
    a.jump("order");

    a.label("open");
    a.load_from(ValueSource::Engine, STATE);
    a.and_number(AT_REST);
    a.jump_if(Zero, "in use");
    for byte in 0..2 {
        a.load(SESSION + byte);
        a.store(OWNER + byte);
    }
    a.load_number(0);
    a.store(NEXT);
    a.acts(CONTROL | KICK);
    a.acts(KICK);
    a.jump("answer");
    a.label("in use");
    a.load(WORDS);
    a.and_number(OPEN_FORCE as u8);
    a.jump_if(Zero, "busy");
    a.acts(STOPS);

    for (label, refusal) in [
        ("busy", Refusal::Busy),
        ("lost", Refusal::Sequence),
        ("seek ended", Refusal::SeekEnded),
        ("cut refused", Refusal::Cut),
    ] {
        a.label(label);
        a.load_number(refusal.number() << 4);
        a.jump("refuse");
    }
    a.label("stranger");
    a.load_number(Refusal::Session.number() << 4);
    a.label("refuse");
    a.store(REASON);
    a.jump("answer");
}

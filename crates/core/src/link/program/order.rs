//! Decides what to do with a write: execute it if its number is `next`, answer it again if it was
//! executed before, refuse it if a write before it is missing.

use super::layout::{NEXT, SEQUENCE};
use crate::link::assembler::Assembler;
use crate::link::processor::Condition::Zero;
use crate::link::processor::{INX, TAX};

pub(super) fn order(a: &mut Assembler) {
    a.label("order");
    a.load(SEQUENCE);
    a.acts(TAX);
    a.xor(NEXT);
    a.jump_if(Zero, "execute");
    // X counts upward from the request's number. If it reaches `next` in fewer than 128 steps, the
    // write was executed before.
    a.label("again");
    a.acts(INX);
    a.load_x();
    a.xor(SEQUENCE);
    a.xor_number(128);
    a.jump_if(Zero, "lost");
    a.load_x();
    a.xor(NEXT);
    a.jump_unless(Zero, "again");
    a.jump("answer");
}

/// Counts a write that was executed.
pub(super) fn done(a: &mut Assembler) {
    a.label("done");
    a.index(NEXT);
    a.store_next_x(NEXT);
}

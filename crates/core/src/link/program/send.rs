//! Sends the answer with END and ESC escaped.

use super::layout::{ANSWER, BYTE};
use crate::link::assembler::Assembler;
use crate::link::processor::Condition::{Special, X7, Zero};
use crate::link::{END, ESC, ESC_END, ESC_ESC};

pub(super) fn send(a: &mut Assembler) {
    a.index_number(ANSWER);
    a.load_number(END);
    a.label("transmit");
    a.send();
    a.jump_unless(X7, "last");
    a.load_next();
    a.jump_unless(Special, "transmit");
    a.store(BYTE);
    a.xor_number(END);
    a.jump_if(Zero, "escape an END");
    a.xor_number(END ^ ESC);
    a.jump_if(Zero, "escape an ESC");
    a.load(BYTE);
    a.jump("transmit");
    for (then, label) in [(ESC_END, "escape an END"), (ESC_ESC, "escape an ESC")] {
        a.label(label);
        a.load_number(ESC);
        a.send();
        a.load_number(then);
        a.jump("transmit");
    }
    a.label("last");
    a.load_number(END);
    a.send();
    a.jump("begin");
}

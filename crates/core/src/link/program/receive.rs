//! Collects bytes into a request until an END arrives. X is the address of the next byte; the CRC
//! includes every byte.

use super::layout::BYTE;
use crate::link::assembler::Assembler;
use crate::link::processor::Condition::{Full, Nothing, Special, Zero};
use crate::link::processor::{
    CRC_BEGIN, CRC_FEED, CRC_STEP, REQUEST, REQUEST_END, TAX, ValueSource,
};
use crate::link::{END, ESC, ESC_END, ESC_ESC};

pub(super) fn receive(a: &mut Assembler) {
    a.label("begin");
    a.load_number(REQUEST);
    a.acts(TAX | CRC_BEGIN);
    a.label("next");
    a.jump_if(Nothing, "next");
    a.load_from(ValueSource::Received, 0);
    a.jump_if(Special, "special");
    a.label("plain");
    // An over-long frame leaves X at `REQUEST_END`. No valid request has that length, so `check`
    // rejects the frame.
    a.jump_if(Full, "next");
    a.acts(CRC_STEP | CRC_FEED);
    a.store_next();
    a.jump("next");

    a.label("special");
    a.store(BYTE);
    a.xor_number(END);
    a.jump_if(Zero, "ended");
    a.xor_number(END ^ ESC);
    a.jump_if(Zero, "escaped");
    a.load(BYTE);
    a.jump("plain");

    a.label("escaped");
    a.jump_if(Nothing, "escaped");
    a.load_from(ValueSource::Received, 0);
    a.xor_number(ESC_END);
    a.jump_if(Zero, "an END");
    a.xor_number(ESC_END ^ ESC_ESC);
    a.jump_if(Zero, "an ESC");
    // No other byte may follow an ESC. The frame is damaged; unless this byte is an END, X is set
    // to the length of an over-long frame.
    a.xor_number(ESC_ESC ^ END);
    a.jump_if(Zero, "begin");
    a.index_number(REQUEST_END);
    a.jump("next");
    for (special, label) in [(END, "an END"), (ESC, "an ESC")] {
        a.label(label);
        a.load_number(special);
        a.jump("plain");
    }
}

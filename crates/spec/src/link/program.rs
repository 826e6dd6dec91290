//! What the gateware's end of the link does: docs/protocol.md as a program of the link's machine.
//!
//! ```text
//! begin -> next <---------------.
//!            | a byte           |   escapes are taken out, the request grows
//!            v                  |
//!          ended: length, CRC --' damaged: not a word
//!            | whole
//!            v
//!          known -> execute -> done -> answer -> begin
//!            '---- again, refused ------^
//! ```

use super::assembler::{Assembler, Image};
use super::machine::Condition::{Fault, Nothing, Sending, Startable, X6, X7, Zero};
use super::machine::{
    BROKEN, CLEARING, CONTROL, CRC_BEGIN, CRC_FEED, CRC_STEP, CULPRITS, HOMING, INX, KICK, PUTS, REQUEST, REQUEST_END,
    ROOM, STARTS, STATE, Source, TAX, WAIT, WORDS,
};
use super::registers::{AXES_AT, CLEAR, CONTROL as CONTROL_REGISTER, HOME, POSITION, SEGMENT, START};
use super::{
    ANSWER_BYTES, ANSWER_DATA, CRC_BYTES, CRC_RESIDUE, END, ESC, ESC_END, ESC_ESC, LONGEST_REQUEST, REQUEST_HEAD,
    SEGMENT_FRAME_WORDS, WRITE,
};

const SEQUENCE: u8 = REQUEST;
const ADDRESS: u8 = REQUEST + 1;

/// The answer as it grows: it ends where bit 7 of X begins. A frame that is too long may lie there; it is nothing.
const ANSWER: u8 = REQUEST_END - ANSWER_BYTES as u8;
/// Its CRC.
const CHECKED: u8 = REQUEST_END - CRC_BYTES as u8;

// What is remembered.
const BYTE: u8 = 0x80; // the byte at work
const READ: u8 = 0x81; // how far the ring of received bytes has been read
const FILL: u8 = 0x82; // where the request's next byte goes
const NEXT: u8 = 0x83; // the number that the next write must have
const REFUSED: u8 = 0x84;
const CONTROLS: u8 = 0x85; // the control register

/// Bit 3 of the answer's byte `free`.
const REFUSED_BIT: u8 = 1 << 3;

/// What lies in the machine's memories at configuration.
pub fn image() -> Image {
    let mut a = Assembler::default();
    receive(&mut a);
    check(&mut a);
    order(&mut a);
    execute(&mut a);
    answer(&mut a);
    send(&mut a);
    a.finish()
}

/// Bytes into a request, until an END.
fn receive(a: &mut Assembler) {
    a.label("begin");
    a.load_number(REQUEST);
    a.store(FILL);
    a.label("next");
    take(a, "poll");
    a.xor_number(END);
    a.jump_if(Zero, "ended");
    a.load(BYTE);
    a.xor_number(ESC);
    a.jump_if(Zero, "escaped");
    a.label("store");
    a.load(FILL);
    a.acts(TAX);
    // Too long: it stays as long as that, which is the length of nothing.
    a.jump_if(X7, "next");
    a.load(BYTE);
    a.store_next();
    a.load_x();
    a.store(FILL);
    a.jump("next");

    a.label("escaped");
    take(a, "poll for the escaped");
    a.xor_number(ESC_END);
    a.jump_if(Zero, "an END");
    a.load(BYTE);
    a.xor_number(ESC_ESC);
    a.jump_if(Zero, "an ESC");
    // Nothing is written so: the frame is damaged, if this does not end it.
    a.load_number(REQUEST_END);
    a.store(FILL);
    a.load(BYTE);
    a.xor_number(END);
    a.jump_if(Zero, "begin");
    a.jump("next");
    a.label("an END");
    a.load_number(END);
    a.store(BYTE);
    a.jump("store");
    a.label("an ESC");
    a.load_number(ESC);
    a.store(BYTE);
    a.jump("store");
}

/// Waits for a byte: to A and BYTE.
fn take(a: &mut Assembler, poll: &'static str) {
    a.load(READ);
    a.acts(TAX);
    a.label(poll);
    a.jump_if(Nothing, poll);
    a.next(Source::Received);
    a.swap();
    a.store(READ);
    a.load_x();
    a.store(BYTE);
}

/// Whether the request has its length and its CRC.
fn check(a: &mut Assembler) {
    let end = |words: usize| REQUEST + (REQUEST_HEAD + 4 * words + CRC_BYTES) as u8;
    a.label("ended");
    a.load(ADDRESS);
    a.acts(TAX);
    a.load_number(end(0));
    a.jump_unless(X7, "length");
    a.load_number(end(SEGMENT_FRAME_WORDS));
    a.jump_if(X6, "length");
    a.load_number(end(1));
    a.label("length");
    a.xor(FILL);
    a.jump_unless(Zero, "begin");
    a.load_number(REQUEST);
    sum(a, "sum", |a| a.xor(FILL));
    a.index_table(CRC_RESIDUE.to_le_bytes());
    a.label("residue");
    a.load_from(Source::Crc, 0);
    a.xor_at_x();
    a.jump_unless(Zero, "begin");
    a.acts(CRC_STEP | INX);
    a.jump_if(X7, "residue");
    a.acts(KICK);
}

/// The CRC from A on, to where `end` makes A zero.
fn sum(a: &mut Assembler, label: &'static str, end: impl Fn(&mut Assembler)) {
    a.acts(TAX | CRC_BEGIN);
    a.label(label);
    a.next(Source::DataAtX);
    a.acts(CRC_STEP | CRC_FEED);
    a.load_x();
    end(a);
    a.jump_unless(Zero, label);
}

/// Whether a write is the next one, or was executed already, or one before it is missing.
fn order(a: &mut Assembler) {
    a.load_number(0);
    a.store(REFUSED);
    a.load(ADDRESS);
    a.acts(TAX);
    a.jump_unless(X7, "answer");
    a.load(SEQUENCE);
    a.acts(TAX);
    a.xor(NEXT);
    a.jump_if(Zero, "execute");
    // Counts from it to the next: less than 128 away, it was before.
    a.label("count");
    a.acts(INX);
    a.load_x();
    a.xor(SEQUENCE);
    a.xor_number(128);
    a.jump_if(Zero, "refuse");
    a.load_x();
    a.xor(NEXT);
    a.jump_unless(Zero, "count");
    a.jump("answer");
    a.label("refuse");
    a.load_number(REFUSED_BIT);
    a.store(REFUSED);
    a.jump("answer");
}

/// Waits until each item of each axis has been asked for since, and longer than any axis' turn is away; A and X stay.
fn wait_for_all(a: &mut Assembler) {
    // The first wait may end at once.
    a.acts(WAIT);
    a.acts(WAIT);
}

/// Does what the request asks for.
fn execute(a: &mut Assembler) {
    a.label("execute");
    a.load(ADDRESS);
    a.acts(TAX);
    a.jump_if(X6, "segment");
    for (register, label) in [(CONTROL_REGISTER, "control"), (START, "start"), (CLEAR, "clear"), (HOME, "home")] {
        a.load(ADDRESS);
        a.xor_number(WRITE | register);
        a.jump_if(Zero, label);
    }
    a.jump("done");

    a.label("control");
    a.load(WORDS);
    a.store(CONTROLS);
    a.acts(CONTROL);
    a.jump("done");

    a.label("home");
    a.load(WORDS);
    a.acts(CONTROL | KICK);
    a.jump("done");

    a.label("clear");
    // It stands for more than two ticks.
    a.load(CONTROLS);
    a.acts(CONTROL | CLEARING);
    wait_for_all(a);
    a.acts(CONTROL);
    a.jump("done");

    a.label("start");
    a.jump_if(Fault, "done");
    a.jump_unless(Startable, "refuse");
    a.load(WORDS);
    a.acts(STARTS | WAIT);
    a.jump("done");

    a.label("segment");
    a.jump_if(Fault, "done");
    wait_for_all(a);
    a.load_from(Source::Engine, ROOM);
    a.jump_if(Zero, "broken");
    // Ticks less one is all ones: no ticks.
    a.load_number(WORDS);
    a.acts(TAX);
    a.label("ones");
    a.next(Source::DataAtX);
    a.xor_number(0xff);
    a.jump_unless(Zero, "words");
    a.load_x();
    a.xor_number(WORDS + 4);
    a.jump_unless(Zero, "ones");
    a.label("broken");
    a.acts(BROKEN);
    a.jump("done");
    a.label("words");
    a.load(ADDRESS);
    a.acts(TAX);
    (0..SEGMENT_FRAME_WORDS).for_each(|_| a.acts(PUTS | WAIT | INX));

    a.label("done");
    a.load(NEXT);
    a.acts(TAX);
    a.acts(INX);
    a.load_x();
    a.store(NEXT);
}

/// Gathers the answer.
fn answer(a: &mut Assembler) {
    a.label("answer");
    // The one before is still on its way: this one is left out.
    a.jump_if(Sending, "begin");
    // The register that is asked for; after a write the position of its axis.
    a.load(ADDRESS);
    a.acts(TAX);
    a.jump_unless(X7, "place");
    a.xor_number((WRITE | SEGMENT) ^ POSITION);
    a.jump_if(X6, "of its axis");
    a.load_number(POSITION);
    a.label("of its axis");
    a.acts(TAX);
    a.label("place");
    a.load_from(Source::Engine, STATE);
    a.store(ANSWER + 3);
    // Whatever the state says has reached the facts: an axis at rest is where they say. And X has found its room.
    wait_for_all(a);
    a.load_from(Source::Engine, ROOM);
    a.xor(REFUSED);
    a.store(ANSWER + 4);
    a.load_from(Source::Engine, CULPRITS);
    a.store(ANSWER + 5);
    a.load_from(Source::Engine, HOMING);
    a.store(ANSWER + 6);
    for byte in 0..4 {
        a.load_from(Source::Facts, byte);
        a.store(ANSWER + ANSWER_DATA as u8 + byte);
    }
    for (at, from) in [SEQUENCE, ADDRESS, NEXT].into_iter().enumerate() {
        a.load(from);
        a.store(ANSWER + at as u8);
    }
    a.load_number(ANSWER);
    sum(a, "sum of the answer", |a| a.xor_number(CHECKED));
    a.label("its CRC");
    a.load_from(Source::Crc, 0);
    a.xor_number(0xff);
    a.store_next();
    a.acts(CRC_STEP);
    a.jump_unless(X7, "its CRC");
}

/// Escapes the answer and sends it.
fn send(a: &mut Assembler) {
    a.load_number(ANSWER);
    a.acts(TAX);
    a.load_number(END);
    a.label("put");
    a.answer(false);
    a.jump_if(X7, "last");
    a.next(Source::DataAtX);
    a.store(BYTE);
    for (special, label) in [(END, "escape an END"), (ESC, "escape an ESC")] {
        a.xor_number(special);
        a.jump_if(Zero, label);
        a.load(BYTE);
    }
    a.jump("put");
    for (then, label) in [(ESC_END, "escape an END"), (ESC_ESC, "escape an ESC")] {
        a.label(label);
        a.load_number(ESC);
        a.answer(false);
        a.load_number(then);
        a.jump("put");
    }
    a.label("last");
    a.load_number(END);
    a.answer(true);
    a.jump("begin");
}

const _: () = assert!(SEGMENT == AXES_AT && AXES_AT == 0x40, "bit 6 of an address says that it is an axis'");
const _: () =
    assert!(REQUEST as usize + LONGEST_REQUEST < ANSWER as usize, "no request that is whole reaches the answer");

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
    BROKEN, CLEAR_BIT, CONTROL, CRC_BEGIN, CRC_FEED, CRC_STEP, INX, KICK, PUTS, REQUEST, REQUEST_END, STARTS, Source, TAX,
    WAIT, WORDS,
};
use super::registers::{CLEAR, CONTROL as CONTROL_REGISTER, HOME, POSITION, SEGMENT, START};
use crate::engine::MAX_AXES;
use super::{ANSWER_BYTES, ANSWER_DATA, CRC_BYTES, CRC_RESIDUE, END, ESC, ESC_END, ESC_ESC, LONGEST_REQUEST, REQUEST_HEAD, WRITE};

const SEQUENCE: u8 = REQUEST;
const ADDRESS: u8 = REQUEST + 1;

// The answer as it grows, and what is remembered.
const ANSWER: u8 = 0x80;
const BYTE: u8 = 0x90; // the byte at work
const READ: u8 = 0x91; // how far the ring of received bytes has been read
const FILL: u8 = 0x92; // where the request's next byte goes
const NEXT: u8 = 0x93; // the number that the next write must have
const REFUSED: u8 = 0x94;
const FROM: u8 = 0x95; // where the answer's next byte comes from
const TO: u8 = 0x96; // and goes
const CONTROLS: u8 = 0x97; // the control register

/// Bit 3 of the answer's byte `free`.
const REFUSED_BIT: u8 = 1 << 3;
/// Set in the address of a segment, beside [`WRITE`].
const SEGMENT_BIT: u8 = 0x40;
/// In so many turns each axis has had one.
const TURNS: u8 = MAX_AXES as u8 + 1;
/// In so many turns all items of all axes have come to the facts.
const FACTS: u8 = 4 * MAX_AXES as u8;
/// Bytes of an answer before its data, and before its CRC.
const CHECKED: u8 = (ANSWER_BYTES - CRC_BYTES) as u8;

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
    a.load(READ);
    a.does(TAX);
    take(a, "poll");
    a.xor_number(END);
    a.jump_if(Zero, "ended");
    a.load(BYTE);
    a.xor_number(ESC);
    a.jump_if(Zero, "escaped");
    a.label("store");
    a.load(FILL);
    a.does(TAX);
    // Too long: it stays as long as that, which is the length of nothing.
    a.jump_if(X7, "next");
    a.load(BYTE);
    a.store_at_x();
    a.does(INX);
    a.load_from(Source::X, 0);
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

/// Waits for a byte: to A and BYTE. X is where the ring is read.
fn take(a: &mut Assembler, poll: &'static str) {
    a.label(poll);
    a.jump_if(Nothing, poll);
    a.load_from(Source::Received, 0);
    a.store(BYTE);
    a.does(INX);
    a.load_from(Source::X, 0);
    a.store(READ);
    a.load(BYTE);
}

/// Whether the request has its length and its CRC.
fn check(a: &mut Assembler) {
    let length = |a: &mut Assembler, words: usize| {
        a.load(FILL);
        a.xor_number(REQUEST + (REQUEST_HEAD + 4 * words + CRC_BYTES) as u8);
        a.jump_unless(Zero, "begin");
    };
    a.label("ended");
    a.load(ADDRESS);
    a.does(TAX);
    a.jump_if(X7, "ended write");
    length(a, 0);
    a.jump("whole");
    a.label("ended write");
    a.jump_if(X6, "ended segment");
    length(a, 1);
    a.jump("whole");
    a.label("ended segment");
    length(a, (LONGEST_REQUEST - REQUEST_HEAD - CRC_BYTES) / 4);
    a.label("whole");
    a.load_number(REQUEST);
    sum(a, "sum", |a| a.xor(FILL));
    for byte in CRC_RESIDUE.to_le_bytes() {
        a.load_from(Source::Crc, 0);
        a.xor_number(byte);
        a.jump_unless(Zero, "begin");
        a.does(CRC_STEP);
    }
    a.does(KICK);
}

/// The CRC from A on, to where `end` makes A zero.
fn sum(a: &mut Assembler, label: &'static str, end: impl Fn(&mut Assembler)) {
    a.does(TAX | CRC_BEGIN);
    a.label(label);
    a.load_from(Source::DataAtX, 0);
    a.does(CRC_STEP | CRC_FEED);
    a.does(INX);
    a.load_from(Source::X, 0);
    end(a);
    a.jump_unless(Zero, label);
}

/// Whether a write is the next one, or was executed already, or one before it is missing.
fn order(a: &mut Assembler) {
    a.load_number(0);
    a.store(REFUSED);
    a.load(ADDRESS);
    a.does(TAX);
    a.jump_unless(X7, "answer");
    a.load(SEQUENCE);
    a.xor(NEXT);
    a.jump_if(Zero, "execute");
    // Counts from it to the next: less than 128 away, it was before.
    a.load(SEQUENCE);
    a.does(TAX);
    a.label("count");
    a.does(INX);
    a.load_from(Source::X, 0);
    a.xor(SEQUENCE);
    a.xor_number(128);
    a.jump_if(Zero, "refuse");
    a.load_from(Source::X, 0);
    a.xor(NEXT);
    a.jump_unless(Zero, "count");
    a.jump("answer");
    a.label("refuse");
    a.load_number(REFUSED_BIT);
    a.store(REFUSED);
    a.jump("answer");
}

/// Waits for so many turns of axes; takes X.
fn wait_for_turns(a: &mut Assembler, label: &'static str, turns: u8) {
    a.load_number(128 - turns);
    a.does(TAX);
    a.label(label);
    a.does(WAIT);
    a.does(INX);
    a.jump_unless(X7, label);
}

/// Does what the request asks for.
fn execute(a: &mut Assembler) {
    a.label("execute");
    a.load(ADDRESS);
    a.does(TAX);
    a.jump_if(X6, "segment");
    for (register, label) in
        [(CONTROL_REGISTER, "control"), (START, "start"), (CLEAR, "clear"), (HOME, "home")]
    {
        a.load(ADDRESS);
        a.xor_number(WRITE | register);
        a.jump_if(Zero, label);
    }
    a.jump("done");

    a.label("control");
    // Power and stop are the host's; whatever says more is nothing.
    for bits in 0..4 {
        a.load(WORDS);
        a.xor_number(bits);
        a.jump_if(Zero, "known control");
    }
    a.jump("done");
    a.label("known control");
    a.load(WORDS);
    a.store(CONTROLS);
    a.does(CONTROL);
    a.jump("done");

    a.label("home");
    a.load(WORDS);
    a.does(CONTROL | KICK);
    a.jump("done");

    a.label("clear");
    // The host does not reach this bit; it stands for a tick and more.
    a.load(CONTROLS);
    a.xor_number(CLEAR_BIT);
    a.does(CONTROL);
    wait_for_turns(a, "clearing", 2 * TURNS);
    a.load(CONTROLS);
    a.does(CONTROL);
    a.jump("done");

    a.label("start");
    a.jump_if(Fault, "done");
    a.jump_unless(Startable, "refuse");
    a.load(WORDS);
    a.does(STARTS | WAIT);
    a.jump("done");

    a.label("segment");
    a.jump_if(Fault, "done");
    // The axis tells its room.
    (0..TURNS).for_each(|_| a.does(WAIT));
    a.load_from(Source::Engine, 1);
    a.jump_if(Zero, "broken");
    // Ticks less one is all ones: no ticks.
    for byte in 0..4 {
        a.load(WORDS + byte);
        a.xor_number(0xff);
        a.jump_unless(Zero, "words");
    }
    a.label("broken");
    a.does(BROKEN);
    a.jump("done");
    a.label("words");
    for _ in 0..8 {
        a.does(PUTS | WAIT);
        a.does(INX);
    }

    a.label("done");
    a.load(NEXT);
    a.does(TAX);
    a.does(INX);
    a.load_from(Source::X, 0);
    a.store(NEXT);
}

/// Gathers the answer.
fn answer(a: &mut Assembler) {
    a.label("answer");
    // The one before is still on its way: this one is left out.
    a.jump_if(Sending, "begin");
    // The register that is asked for; after a write the position of its axis.
    a.load(ADDRESS);
    a.does(TAX);
    a.jump_unless(X7, "place");
    a.jump_if(X6, "of its axis");
    a.load_number(POSITION);
    a.jump("place of a write");
    a.label("of its axis");
    a.xor_number((WRITE | SEGMENT) ^ POSITION);
    a.label("place of a write");
    a.does(TAX);
    a.label("place");
    // The room is that of its axis, or of the first.
    a.load_from(Source::X, 0);
    a.store(BYTE);
    a.jump_if(X6, "room");
    a.load_number(POSITION);
    a.does(TAX);
    a.label("room");
    // X must stay: it says which axis.
    (0..TURNS).for_each(|_| a.does(WAIT));
    a.load_from(Source::Engine, 0);
    a.store(ANSWER + 3);
    a.load_from(Source::Engine, 1);
    a.xor(REFUSED);
    a.store(ANSWER + 4);
    a.load_from(Source::Engine, 2);
    a.store(ANSWER + 5);
    a.load_from(Source::Engine, 3);
    a.store(ANSWER + 6);
    // Whatever the state says has reached the facts: an axis at rest is where they say.
    wait_for_turns(a, "facts", FACTS + TURNS);
    a.load(BYTE);
    a.does(TAX);
    for byte in 0..4 {
        a.load_from(Source::Facts, byte);
        a.store(ANSWER + ANSWER_DATA as u8 + byte);
    }
    a.load(SEQUENCE);
    a.store(ANSWER);
    a.load(ADDRESS);
    a.store(ANSWER + 1);
    a.load(NEXT);
    a.store(ANSWER + 2);
    a.load_number(ANSWER);
    sum(a, "sum of the answer", |a| a.xor_number(ANSWER + CHECKED));
    for byte in 0..CRC_BYTES as u8 {
        a.load_from(Source::Crc, 0);
        a.xor_number(0xff);
        a.store(ANSWER + CHECKED + byte);
        a.does(CRC_STEP);
    }
}

/// Escapes the answer and sends it.
fn send(a: &mut Assembler) {
    a.load_number(ANSWER);
    a.store(FROM);
    a.load_number(0);
    a.does(TAX);
    a.load_number(END);
    a.label("put and go on");
    a.answer(false);
    a.does(INX);
    a.load_from(Source::X, 0);
    a.store(TO);
    a.load(FROM);
    a.xor_number(ANSWER + ANSWER_BYTES as u8);
    a.jump_if(Zero, "last");
    a.load(FROM);
    a.does(TAX);
    a.load_from(Source::DataAtX, 0);
    a.store(BYTE);
    a.does(INX);
    a.load_from(Source::X, 0);
    a.store(FROM);
    a.load(TO);
    a.does(TAX);
    for (special, label) in [(END, "escape an END"), (ESC, "escape an ESC")] {
        a.load(BYTE);
        a.xor_number(special);
        a.jump_if(Zero, label);
    }
    a.load(BYTE);
    a.jump("put and go on");
    for (then, label) in [(ESC_END, "escape an END"), (ESC_ESC, "escape an ESC")] {
        a.label(label);
        a.load_number(ESC);
        a.answer(false);
        a.does(INX);
        a.load_number(then);
        a.jump("put and go on");
    }
    a.label("last");
    a.load(TO);
    a.does(TAX);
    a.load_number(END);
    a.answer(true);
    a.jump("begin");
}

/// An address of the engine's segments, for the reader: its bits are [`WRITE`] and this.
const _: () = assert!(SEGMENT == SEGMENT_BIT);

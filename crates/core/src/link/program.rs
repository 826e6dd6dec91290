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
use super::machine::Condition::{Fault, Nothing, Special, Startable, X6, X7, Zero};
use super::machine::{
    BROKEN, CLEARING, CONTROL, CRC_BEGIN, CRC_FEED, CRC_STEP, CULPRITS, FOR_ROOM, HOMING, INX, KICK, PUTS, REQUEST,
    REQUEST_END, ROOM, STARTS, STATE, Source, TAX, WAIT, WORDS,
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
const LENGTH: u8 = 0x81; // where the request's bytes end
const NEXT: u8 = 0x82; // the number that the next write must have
const REFUSED: u8 = 0x83;
const CONTROLS: u8 = 0x84; // the control register

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

/// Bytes into a request, until an END: X is where the next one goes, the CRC goes along.
fn receive(a: &mut Assembler) {
    a.label("begin");
    a.load_number(REQUEST);
    a.acts(TAX | CRC_BEGIN);
    a.label("next");
    a.jump_if(Nothing, "next");
    a.load_from(Source::Received, 0);
    a.jump_if(Special, "special");
    a.label("plain");
    // Too long: it stays as long as that, which is the length of nothing.
    a.jump_if(X7, "next");
    a.acts(CRC_STEP | CRC_FEED);
    a.store_next();
    a.jump("next");

    a.label("special");
    a.store(BYTE);
    a.xor_number(END);
    a.jump_if(Zero, "ended");
    a.load(BYTE);
    a.xor_number(ESC);
    a.jump_if(Zero, "escaped");
    a.load(BYTE);
    a.jump("plain");

    a.label("escaped");
    a.jump_if(Nothing, "escaped");
    a.load_from(Source::Received, 0);
    a.store(BYTE);
    for (special, label) in [(ESC_END, "an END"), (ESC_ESC, "an ESC")] {
        a.xor_number(special);
        a.jump_if(Zero, label);
        a.load(BYTE);
    }
    // Nothing is written so: the frame is damaged, if this does not end it.
    a.xor_number(END);
    a.jump_if(Zero, "begin");
    a.load_number(REQUEST_END);
    a.acts(TAX);
    a.jump("next");
    for (special, label) in [(END, "an END"), (ESC, "an ESC")] {
        a.label(label);
        a.load_number(special);
        a.jump("plain");
    }
}

/// Whether the request has its length and its CRC.
fn check(a: &mut Assembler) {
    let end = |words: usize| REQUEST + (REQUEST_HEAD + 4 * words + CRC_BYTES) as u8;
    a.label("ended");
    a.load_x();
    a.store(LENGTH);
    a.load(ADDRESS);
    a.acts(TAX);
    a.load_number(end(0));
    a.jump_unless(X7, "length");
    a.load_number(end(SEGMENT_FRAME_WORDS));
    a.jump_if(X6, "length");
    a.load_number(end(1));
    a.label("length");
    a.xor(LENGTH);
    a.jump_unless(Zero, "begin");
    a.index_table(CRC_RESIDUE.to_le_bytes());
    a.label("residue");
    a.load_from(Source::Crc, 0);
    a.xor_at_x();
    a.jump_unless(Zero, "begin");
    a.acts(CRC_STEP | INX);
    a.jump_if(X7, "residue");
    a.acts(KICK);
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
    // The first wait may end with the scan, before the axis has told: what it told last was another's. An axis that
    // does not exist never tells.
    a.acts(WAIT | FOR_ROOM);
    a.acts(WAIT | FOR_ROOM);
    a.load_from(Source::Engine, ROOM);
    a.jump_if(Zero, "broken");
    // Ticks less one is all ones: no ticks.
    a.load_number(WORDS);
    a.acts(TAX);
    a.label("ones");
    a.load_next();
    a.xor_number(0xff);
    a.jump_unless(Zero, "words");
    a.load_x();
    a.xor_number(WORDS + 4);
    a.jump_unless(Zero, "ones");
    a.label("broken");
    a.acts(BROKEN);
    a.jump("done");
    a.label("words");
    a.load_number(WORDS);
    a.acts(TAX);
    a.label("word");
    for _ in 1..4 {
        a.load_next();
        a.acts(CRC_STEP);
    }
    // X stays in the word until it is taken.
    a.load_from(Source::DataAtX, 0);
    a.acts(CRC_STEP);
    a.load(ADDRESS);
    a.acts(PUTS | WAIT | INX);
    a.jump_unless(X6, "word");

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
    // Whatever the state says has reached the facts: an axis at rest is where they say. And the axis of A has told its room.
    a.load_x();
    wait_for_all(a);
    a.load_from(Source::Engine, ROOM);
    a.xor(REFUSED);
    a.store(ANSWER + 4);
    a.load_from(Source::Engine, CULPRITS);
    a.store(ANSWER + 5);
    a.load_from(Source::Engine, HOMING);
    a.store(ANSWER + 6);
    a.acts(CRC_BEGIN | CRC_FEED);
    for byte in 0..4 {
        a.load_from(Source::Crc, 0);
        a.store(ANSWER + ANSWER_DATA as u8 + byte);
        a.acts(CRC_STEP);
    }
    for (at, from) in [SEQUENCE, ADDRESS, NEXT].into_iter().enumerate() {
        a.load(from);
        a.store(ANSWER + at as u8);
    }
    a.load_number(ANSWER);
    a.acts(TAX | CRC_BEGIN);
    a.label("sum");
    a.load_next();
    a.acts(CRC_STEP | CRC_FEED);
    a.load_x();
    a.xor_number(CHECKED);
    a.jump_unless(Zero, "sum");
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
    a.send();
    a.jump_if(X7, "last");
    a.load_next();
    a.jump_unless(Special, "put");
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
        a.send();
        a.load_number(then);
        a.jump("put");
    }
    a.label("last");
    a.load_number(END);
    a.send();
    a.jump("begin");
}

const _: () = assert!(SEGMENT == AXES_AT && AXES_AT == 0x40, "bit 6 of an address says that it is an axis'");
const _: () =
    assert!(WORDS as usize + 4 * SEGMENT_FRAME_WORDS == 0x40, "bit 6 of X says that a segment's words are over");
const _: () =
    assert!(REQUEST as usize + LONGEST_REQUEST < ANSWER as usize, "no request that is whole reaches the answer");

#[cfg(test)]
mod tests {
    #[test]
    fn the_program_fits() {
        assert!(super::image().program.len() > 100);
    }
}

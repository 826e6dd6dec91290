//! The program of the link processor: it implements the gateware's end of docs/protocol.md.
//!
//! ```text
//! begin -> next <---------------.
//!            | END              |   until then: removes escapes, appends bytes to the request
//!            v                  |
//!          ended: length, CRC --'   damaged: no answer
//!            | valid
//!            v
//!          known -> execute -> done -> answer -> begin
//!            '---- again, refused ------^
//! ```

use super::assembler::{Assembler, Image};
use super::processor::Condition::{Fault, Nothing, Special, Startable, X6, X7, Zero};
use super::processor::{
    BROKEN, CLEARING, CONTROL, CRC_BEGIN, CRC_FEED, CRC_STEP, CULPRITS, FOR_ROOM, HOMING, INX,
    KICK, PUTS, REQUEST, REQUEST_END, ROOM, STARTS, STATE, TAX, ValueSource, WAIT, WORDS,
};
use super::registers::{
    CLEAR, CONTROL as CONTROL_REGISTER, HOME, POSITION, SEGMENT, SNAPSHOT, START,
};
use super::{
    ANSWER_BYTES, ANSWER_DATA, CRC_BYTES, CRC_RESIDUE, END, ESC, ESC_END, ESC_ESC, REQUEST_HEAD,
    SEGMENT_FRAME_WORDS, WRITE,
};

const SEQUENCE: u8 = REQUEST;
const ADDRESS: u8 = REQUEST + 1;

/// Address of the answer while it is assembled; the answer ends where bit 7 of X becomes 1. The
/// bytes of an over-long frame may also be written here. Such a frame is rejected before an answer
/// is built.
const ANSWER: u8 = REQUEST_END - ANSWER_BYTES as u8;
/// Address of the answer's CRC.
const CHECKED: u8 = REQUEST_END - CRC_BYTES as u8;

// Addresses of the program's variables.
const BYTE: u8 = 0x80; // a byte under examination
const LENGTH: u8 = 0x81; // the address behind the request's last byte
const NEXT: u8 = 0x82; // the sequence number that the next write must have
const FLAGS: u8 = 0x83; // WRITTEN_BIT and REFUSED_BIT; 0 for a read
const CONTROLS: u8 = 0x84; // the control register without the clear bit

/// Bit 3 of the answer's byte 4: the write was refused.
const REFUSED_BIT: u8 = 1 << 3;
/// Bit 7 of the answer's byte 4: the request was a write.
const WRITTEN_BIT: u8 = 1 << 7;

/// Number of waits during which a clear is asserted. Each of them but the first contains a strobe;
/// the engine accepts a clear at one strobe and ends the stop at the next.
const CLEAR_WAITS: usize = 6;

/// The contents of the machine's memories after configuration.
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

/// Collects bytes into a request until an END arrives. X is the address of the next byte; the CRC
/// includes every byte.
fn receive(a: &mut Assembler) {
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
    a.load_from(ValueSource::Received, 0);
    a.store(BYTE);
    for (special, label) in [(ESC_END, "an END"), (ESC_ESC, "an ESC")] {
        a.xor_number(special);
        a.jump_if(Zero, label);
        a.load(BYTE);
    }
    // No other byte may follow an ESC. The frame is damaged; unless this byte is an END, X is set
    // to the length of an over-long frame.
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

/// Checks the length and the CRC of the request. A request without words is a read.
fn check(a: &mut Assembler) {
    let end = |words: usize| REQUEST + (REQUEST_HEAD + 4 * words + CRC_BYTES) as u8;
    a.label("ended");
    a.load_x();
    a.store(LENGTH);
    a.xor_number(end(0));
    a.jump_if(Zero, "length known");
    a.load(ADDRESS);
    a.acts(TAX);
    a.jump_unless(X7, "begin");
    a.load_number(end(SEGMENT_FRAME_WORDS));
    a.jump_if(X6, "length");
    a.load_number(end(1));
    a.label("length");
    a.xor(LENGTH);
    a.jump_unless(Zero, "begin");
    a.load_number(WRITTEN_BIT);
    a.label("length known");
    a.store(FLAGS);
    a.index_table(CRC_RESIDUE.to_le_bytes());
    a.label("residue");
    a.load_from(ValueSource::Crc, 0);
    a.xor_at_x();
    a.jump_unless(Zero, "begin");
    a.acts(CRC_STEP | INX);
    a.jump_if(X7, "residue");
    a.acts(KICK);
}

/// Decides what to do with a write: execute it if its number is `next`, answer it again if it was
/// executed before, refuse it if a write before it is missing.
fn order(a: &mut Assembler) {
    a.load(FLAGS);
    a.jump_if(Zero, "answer");
    a.load(SEQUENCE);
    a.acts(TAX);
    a.xor(NEXT);
    a.jump_if(Zero, "execute");
    // X counts upward from the request's number. If it reaches `next` in fewer than 128 steps, the
    // write was executed before.
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
    a.load_number(WRITTEN_BIT | REFUSED_BIT);
    a.store(FLAGS);
    a.jump("answer");
}

/// Waits until all live words of a whole tick have been output, which takes longer than a time slot
/// of any axis. A and X are unchanged.
fn wait_for_all(a: &mut Assembler) {
    // The first wait may end at once, because it begins within a tick.
    a.acts(WAIT);
    a.acts(WAIT);
}

/// Executes the request.
fn execute(a: &mut Assembler) {
    a.label("execute");
    a.load(ADDRESS);
    a.acts(TAX);
    a.jump_if(X6, "segment");
    for (register, label) in [
        (CONTROL_REGISTER, "control"),
        (START, "start"),
        (CLEAR, "clear"),
        (HOME, "home"),
        (SNAPSHOT, "snapshot"),
    ] {
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

    a.label("snapshot");
    // The engine takes the snapshot in one of the next ticks, whose live words are not output; the
    // wait of the answer lasts longer.
    a.acts(CONTROL | BROKEN);
    a.jump("done");

    a.label("clear");
    a.load(CONTROLS);
    a.acts(CONTROL | CLEARING);
    for _ in 0..CLEAR_WAITS {
        a.acts(WAIT);
    }
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
    // The first wait may end with `refreshed` before the axis of A has reported; the room would
    // then be another axis'. An axis that does not exist never reports.
    a.acts(WAIT | FOR_ROOM);
    a.acts(WAIT | FOR_ROOM);
    // If a fault has come since, this item can have the highest bit of its cause. The segment is
    // dropped then, whatever follows.
    a.load_from(ValueSource::Engine, ROOM);
    a.jump_if(Zero, "broken");
    // A segment of 0 ticks has all ones as its first word, which is ticks minus one.
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
    // X stays within the word until the engine has accepted it.
    a.load_from(ValueSource::DataAtX, 0);
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

/// Assembles the answer.
fn answer(a: &mut Assembler) {
    a.label("answer");
    // The address of the register to read: the one of the request, or after a write the position of
    // its axis.
    a.load(ADDRESS);
    a.acts(TAX);
    a.load(FLAGS);
    a.jump_if(Zero, "place");
    a.load_number(POSITION);
    a.jump_unless(X6, "of its axis");
    a.load(ADDRESS);
    a.xor_number((WRITE | SEGMENT) ^ POSITION);
    a.label("of its axis");
    a.acts(TAX);
    a.label("place");
    a.load_from(ValueSource::Engine, STATE);
    a.store(ANSWER + 3);
    // The state byte is sampled before this wait, and every live word is stored again during it.
    // The position of an axis that the state reports at rest is therefore its final one. The axis
    // of A has also reported its room.
    a.load_x();
    wait_for_all(a);
    a.load_from(ValueSource::Engine, ROOM);
    a.xor(FLAGS);
    a.store(ANSWER + 4);
    a.load_from(ValueSource::Engine, CULPRITS);
    a.store(ANSWER + 5);
    a.load_from(ValueSource::Engine, HOMING);
    a.store(ANSWER + 6);
    a.acts(CRC_BEGIN | CRC_FEED);
    for byte in 0..4 {
        a.load_from(ValueSource::Crc, 0);
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
    a.load_from(ValueSource::Crc, 0);
    a.xor_number(0xff);
    a.store_next();
    a.acts(CRC_STEP);
    a.jump_unless(X7, "its CRC");
}

/// Sends the answer with END and ESC escaped.
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

const _: () = assert!(SEGMENT == 0x40, "bit 6 of a write's address says that it is a segment");
const _: () = assert!(
    WORDS as usize + 4 * SEGMENT_FRAME_WORDS == 0x40,
    "bit 6 of X says that a segment's words are over"
);
#[cfg(test)]
mod tests {
    #[test]
    fn program_fits_the_memory() {
        assert!(super::image().program.len() > 100);
    }
}

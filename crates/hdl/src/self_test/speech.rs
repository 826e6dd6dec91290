//! The speech: sends lines of text over the UART, the name of the output that has become active,
//! the name of an input that has changed, or all of them after a byte from the host.
//!
//! ```text
//! walks    /^\
//! row      ===< slot >=======================
//! letter   ===< 0         >< 1         >< 2
//! fetched  ________/^^^^^^\_____/^^^^^^\_____     the memory has given the letter
//! take     ______________/^\__________/^\____     the UART accepts it
//! ```
//!
//! Interface: `idle` while nothing is sent and no byte waits to be sent back. Only then may `walks`
//! or `changed` be asserted, at most one of them; the line of that row begins in the next clock.
//!
//! Cost: block RAM for 64 bytes per row, and about 30 flip-flops.

use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::formula::Formula;
use crate::primitives::memory::Memory;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::SelfTest;
use carrystep_core::self_test::LEVEL;
use rust_hdl_core::prelude::*;

/// The texts, and the line that is being sent.
#[derive(LogicBlock, Default)]
pub struct Speech {
    /// The clock.
    pub clock: Input<Clock>,
    /// The next output becomes active in this clock.
    pub walks: Input<Bit>,
    /// The row of that output.
    pub slot: Input<Word<6>>,
    /// An input has changed.
    pub changed: Input<Bit>,
    /// The row of that input.
    pub scanned: Input<Word<6>>,
    /// The levels of inputs and outputs, each at the bit of its row.
    pub levels: Input<Word<64>>,
    /// The line has received a byte; asserted for one clock per byte.
    pub received_valid: Input<Bit>,
    /// The received byte.
    pub received: Input<Word<8>>,
    /// A byte is offered to the UART, until the UART accepts it.
    pub offered: Signal<Out, Bit>,
    /// The offered byte.
    pub data: Signal<Out, Word<8>>,
    /// The UART accepts the offered byte in this clock.
    pub take: Input<Bit>,
    /// Nothing is being sent, and no byte waits to be sent back.
    pub idle: Signal<Out, Bit>,
    texts: Memory<12, 8>,
    row: Register<Word<6>>,
    letter: Register<Word<6>>,
    fetched: Register<Bit>,
    sends: Register<Bit>,
    listing: Register<Bit>,
    echo: Register<Word<8>>,
    asked: Register<Bit>,
    text: Signal<Local, Word<8>>,
    character: Signal<Local, Word<8>>,
    is_level: Signal<Local, Bit>,
    level: Signal<Local, Word<64>>,
    accepted: Signal<Local, Bit>, // a letter of a line
    ends: Signal<Local, Bit>,     // the last letter of a line
    goes_on: Signal<Local, Bit>,  // another line of the list follows
    echoed: Signal<Local, Bit>,   // the byte from the host is sent back
    last_row: Parameter<6>,
    seven_bits: Literal<8, 0x7f>,
    level_mark: Literal<8, { LEVEL as u64 }>,
    digit_0: Literal<8, 0x30>,
    digit_1: Literal<8, 0x31>,
    one: Literal<6, 1>,
    none: Literal<6, 0>,
    by_row: Literal<3, 6>,
    no_address: Literal<12, 0>,
    no_byte: Literal<8, 0>,
}

impl Speech {
    /// Makes the speech of this build, which begins with the heading.
    pub fn new(build: &SelfTest) -> Self {
        let image = build.image();
        // The memory has 2^k words for the least k that is enough.
        let bits = image.len().next_power_of_two().trailing_zeros() as usize;
        let words: Vec<_> = image
            .iter()
            .enumerate()
            .map(|(address, byte)| (address, Formula::number(u64::from(*byte))))
            .collect();
        Self {
            texts: Memory::of_few_formulas(bits, &words),
            sends: Register::new(true),
            last_row: Parameter::new(build.last_row() as u64),
            ..Self::default()
        }
    }
}

impl Logic for Speech {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, row, letter, fetched, sends, listing, echo, asked);
        clock!(self, clock, texts);
        self.texts.read_address.next = (bit_cast::<12, 6>(self.row.q.val()) << self.by_row.val())
            | bit_cast::<12, 6>(self.letter.q.val());
        self.texts.write_address.next = self.no_address.val();
        self.texts.write_data.next = self.no_byte.val();
        self.texts.write_bits.next = self.no_byte.val();

        self.text.next = self.texts.read_data.val();
        self.character.next = self.text.val() & self.seven_bits.val();
        self.is_level.next = self.character.val() == self.level_mark.val();
        self.level.next = self.levels.val() >> self.row.q.val();

        self.data.next = self.echo.q.val();
        if self.sends.q.val() {
            self.data.next = self.character.val();
            if self.is_level.val() {
                self.data.next = self.digit_0.val();
                if self.level.val().get_bit(0) {
                    self.data.next = self.digit_1.val();
                }
            }
        }
        self.offered.next = (self.sends.q.val() & self.fetched.q.val())
            | (!self.sends.q.val() & self.asked.q.val());
        self.idle.next = !self.sends.q.val() & !self.asked.q.val();

        self.accepted.next = self.sends.q.val() & self.take.val();
        self.ends.next = self.accepted.val() & self.text.val().get_bit(7);
        self.goes_on.next = self.listing.q.val() & (self.row.q.val() != self.last_row.val());
        self.echoed.next = !self.sends.q.val() & self.take.val();

        if self.sends.q.val() {
            self.fetched.d.next = true;
        }
        if self.accepted.val() {
            self.fetched.d.next = false;
            self.letter.d.next = self.letter.q.val() + self.one.val();
        }
        if self.ends.val() {
            self.letter.d.next = self.none.val();
            if self.goes_on.val() {
                self.row.d.next = self.row.q.val() + self.one.val();
            } else {
                self.sends.d.next = false;
                self.listing.d.next = false;
            }
        }
        if self.echoed.val() {
            self.asked.d.next = false;
            self.sends.d.next = true;
            self.listing.d.next = true;
            self.row.d.next = self.none.val();
        }
        if self.walks.val() {
            self.sends.d.next = true;
            self.row.d.next = self.slot.val();
        }
        if self.changed.val() {
            self.sends.d.next = true;
            self.row.d.next = self.scanned.val();
        }
        if self.received_valid.val() {
            self.echo.d.next = self.received.val();
            self.asked.d.next = true;
        }
    }
}

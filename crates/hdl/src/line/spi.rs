//! An SPI peripheral in mode 0: eight bits, most significant first. SCK may be up to a fifth of the
//! clock.
//!
//! ```text
//! select_n  ^^\___________________________________/^^^
//! sck       ______/^^\__/^^\__ ... __/^^\_____________
//! mosi      ---< bit 7 >< bit 6 > ... < bit 0 >--------   sampled where SCK rises
//! miso      ---< bit 7    >< bit 6   > ... < bit 0  >---   changes after SCK has risen
//! ```
//!
//! The module detects a rising SCK two to three clocks later, and samples MOSI then. MISO changes
//! three clocks after SCK has risen. That is after the host has sampled it and before SCK rises
//! again. MISO does not wait for the falling SCK: detecting that edge takes two clocks as well, and
//! the rest of half a bit would be too short at the highest rate.
//!
//! When the link offers no byte, the module sends END. Of several END bytes in sequence the module
//! passes only the first to the link, so that the host can send END bytes in order to read an
//! answer.
//!
//! Cost: two shift registers of 8 bits, a counter of 3 bits, and the synchronizers of the pins.

use crate::primitives::constant::Literal;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::link::END;
use rust_hdl_core::prelude::*;

/// The SPI peripheral. The host is the controller.
#[derive(LogicBlock, Default)]
pub struct Spi {
    /// The clock.
    pub clock: Input<Clock>,
    /// The serial clock from the host; asynchronous.
    pub sck: Input<Bit>,
    /// The select from the host, active low; asynchronous.
    pub select_n: Input<Bit>,
    /// The data from the host; asynchronous.
    pub mosi: Input<Bit>,
    /// The data to the host.
    pub miso: Signal<Out, Bit>,
    /// The received byte, valid in the clocks in which `received_valid` is asserted.
    pub received: Signal<Out, Word<8>>,
    /// Asserted for one clock per received byte.
    pub received_valid: Signal<Out, Bit>,
    /// The byte of the answer that the link offers.
    pub answer: Input<Word<8>>,
    /// The link offers a byte and holds it until the line accepts it. The link must offer the next
    /// byte of a frame within the duration of one byte; otherwise the line sends an END, which ends
    /// the frame early.
    pub answer_valid: Input<Bit>,
    /// The line accepts the offered byte in this clock.
    pub answer_take: Signal<Out, Bit>,
    sck_1: Register<Bit>,
    sck_2: Register<Bit>,
    sck_3: Register<Bit>,
    mosi_1: Register<Bit>,
    mosi_2: Register<Bit>,
    rest_1: Register<Bit>,
    rest_2: Register<Bit>, // 1 while the module is not selected
    bits: Register<Word<8>>,
    goes: Register<Word<8>>,
    count: Register<Word<3>>,
    ended: Register<Bit>, // the last received byte was an END
    rise: Signal<Local, Bit>,
    last: Signal<Local, Bit>,
    comes: Signal<Local, Word<8>>,
    is_end: Signal<Local, Bit>,
    one: Literal<3, 1>,
    none: Literal<3, 0>,
    full: Literal<3, 7>,
    by_one: Literal<1, 1>,
    low: Literal<8, 1>,
    end_byte: Literal<8, { END as u64 }>,
}

impl Spi {
    /// Makes an SPI peripheral that has not received a byte yet.
    pub fn new() -> Self {
        Self {
            rest_1: Register::new(true),
            rest_2: Register::new(true),
            goes: Register::new(Word::from(u64::from(END))),
            ended: Register::new(true),
            ..Self::default()
        }
    }
}

impl Logic for Spi {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self, clock, sck_1, sck_2, sck_3, mosi_1, mosi_2, rest_1, rest_2, bits, goes, count,
            ended
        );
        self.sck_1.d.next = self.sck.val();
        self.sck_2.d.next = self.sck_1.q.val();
        self.sck_3.d.next = self.sck_2.q.val();
        self.mosi_1.d.next = self.mosi.val();
        self.mosi_2.d.next = self.mosi_1.q.val();
        self.rest_1.d.next = self.select_n.val();
        self.rest_2.d.next = self.rest_1.q.val();

        self.rise.next = self.sck_2.q.val() & !self.sck_3.q.val() & !self.rest_2.q.val();
        self.last.next = self.rise.val() & (self.count.q.val() == self.full.val());
        self.comes.next = self.bits.q.val() << self.by_one.val();
        if self.mosi_2.q.val() {
            self.comes.next = (self.bits.q.val() << self.by_one.val()) | self.low.val();
        }
        if self.rise.val() {
            self.bits.d.next = self.comes.val();
            self.goes.d.next = self.goes.q.val() << self.by_one.val();
            self.count.d.next = self.count.q.val() + self.one.val();
        }
        self.is_end.next = self.comes.val() == self.end_byte.val();
        if self.last.val() {
            self.ended.d.next = self.is_end.val();
            self.goes.d.next = self.end_byte.val();
            if self.answer_valid.val() {
                self.goes.d.next = self.answer.val();
            }
        }
        if self.rest_2.q.val() {
            self.count.d.next = self.none.val();
        }

        self.received.next = self.comes.val();
        self.received_valid.next = self.last.val() & !(self.is_end.val() & self.ended.q.val());
        self.answer_take.next = self.last.val() & self.answer_valid.val();
        self.miso.next = self.goes.q.val().get_bit(7);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn spi_synthesizes() {
        assert_synthesizes(Spi::new(), "carrystep_spi");
    }
}

//! A 32-bit shift register that computes the CRC of frames and assembles the words of a segment
//! from their bytes. It processes one bit per clock, eight clocks per byte.
//!
//! ```text
//! step     __/^^^^^^^^^^^^^^^^^\____      the machine holds `step` until `over`
//! count       | 0 | 1 | ... | 7 |
//! over     ________________/^^^\____
//! ```
//!
//! Cost: one register of 32 bits, which both uses share, and a counter of 3 bits.

use crate::primitives::constant::Literal;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

/// The shift register for CRCs and words.
#[derive(LogicBlock, Default)]
pub struct CrcUnit {
    /// The clock.
    pub clock: Input<Clock>,
    /// Loads the register: with all ones, or with `word` if `feed` is set.
    pub begins: Input<Bit>,
    /// The word that `begins` loads if `feed` is set.
    pub word: Input<Word<32>>,
    /// Shifts the register by one bit per clock. It is held for eight clocks.
    pub step: Input<Bit>,
    /// The byte that is processed.
    pub data: Input<Word<8>>,
    /// If 1 during `step`, the byte enters the CRC. If 0, the byte is shifted into the upper end of
    /// the register, and the next byte of the register moves to the lower end.
    pub feed: Input<Bit>,
    /// Asserted in the eighth of the eight clocks.
    pub over: Signal<Out, Bit>,
    /// The content of the register.
    pub word_out: Signal<Out, Word<32>>,
    sum: Register<Word<32>>,
    count: Register<Word<3>>,
    shifted: Signal<Local, Word<8>>,
    data_bit: Signal<Local, Bit>,
    feedback: Signal<Local, Bit>,
    one: Literal<3, 1>,
    last: Literal<3, 7>,
    by_one: Literal<1, 1>,
    ones: Literal<32, 0xffff_ffff>,
    top: Literal<32, 0x8000_0000>,
    polynomial: Literal<32, { carrystep_core::link::CRC_POLYNOMIAL as u64 }>,
}

impl Logic for CrcUnit {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, sum, count);
        self.shifted.next = self.data.val() >> self.count.q.val();
        self.data_bit.next = self.shifted.val().get_bit(0);
        self.feedback.next = self.feed.val() & (self.sum.q.val().get_bit(0) ^ self.data_bit.val());
        if self.step.val() {
            self.count.d.next = self.count.q.val() + self.one.val();
            self.sum.d.next = self.sum.q.val() >> self.by_one.val();
            if !self.feed.val() & self.data_bit.val() {
                self.sum.d.next = (self.sum.q.val() >> self.by_one.val()) ^ self.top.val();
            }
            if self.feedback.val() {
                self.sum.d.next = (self.sum.q.val() >> self.by_one.val()) ^ self.polynomial.val();
            }
        }
        if self.begins.val() & self.feed.val() {
            self.sum.d.next = self.word.val();
        }
        if self.begins.val() & !self.feed.val() {
            self.sum.d.next = self.ones.val();
        }
        self.over.next = self.count.q.val() == self.last.val();
        self.word_out.next = self.sum.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn check_synthesizes() {
        assert_synthesizes(CrcUnit::default(), "carrystep_crc");
    }
}

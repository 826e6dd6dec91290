//! The CRC of frames, both ways, and the words of a segment, made of their bytes: a bit a clock, eight clocks a byte.
//!
//! ```text
//! step     __/^^^^^^^^^^^^^^^^^\____      held until `over`
//! count       | 0 | 1 | ... | 7 |
//! over     ________________/^^^\____
//! ```

use crate::primitives::constant::Literal;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use rust_hdl::prelude::*;

/// The CRC's register.
#[derive(LogicBlock, Default)]
pub struct Check {
    /// The clock.
    pub clock: Input<Clock>,
    /// All ones,
    pub begins: Input<Bit>,
    /// or, with `feed`, this.
    pub word: Input<Word<32>>,
    /// Eight bits further,
    pub step: Input<Bit>,
    /// with this byte fed to it,
    pub data: Input<Word<8>>,
    /// or, if this is not set, shifted in above it: its next byte comes down.
    pub feed: Input<Bit>,
    /// The eighth of eight clocks.
    pub over: Signal<Out, Bit>,
    /// All of it.
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

impl Logic for Check {
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
        assert_synthesizes(Check::default(), "carrystep_check");
    }
}

//! The memory that the host can read: the constants of the build, and the last words of state of
//! every axis.
//!
//! ```text
//! address   0 .. 23                      constants of the build: initial content of the memory
//!           page 2 | item 3 | axis 3     the words of state, as the engine outputs them
//! ```
//!
//! Each word of state is stored in the clock in which the engine outputs it. Of the status the
//! engine outputs 16 bits only; the high half of its word stays 0.
//!
//! Cost: one memory of 256 words of 32 bits, whose halves are written separately.

use crate::primitives::constant::Literal;
use crate::primitives::formula::Formula;
use crate::primitives::memory::Memory;
use crate::primitives::register::Input;
use crate::primitives::word::{Word, bit_cast};
use rust_hdl_core::prelude::*;

/// The memory of constants and of the state of the axes.
#[derive(LogicBlock, Default)]
pub struct RegisterMirror {
    /// The clock.
    pub clock: Input<Clock>,
    /// The address to read.
    pub address: Input<Word<8>>,
    /// The word at the address of the clock before.
    pub data: Signal<Out, Word<32>>,
    /// The engine outputs a word of state in this clock.
    pub state_valid: Input<Bit>,
    /// Its page.
    pub state_page: Input<Word<2>>,
    /// Its axis.
    pub state_axis: Input<Word<3>>,
    /// Its item.
    pub state_item: Input<Word<3>>,
    /// The word.
    pub state: Input<Word<32>>,
    known: Memory<8, 32>,
    low_written: Signal<Local, Word<32>>,
    high_written: Signal<Local, Word<32>>,
    place: Signal<Local, Word<8>>,
    at_3: Literal<3, 3>,
    at_6: Literal<3, 6>,
    status: Literal<3, 7>,
    none: Literal<32, 0>,
    low_half: Literal<32, 0xffff>,
    high_half: Literal<32, 0xffff_0000>,
}

impl RegisterMirror {
    /// Makes the memory with these constants, each given as its address and its value.
    pub fn new(facts: &[(u8, Formula<32>)]) -> Self {
        let words: Vec<_> =
            facts.iter().map(|(address, fact)| (usize::from(*address), fact.clone())).collect();
        Self { known: Memory::of_halves(&words), ..Self::default() }
    }
}

impl Logic for RegisterMirror {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, known);
        self.known.read_address.next = self.address.val();
        self.data.next = self.known.read_data.val();

        self.place.next = (bit_cast::<8, 2>(self.state_page.val()) << self.at_6.val())
            | (bit_cast::<8, 3>(self.state_item.val()) << self.at_3.val())
            | bit_cast::<8, 3>(self.state_axis.val());
        self.known.write_address.next = self.place.val();
        self.known.write_data.next = self.state.val();
        self.low_written.next = self.none.val();
        if self.state_valid.val() {
            self.low_written.next = self.low_half.val();
        }
        self.high_written.next = self.none.val();
        if self.state_valid.val() & (self.state_item.val() != self.status.val()) {
            self.high_written.next = self.high_half.val();
        }
        self.known.write_bits.next = self.low_written.val() | self.high_written.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn register_mirror_synthesizes() {
        assert_synthesizes(
            RegisterMirror::new(&[(0, Formula::number(7))]),
            "carrystep_register_mirror",
        );
    }
}

//! The memory that the host can read: the constants of the build, and the last known state of each
//! axis.
//!
//! ```text
//! address   0 .. 31              constants of the build, part of the initial content of the memory
//!           64 + 8 axis + item   0 1 P   2 position   3 discarded   4 the position at the limit
//! ```
//!
//! The module requests items 0 to 3 of all axes from the engine in a continuous cycle, so that the
//! stored values are at most a few ticks old. An axis that waits for its limit outputs its position
//! in each of its time slots (`latch`); item 4 keeps the last of these positions.
//!
//! Cost: one memory of 128 words of 32 bits and a counter of 5 bits.

use crate::primitives::constant::Literal;
use crate::primitives::formula::Formula;
use crate::primitives::memory::Memory;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use rust_hdl::prelude::*;

/// The memory of constants and of the state of the axes.
#[derive(LogicBlock, Default)]
pub struct RegisterMirror {
    /// The clock.
    pub clock: Input<Clock>,
    /// The address to read.
    pub address: Input<Word<7>>,
    /// The word at the address of the clock before.
    pub data: Signal<Out, Word<32>>,
    /// The axis that is requested from the engine.
    pub get_axis: Signal<Out, Word<3>>,
    /// The item that is requested from the engine.
    pub get_item: Signal<Out, Word<2>>,
    /// The value that the engine returns.
    pub get_data: Input<Word<32>>,
    /// `get_data` is the value of the requested item.
    pub get_valid: Input<Bit>,
    /// `get_data` is the position of the axis `latch_axis`, which waits for its limit.
    pub latch: Input<Bit>,
    /// The axis of `latch`.
    pub latch_axis: Input<Word<3>>,
    /// The last item of the last axis arrives in this clock, so that one cycle through all items is
    /// complete.
    pub scanned: Signal<Out, Bit>,
    known: Memory<7, 32>,
    asked: Register<Word<5>>,
    place: Signal<Local, Word<7>>,
    bits: Signal<Local, Word<32>>,
    one: Literal<5, 1>,
    last_item: Literal<5, 31>,
    at_3: Literal<3, 3>,
    of_axes: Literal<7, 0x40>,
    latched: Literal<7, 0x44>,
    none: Literal<32, 0>,
    all: Literal<32, 0xffff_ffff>,
}

impl RegisterMirror {
    /// Makes the memory with these constants, each given as its address and its value.
    pub fn new(facts: &[(u8, Formula<32>)]) -> Self {
        let words: Vec<_> =
            facts.iter().map(|(address, fact)| (usize::from(*address), fact.clone())).collect();
        Self { known: Memory::of_formulas(&words), ..Self::default() }
    }
}

impl Logic for RegisterMirror {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, asked);
        clock!(self, clock, known);
        if self.get_valid.val() {
            self.asked.d.next = self.asked.q.val() + self.one.val();
        }
        self.scanned.next = self.get_valid.val() & (self.asked.q.val() == self.last_item.val());
        self.get_item.next = self.asked.q.val().get_bits::<2>(0);
        self.get_axis.next = self.asked.q.val().get_bits::<3>(2);

        self.known.read_address.next = self.address.val();
        self.data.next = self.known.read_data.val();
        self.place.next = self.of_axes.val()
            | (bit_cast::<7, 3>(self.asked.q.val().get_bits::<3>(2)) << self.at_3.val())
            | bit_cast::<7, 2>(self.asked.q.val().get_bits::<2>(0));
        if self.latch.val() {
            self.place.next =
                self.latched.val() | (bit_cast::<7, 3>(self.latch_axis.val()) << self.at_3.val());
        }
        self.known.write_address.next = self.place.val();
        self.known.write_data.next = self.get_data.val();
        self.bits.next = self.none.val();
        if self.latch.val() | self.get_valid.val() {
            self.bits.next = self.all.val();
        }
        self.known.write_bits.next = self.bits.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn facts_synthesizes() {
        assert_synthesizes(
            RegisterMirror::new(&[(0, Formula::number(7))]),
            "carrystep_register_mirror",
        );
    }
}

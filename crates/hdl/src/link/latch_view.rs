//! What a host reads of several latches: the record of one of them, and the state of all in one
//! word.
//!
//! ```text
//! address   0x0d                         the state of all latches
//!           3 in bits 7..6, not item 2   the words of the record that the chosen latch holds
//!           other                        what the register mirror has there
//! ```
//!
//! A memory of its own keeps four records of 64 words. The words of the engine's page 3 are stored
//! in the record that the engine names, but for those of switches, which are in the register mirror.
//!
//! Interface: the byte that the host writes arms latches (bits 3..0), and chooses the latch whose
//! record is read from now on (bits 5..4).
//!
//! Cost: one memory of 256 words of 32 bits, whose halves are written separately, four flip-flops,
//! and some 60 cells that put these words in place of those of the register mirror.

use crate::parameters::LATCH_LOOKS;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::formula::Formula;
use crate::primitives::memory::Memory;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::engine::{Guard, MAX_LATCHES};
use carrystep_core::link::registers::LATCHES;
use rust_hdl_core::prelude::*;

/// The records of several latches.
#[derive(LogicBlock, Default)]
pub struct LatchView {
    /// The clock.
    pub clock: Input<Clock>,
    /// The address to read.
    pub address: Input<Word<8>>,
    /// The word of the register mirror at the address of the clock before.
    pub facts: Input<Word<32>>,
    /// The word at the address of the clock before.
    pub data: Signal<Out, Word<32>>,
    /// The host writes `byte`.
    pub writes: Input<Bit>,
    /// The latches to arm in bits 3 to 0, the latch to read in bits 5 and 4.
    pub byte: Input<Word<8>>,
    /// The host arms latch 0.
    pub first_arm: Signal<Out, Bit>,
    /// The host arms these latches from 1 on.
    pub arm: Signal<Out, Word<3>>,
    /// Latch 0 waits for its edge.
    pub first_armed: Input<Bit>,
    /// The edges since it was armed that it did not latch.
    pub first_edges: Input<Word<4>>,
    /// The latches from 1 on that wait for their edges.
    pub armed: Input<Word<3>>,
    /// The edges of each of them, four bits each.
    pub edges: Input<Word<12>>,
    /// The record that each latch from 0 on holds, two bits each.
    pub records: Input<Word<8>>,
    /// The engine outputs a word of state in this clock.
    pub state_valid: Input<Bit>,
    /// Its page.
    pub state_page: Input<Word<2>>,
    /// Its record, if the page is 3.
    pub state_record: Input<Word<2>>,
    /// Its axis.
    pub state_axis: Input<Word<3>>,
    /// Its item.
    pub state_item: Input<Word<3>>,
    /// The word.
    pub state: Input<Word<32>>,
    kept: Memory<8, 32>,
    chosen: Register<Word<2>>,
    was_state: Register<Bit>, // the address of the clock before is that of all latches
    was_record: Register<Bit>, // it is one of a record
    record: Signal<Local, Word<2>>,
    place: Signal<Local, Word<8>>,
    stores: Signal<Local, Bit>,
    low_written: Signal<Local, Word<32>>,
    high_written: Signal<Local, Word<32>>,
    all: Signal<Local, Word<32>>, // the state of all latches
    exist: Parameter<32>,
    at_1: Literal<5, 1>,
    at_3: Literal<5, 3>,
    at_6: Literal<5, 6>,
    at_8: Literal<5, 8>,
    at_16: Literal<5, 16>,
    at_20: Literal<5, 20>,
    no_latch: Literal<3, 0>,
    first: Literal<32, 1>,
    one: Literal<2, 1>,
    two: Literal<2, 2>,
    three: Literal<2, 3>,
    of_switch: Literal<3, 2>,
    status: Literal<3, 7>,
    of_all: Literal<8, { LATCHES as u64 }>,
    none: Literal<32, 0>,
    low_half: Literal<32, 0xffff>,
    high_half: Literal<32, 0xffff_0000>,
}

impl LatchView {
    /// Makes the view of this guard's latches. The caller has checked the guard.
    pub fn new(guard: &Guard) -> Self {
        let bit = |number: usize| {
            let looks = guard.latches.get(number).map_or(0, |latch| latch.looks);
            let looks = LATCH_LOOKS.of_latch::<32>(number, looks);
            let exists = looks.whole().is_not(&Formula::number(0));
            Formula::number(16 << number).where_or(&exists, Formula::number(0))
        };
        let exist = (1..MAX_LATCHES).fold(bit(0), |all, number| all | bit(number));
        Self { kept: Memory::of_halves(&[]), exist: Parameter::of(&exist), ..Self::default() }
    }
}

impl Logic for LatchView {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, chosen, was_state, was_record);
        clock!(self, clock, kept);

        // What the host writes.
        self.first_arm.next = self.writes.val() & self.byte.val().get_bit(0);
        self.arm.next = self.no_latch.val();
        if self.writes.val() {
            self.arm.next = self.byte.val().get_bits::<3>(1);
        }
        if self.writes.val() {
            self.chosen.d.next = self.byte.val().get_bits::<2>(4);
        }

        // What it reads.
        self.record.next = self.records.val().get_bits::<2>(0);
        if self.chosen.q.val() == self.one.val() {
            self.record.next = self.records.val().get_bits::<2>(2);
        }
        if self.chosen.q.val() == self.two.val() {
            self.record.next = self.records.val().get_bits::<2>(4);
        }
        if self.chosen.q.val() == self.three.val() {
            self.record.next = self.records.val().get_bits::<2>(6);
        }
        self.kept.read_address.next = (bit_cast::<8, 2>(self.record.val()) << self.at_6.val())
            | bit_cast::<8, 6>(self.address.val().get_bits::<6>(0));
        self.was_state.d.next = self.address.val() == self.of_all.val();
        self.was_record.d.next = self.address.val().get_bit(7)
            & self.address.val().get_bit(6)
            & (self.address.val().get_bits::<3>(3) != self.of_switch.val());
        self.all.next = self.exist.val()
            | (bit_cast::<32, 3>(self.armed.val()) << self.at_1.val())
            | (bit_cast::<32, 8>(self.records.val()) << self.at_8.val())
            | (bit_cast::<32, 4>(self.first_edges.val()) << self.at_16.val())
            | (bit_cast::<32, 12>(self.edges.val()) << self.at_20.val());
        if self.first_armed.val() {
            self.all.next = self.all.val() | self.first.val();
        }
        self.data.next = self.facts.val();
        if self.was_state.q.val() {
            self.data.next = self.all.val();
        }
        if self.was_record.q.val() {
            self.data.next = self.kept.read_data.val();
        }

        // The words of a record.
        self.stores.next = self.state_valid.val()
            & (self.state_page.val() == self.three.val())
            & (self.state_item.val() != self.of_switch.val());
        self.place.next = (bit_cast::<8, 2>(self.state_record.val()) << self.at_6.val())
            | (bit_cast::<8, 3>(self.state_item.val()) << self.at_3.val())
            | bit_cast::<8, 3>(self.state_axis.val());
        self.kept.write_address.next = self.place.val();
        self.kept.write_data.next = self.state.val();
        self.low_written.next = self.none.val();
        if self.stores.val() {
            self.low_written.next = self.low_half.val();
        }
        self.high_written.next = self.none.val();
        if self.stores.val() & (self.state_item.val() != self.status.val()) {
            self.high_written.next = self.high_half.val();
        }
        self.kept.write_bits.next = self.low_written.val() | self.high_written.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn latch_view_synthesizes() {
        assert_synthesizes(LatchView::new(&Guard::minimal(Vec::new())), "carrystep_latch_view");
    }
}

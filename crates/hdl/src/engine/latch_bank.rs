//! Latches 1 to 3 of a build with several latches, and the records that all latches hold.
//!
//! ```text
//! latches of 0   ______/^^^^^^^^^\____________________   0 and 1 accept edges at one strobe:
//! latches of 1   ______/^^^^^^^^^\_________/^^^^^^^^^\_   both hold record 1
//! record         0.....|1.................|2.........   the record to which a tick's words belong
//! record of 1    0.....|1.................|2.........   latch 1 was armed again, latch 0 holds 1
//! ```
//!
//! The words of a tick can be output on one page only. Latches that accept their edges at the same
//! strobe therefore share a record, the lowest one that no latch holds. A latch holds its record
//! while it is not armed, so that no other latch overwrites what the host has not read yet. Of four
//! latches at most three hold a record while one waits for its edge, so that a record is free.
//!
//! Interface: latch 0 is a part of its own beside this one, which takes what it outputs.
//!
//! Cost: the latches, two flip-flops for each latch and two more, and about twenty cells. A latch
//! that the build does not have costs nothing.

use super::edge_latch::EdgeLatch;
use crate::parameters::LATCH_LOOKS;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::formula::Formula;
use crate::primitives::per_axis::PerAxis;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::engine::{Guard, MAX_LATCHES};
use rust_hdl_core::prelude::*;

/// Number of latches besides latch 0.
pub const MORE: usize = MAX_LATCHES - 1;

/// Latches 1 to 3, and the records of all latches.
#[derive(LogicBlock, Default)]
pub struct LatchBank {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick.
    pub strobe: Input<Bit>,
    /// The pins of latches 1 to 3; asynchronous.
    pub pins: Input<Word<MORE>>,
    /// The host arms these latches; bit 0 is latch 1.
    pub arm: Input<Word<MORE>>,
    /// A reset: the latches return to their state at configuration.
    pub resetting: Input<Bit>,
    /// Latch 0 waits for its edge.
    pub first_armed: Input<Bit>,
    /// At a strobe: the next tick outputs the words of latch 0.
    pub first_comes: Input<Bit>,
    /// This tick outputs the words of latch 0.
    pub first_latches: Input<Bit>,
    /// At a strobe: the next tick outputs the words of some latch.
    pub comes: Signal<Out, Bit>,
    /// This tick outputs the words of some latch.
    pub latches: Signal<Out, Bit>,
    /// The latches from 1 on that wait for their edges.
    pub armed: Signal<Out, Word<MORE>>,
    /// The edges of each latch from 1 on that it did not latch, four bits each, at most 15.
    pub edges: Signal<Out, Word<12>>,
    /// The number of the record that each latch from 0 on holds, two bits each.
    pub records: Signal<Out, Word<8>>,
    /// The number of the record to which the words of this tick belong, if a latch latches them.
    pub record: Signal<Out, Word<2>>,
    /// The host arms a latch that the build does not have.
    pub absent: Signal<Out, Bit>,
    edge_latch: PerAxis<EdgeLatch, MORE>,
    held_0: Register<Word<2>>, // the record of latch 0
    held_1: Register<Word<2>>,
    held_2: Register<Word<2>>,
    held_3: Register<Word<2>>,
    now: Register<Word<2>>,           // `record`
    accepts: Signal<Local, Bit>,      // `comes`
    some: Signal<Local, Bit>,         // `latches`
    strays: Signal<Local, Bit>,       // `absent`
    waits: Signal<Local, Word<MORE>>, // `armed`
    // Each latch from 1 on exists and is not armed, so that it holds its record.
    holds: PerAxis<Signal<Local, Bit>, MORE>,
    edges_1: Signal<Local, Word<4>>,
    edges_2: Signal<Local, Word<4>>,
    edges_3: Signal<Local, Word<4>>,
    taken: Signal<Local, Word<4>>, // the records that latches hold
    free: Signal<Local, Word<2>>,  // the lowest record that no latch holds
    exists: PerAxis<Parameter<1>, MORE>,
    bit_of: PerAxis<Parameter<MORE>, MORE>,
    no_record: Literal<4, 0>,
    one_record: Literal<4, 1>,
    no_latch: Literal<MORE, 0>,
    zero: Literal<2, 0>,
    one: Literal<2, 1>,
    two: Literal<2, 2>,
    three: Literal<2, 3>,
    at_2: Literal<4, 2>,
    at_4: Literal<4, 4>,
    at_6: Literal<4, 6>,
    at_8: Literal<4, 8>,
}

impl LatchBank {
    /// Makes the latches of this guard from latch 1 on. The caller has checked the guard.
    pub fn new(guard: &Guard) -> Self {
        let latch = |place: usize| guard.latches.get(place + 1);
        let exists = |place: usize| {
            let looks = latch(place).map_or(0, |latch| latch.looks);
            let looks = LATCH_LOOKS.of_latch::<32>(place + 1, looks);
            Parameter::of(&looks.whole().is_not(&Formula::number(0)))
        };
        Self {
            edge_latch: PerAxis::from_fn(|place| EdgeLatch::new(latch(place))),
            exists: PerAxis::from_fn(exists),
            bit_of: PerAxis::from_fn(|place| Parameter::new(1 << place)),
            ..Self::default()
        }
    }
}

impl Logic for LatchBank {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, held_0, held_1, held_2, held_3, now);

        // The latches.
        self.accepts.next = self.first_comes.val();
        self.some.next = self.first_latches.val();
        self.strays.next = false;
        self.waits.next = self.no_latch.val();
        for i in 0..MORE {
            self.edge_latch[i].clock.next = self.clock.val();
            self.edge_latch[i].strobe.next = self.strobe.val();
            self.edge_latch[i].pin.next = self.pins.val().get_bit(i);
            self.edge_latch[i].arm.next = self.arm.val().get_bit(i);
            self.edge_latch[i].resetting.next = self.resetting.val();

            self.accepts.next = self.accepts.val() | self.edge_latch[i].comes.val();
            self.some.next = self.some.val() | self.edge_latch[i].latches.val();
            self.strays.next =
                self.strays.val() | (self.arm.val().get_bit(i) & !self.exists[i].val().any());
            if self.edge_latch[i].armed.val() {
                self.waits.next = self.waits.val() | self.bit_of[i].val();
            }
            self.holds[i].next = !self.edge_latch[i].armed.val() & self.exists[i].val().any();
        }

        // The records that latches hold, and the lowest one that none holds.
        self.taken.next = self.no_record.val();
        if !self.first_armed.val() {
            self.taken.next = self.taken.val() | (self.one_record.val() << self.held_0.q.val());
        }
        for i in 0..1 {
            self.edges_1.next = self.edge_latch[i].edges.val();
            if self.holds[i].val() {
                self.taken.next = self.taken.val() | (self.one_record.val() << self.held_1.q.val());
            }
        }
        for i in 1..2 {
            self.edges_2.next = self.edge_latch[i].edges.val();
            if self.holds[i].val() {
                self.taken.next = self.taken.val() | (self.one_record.val() << self.held_2.q.val());
            }
        }
        for i in 2..MORE {
            self.edges_3.next = self.edge_latch[i].edges.val();
            if self.holds[i].val() {
                self.taken.next = self.taken.val() | (self.one_record.val() << self.held_3.q.val());
            }
        }
        self.free.next = self.three.val();
        if !self.taken.val().get_bit(2) {
            self.free.next = self.two.val();
        }
        if !self.taken.val().get_bit(1) {
            self.free.next = self.one.val();
        }
        if !self.taken.val().get_bit(0) {
            self.free.next = self.zero.val();
        }

        // The latches that accept their edges take it.
        if self.first_comes.val() {
            self.held_0.d.next = self.free.val();
        }
        for i in 0..1 {
            if self.edge_latch[i].comes.val() {
                self.held_1.d.next = self.free.val();
            }
        }
        for i in 1..2 {
            if self.edge_latch[i].comes.val() {
                self.held_2.d.next = self.free.val();
            }
        }
        for i in 2..MORE {
            if self.edge_latch[i].comes.val() {
                self.held_3.d.next = self.free.val();
            }
        }
        if self.accepts.val() {
            self.now.d.next = self.free.val();
        }
        if self.resetting.val() {
            self.held_0.d.next = self.zero.val();
            self.held_1.d.next = self.zero.val();
            self.held_2.d.next = self.zero.val();
            self.held_3.d.next = self.zero.val();
            self.now.d.next = self.zero.val();
        }

        self.comes.next = self.accepts.val();
        self.latches.next = self.some.val();
        self.absent.next = self.strays.val();
        self.armed.next = self.waits.val();
        self.edges.next = bit_cast::<12, 4>(self.edges_1.val())
            | (bit_cast::<12, 4>(self.edges_2.val()) << self.at_4.val())
            | (bit_cast::<12, 4>(self.edges_3.val()) << self.at_8.val());
        self.records.next = bit_cast::<8, 2>(self.held_0.q.val())
            | (bit_cast::<8, 2>(self.held_1.q.val()) << self.at_2.val())
            | (bit_cast::<8, 2>(self.held_2.q.val()) << self.at_4.val())
            | (bit_cast::<8, 2>(self.held_3.q.val()) << self.at_6.val());
        self.record.next = self.now.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;
    use carrystep_core::engine::Latch;

    #[test]
    fn latch_bank_synthesizes() {
        let latches = vec![Latch::of_pin(false, 1), Latch::of_pin(true, 3)];
        let guard = Guard { latches, ..Guard::minimal(Vec::new()) };
        assert_synthesizes(LatchBank::new(&guard), "carrystep_latch_bank");
    }
}

//! The latch: an edge of its pin makes the next tick output the state of all axes on a page of its
//! own, while motion goes on.
//!
//! ```text
//! pin       _______/^^^^^^^^^^^^^^^^^^^^^^^^^^^^
//! strobe    ____/^\________/^\________/^\_______     two looks
//! accepted  ___________________________/^^^^^^^^
//! latches   ___________________________/^^^^^^^^^^^\____   this tick's words are latched
//! ```
//!
//! The pin is synchronized, and an edge is accepted at the last of as many strobes in sequence as
//! the build specifies (1 to 16), which all find the pin active.
//!
//! Interface: the host arms the latch for one edge. Further edges are counted, up to 15.
//!
//! Cost: ten flip-flops and some cells with one look, up to four more of each with 16 looks. A
//! build without the latch has none of them.

use crate::parameters::{LATCH_LOOKS, LATCH_LOW};
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::engine::{Latch, MAX_LOOKS};
use rust_hdl_core::prelude::*;

/// The edges of the latch's pin.
#[derive(LogicBlock, Default)]
pub struct EdgeLatch {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick.
    pub strobe: Input<Bit>,
    /// The pin; asynchronous.
    pub pin: Input<Bit>,
    /// The host arms the latch.
    pub arm: Input<Bit>,
    /// A reset: the latch returns to its state at configuration.
    pub resetting: Input<Bit>,
    /// At a strobe: the next tick outputs the words of the latch.
    pub comes: Signal<Out, Bit>,
    /// This tick outputs the words of the latch.
    pub latches: Signal<Out, Bit>,
    /// The latch waits for its edge.
    pub armed: Signal<Out, Bit>,
    /// The edges since it was armed that it did not latch, at most 15.
    pub edges: Signal<Out, Word<4>>,
    sync: Register<Bit>, // first flip-flop of the synchronizer
    now: Register<Bit>,  // the synchronized pin
    accepted: Register<Bit>,
    count: Register<Word<4>>,
    waits: Register<Bit>,       // `armed`
    copies: Register<Bit>,      // `latches`
    further: Register<Word<4>>, // `edges`
    differs: Signal<Local, Bit>,
    ripe: Signal<Local, Bit>,
    rises: Signal<Local, Bit>, // at a strobe
    exists: Parameter<1>,
    low: Parameter<1>,
    last_look: Parameter<4>,
    count_bits: Parameter<4>,
    one: Literal<4, 1>,
    none: Literal<4, 0>,
    most: Literal<4, 15>,
    latch_looks_out_of_range: ParameterRefusal,
    latch_low_out_of_range: ParameterRefusal,
}

impl EdgeLatch {
    /// Makes this latch of a guard. The caller has checked the guard.
    pub fn new(latch: Option<&Latch>) -> Self {
        let looks = LATCH_LOOKS.of::<32>(latch.map_or(0, |latch| latch.looks));
        let low = LATCH_LOW.of::<32>(latch.is_some_and(|latch| latch.low));
        let last_look = || looks.bits::<4>(0) - Formula::number(1);
        Self {
            exists: Parameter::of(&looks.whole().is_not(&Formula::number(0))),
            low: Parameter::of(&low.bits(0)),
            last_look: Parameter::of(&last_look()),
            count_bits: Parameter::of(&last_look().used_bits()),
            latch_looks_out_of_range: ParameterRefusal::of(&looks.is_outside(0, MAX_LOOKS.into())),
            latch_low_out_of_range: ParameterRefusal::of(&low.is_outside(0, 1)),
            ..Self::default()
        }
    }
}

impl Logic for EdgeLatch {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, sync, now, accepted, count, waits, copies, further);

        self.sync.d.next = (self.pin.val() ^ self.low.val().any()) & self.exists.val().any();
        self.now.d.next = self.sync.q.val();

        // The edges.
        self.differs.next = self.now.q.val() ^ self.accepted.q.val();
        self.ripe.next = self.count.q.val() == self.last_look.val();
        self.rises.next =
            self.strobe.val() & self.now.q.val() & !self.accepted.q.val() & self.ripe.val();
        if self.strobe.val() {
            self.count.d.next = self.none.val();
            if self.differs.val() & self.ripe.val() {
                self.accepted.d.next = self.now.q.val();
            }
            if self.differs.val() & !self.ripe.val() {
                self.count.d.next = (self.count.q.val() + self.one.val()) & self.count_bits.val();
            }
            self.copies.d.next = self.rises.val() & self.waits.q.val();
        }

        // The edge for which the latch is armed, and those after it.
        if self.rises.val() {
            self.waits.d.next = false;
            if !self.waits.q.val() & (self.further.q.val() != self.most.val()) {
                self.further.d.next = self.further.q.val() + self.one.val();
            }
        }
        if self.arm.val() {
            self.waits.d.next = self.exists.val().any();
            self.further.d.next = self.none.val();
        }
        if self.resetting.val() {
            self.accepted.d.next = false;
            self.count.d.next = self.none.val();
            self.copies.d.next = false;
            self.waits.d.next = false;
            self.further.d.next = self.none.val();
        }

        self.comes.next = self.rises.val() & self.waits.q.val();
        self.latches.next = self.copies.q.val();
        self.armed.next = self.waits.q.val();
        self.edges.next = self.further.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn edge_latch_synthesizes() {
        for looks in [1, 16] {
            let latch = Latch::of_pin(true, looks);
            assert_synthesizes(
                EdgeLatch::new(Some(&latch)),
                &format!("carrystep_edge_latch_{looks}"),
            );
        }
    }
}

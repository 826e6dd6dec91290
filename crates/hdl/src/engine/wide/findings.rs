//! Brings the causes of stops that the lanes find in one clock to the stop control, which takes one
//! cause in a clock.
//!
//! ```text
//! beat 12   _/^\____________   each lane may find a cause
//! ended     ___/^\__________   that of the axis with the lowest number is told, with its axis
//! again     _____/^\________   the freezing ones are told, whichever lane has found them
//! ```
//!
//! The first clock determines cause and culprit. The second one makes the engine freeze if any lane
//! has found a cause that does, although the cause that is latched may not be one.
//!
//! Interface: [`super::super::stops`] takes the outputs as if they were those of a time slot, one or
//! two clocks later. A tick must have a clock more for it than an engine with one adder needs.
//!
//! Cost: three flip-flops per lane, one per time slot and three others.

use crate::primitives::compiled_once;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::per_axis::PerAxis;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

/// What the K lanes of an engine of N axes find in their time slots.
#[derive(LogicBlock, Default)]
pub struct Findings<const N: usize, const K: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last beat of a time slot. The inputs of the lanes are valid in this clock.
    pub time_slot_ends: Input<Bit>,
    /// The axis of lane 0, one-hot.
    pub axis_one_hot: Input<Word<N>>,
    /// An axis of this time slot runs in this tick.
    pub runs: Input<Bit>,
    /// V of the axis of a lane is out of range; bit k is lane k.
    pub too_fast: Input<Word<K>>,
    /// It has reached a limit.
    pub limit: Input<Word<K>>,
    /// It needs a segment, and its queue is empty.
    pub dry: Input<Word<K>>,
    /// The following outputs are valid.
    pub tells: Signal<Out, Bit>,
    /// The axis with the lowest number that has found a cause, one-hot.
    pub culprit: Signal<Out, Word<N>>,
    /// An axis of this time slot runs.
    pub some_run: Signal<Out, Bit>,
    /// V of the culprit, or in the second clock of any axis, is out of range.
    pub is_too_fast: Signal<Out, Bit>,
    /// The culprit, or in the second clock any axis, has reached a limit.
    pub is_limit: Signal<Out, Bit>,
    /// The culprit needs a segment.
    pub is_dry: Signal<Out, Bit>,
    ended: Register<Bit>,
    again: Register<Bit>,
    slot: Register<Word<N>>,
    ran: Register<Bit>, // `some_run`
    fast: Register<Word<K>>,
    limits: Register<Word<K>>,
    dries: Register<Word<K>>,
    all: Signal<Local, Word<K>>,
    lowest: Signal<Local, Word<K>>, // the lane of the culprit, one-hot
    who: Signal<Local, Word<N>>,    // `culprit`
    who_bit: PerAxis<Signal<Local, Word<N>>, K>,
    by_lane: PerAxis<Parameter<3>, K>,
    no_lanes: Literal<K, 0>,
    no_axes: Literal<N, 0>,
}

impl<const N: usize, const K: usize> Findings<N, K> {
    /// Makes it for N axes in K lanes.
    pub fn new() -> Self {
        Self { by_lane: PerAxis::from_fn(|lane| Parameter::new(lane as u64)), ..Self::default() }
    }
}

compiled_once::logic!(Findings<N = 8, K = 6>);

impl<const N: usize, const K: usize> compiled_once::Kernel for Findings<N, K> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, ended, again, slot, ran, fast, limits, dries);

        // What the lanes find.
        if self.time_slot_ends.val() {
            self.slot.d.next = self.axis_one_hot.val();
            self.ran.d.next = self.runs.val();
            self.fast.d.next = self.too_fast.val();
            self.limits.d.next = self.limit.val();
            self.dries.d.next = self.dry.val();
        }
        self.ended.d.next = self.time_slot_ends.val();
        self.again.d.next = self.ended.q.val();

        // The lowest lane that has found a cause: its axis has the lowest number.
        self.all.next = self.fast.q.val() | self.limits.q.val() | self.dries.q.val();
        self.lowest.next = self.all.val() & (self.no_lanes.val() - self.all.val());
        self.who.next = self.no_axes.val();
        for k in 0..K {
            self.who_bit[k].next = self.no_axes.val();
            if self.lowest.val().get_bit(k) {
                self.who_bit[k].next = self.slot.q.val() << self.by_lane[k].val();
            }
            self.who.next = self.who.val() | self.who_bit[k].val();
        }

        self.tells.next = self.ended.q.val() | self.again.q.val();
        self.culprit.next = self.who.val();
        self.some_run.next = self.ran.q.val();
        self.is_too_fast.next = (self.ended.q.val()
            & (self.fast.q.val() & self.lowest.val()).any())
            | (self.again.q.val() & self.fast.q.val().any());
        self.is_limit.next = (self.ended.q.val() & (self.limits.q.val() & self.lowest.val()).any())
            | (self.again.q.val() & self.limits.q.val().any());
        self.is_dry.next = self.ended.q.val() & (self.dries.q.val() & self.lowest.val()).any();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn findings_synthesizes() {
        assert_synthesizes(Findings::<6, 2>::new(), "carrystep_findings_2");
        assert_synthesizes(Findings::<6, 6>::new(), "carrystep_findings_6");
    }
}

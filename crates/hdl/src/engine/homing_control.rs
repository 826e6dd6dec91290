//! Homing: when an axis that waits for its limit reaches it, only this axis ramps down, and its
//! queue is emptied.
//!
//! ```text
//! set      /^\_______________________________________   the host sets which axes wait
//! waits    __/^^^^^^^^^^^^^^^^^^^^^\__________________   one bit per axis; output `axes`
//! hit      _______________________/^\________________   in the last beat of the axis' slot
//! slows    _________________________/^^^^^^^^^^^^\____   in its slots only, until it rests
//! ```
//!
//! Interface: the host sets the mask of waiting axes; [`super::limits`] reports a reached limit;
//! the queue ramps the axis down while `slows` is asserted in its time slot. The ramp begins in the
//! tick after the one in which the limit was reached, because `slows` is still low in that tick's
//! slot. So an armed start waits for an axis in its ramp, but not for an axis that reaches its
//! limit in the last tick that it executes.
//!
//! Cost: two flip-flops per axis, and one that provides `slows` from the first beat of a slot on.

use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use rust_hdl::prelude::*;

/// The axes that wait for their limit, and those that have reached it and ramp down.
#[derive(LogicBlock, Default)]
pub struct HomingControl<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// The host replaces the mask of the axes that wait for their limit.
    pub set: Input<Bit>,
    /// The new mask, valid with `set`; bit i is axis i.
    pub mask: Input<Word<N>>,
    /// Asserted in the last beat of a time slot.
    pub time_slot_ends: Input<Bit>,
    /// The axis of the time slot, one-hot.
    pub axis_one_hot: Input<Word<N>>,
    /// The axis of the slot has reached a limit.
    pub hit: Input<Bit>,
    /// The axis of the slot runs in the next tick too.
    pub goes_on: Input<Bit>,
    /// A reset: no axis waits for its limit any more.
    pub resetting: Input<Bit>,
    /// The axes that wait for their limit; bit i is axis i.
    pub axes: Signal<Out, Word<N>>,
    /// The axis of the slot waits for its limit.
    pub waits: Signal<Out, Bit>,
    /// The axis of the slot has reached its limit in an earlier tick and ramps down.
    pub slows: Signal<Out, Bit>,
    /// In the last beat of a slot: its axis has waited for its limit and has reached it.
    pub caught: Signal<Out, Bit>,
    waiting: Register<Word<N>>,
    slowing: Register<Word<N>>,
    mine: Signal<Local, Bit>,
    axis_one_hot_next: Signal<Local, Word<N>>,
    // Registered, because the whole ramp depends on it from the first beat of the slot.
    mine_slows: Register<Bit>,
    found: Signal<Local, Bit>, // `caught`
    slower: Signal<Local, Word<N>>,
    none: Literal<N, 0>,
    by_one: Literal<1, 1>,
    to_top: Parameter<3>,
}

impl<const N: usize> HomingControl<N> {
    /// Makes the homing of N axes.
    pub fn new() -> Self {
        Self { to_top: Parameter::new(N as u64 - 1), ..Self::default() }
    }
}

impl<const N: usize> Logic for HomingControl<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, waiting, slowing, mine_slows);
        self.mine.next = (self.waiting.q.val() & self.axis_one_hot.val()).any();
        self.axis_one_hot_next.next = self.axis_one_hot.val();
        if self.time_slot_ends.val() {
            self.axis_one_hot_next.next = (self.axis_one_hot.val() << self.by_one.val())
                | (self.axis_one_hot.val() >> self.to_top.val());
        }
        self.mine_slows.d.next = (self.slowing.q.val() & self.axis_one_hot_next.val()).any();
        self.found.next = self.hit.val() & self.mine.val();

        if self.found.val() {
            self.waiting.d.next = self.waiting.q.val() & !self.axis_one_hot.val();
        }
        if self.set.val() {
            self.waiting.d.next = self.mask.val();
        }
        if self.resetting.val() {
            self.waiting.d.next = self.none.val();
        }
        // The ramp of an axis is over when the axis does not run in the next tick.
        self.slower.next = self.none.val();
        if self.found.val() {
            self.slower.next = self.axis_one_hot.val();
        }
        if self.time_slot_ends.val() {
            self.slowing.d.next = self.slowing.q.val() | self.slower.val();
            if !self.goes_on.val() {
                self.slowing.d.next =
                    (self.slowing.q.val() & !self.axis_one_hot.val()) | self.slower.val();
            }
        }

        self.axes.next = self.waiting.q.val();
        self.waits.next = self.mine.val();
        self.slows.next = self.mine_slows.q.val();
        self.caught.next = self.found.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn homing_control_synthesizes() {
        assert_synthesizes(HomingControl::<6>::new(), "carrystep_homing_control");
    }
}

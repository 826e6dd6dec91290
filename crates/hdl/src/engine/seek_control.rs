//! Seek: when the source of a seek has its level, the axes that wait for it ramp down, and their
//! queues are emptied.
//!
//! ```text
//! set      /^\___________________________________________/^\_   the host sets which axes wait
//! waits    __/^^^^^^^^^^^^^^^^^^^^^\__________________________   one bit per axis; output `seeking`
//! hit      _______________________/^\________________________   in the last beat of the source's slot
//! slows    _________________________/^^^^^^^^^^^^^^^^^^^^^^^^\_   until it rests and is released
//! released __/^^^^^^^^^^^^^^^^^^^^^\______________________/^^^   the host has written a mask since
//! ```
//!
//! The source is a switch and the level that is its hit. With `own`, each axis waits for its own
//! switch of the row, and its bits change after its time slot, as shown. Otherwise all axes that
//! wait share one switch, and their bits change together at the strobe (`sweeps`).
//!
//! Interface: the host sets the source and the mask of waiting axes; [`super::switches`] reports
//! the state of a switch in each time slot of the ticks that sample one; the queue ramps the axis
//! down while `slows` is asserted in its time slot. The ramp begins in the tick after the hit.
//!
//! Cost: two flip-flops per axis, seven for the source, and three others.

use super::layout::{SLOT_OF_FIRST, SOURCE_AXIS, SOURCE_LEVEL, SOURCE_OWN, SOURCE_ROW};
use crate::primitives::compiled_once;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

/// The source of seeks, the axes that wait for it, and those that have hit it.
#[derive(LogicBlock, Default)]
pub struct SeekControl<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick.
    pub strobe: Input<Bit>,
    /// The host replaces the source.
    pub set_source: Input<Bit>,
    /// The new source, valid with `set_source`: axis 3, row 2, own 1, level 1.
    pub source: Input<Word<7>>,
    /// The host replaces the mask of the axes that wait for the source.
    pub set: Input<Bit>,
    /// The new mask, valid with `set`; bit i is axis i.
    pub mask: Input<Word<N>>,
    /// Asserted in the last beat of a time slot.
    pub time_slot_ends: Input<Bit>,
    /// The axis of the time slot, as a number.
    pub axis: Input<Word<3>>,
    /// The axis of the time slot, one-hot. At a strobe it is the first axis.
    pub axis_one_hot: Input<Word<N>>,
    /// The row of the switches that this tick samples.
    pub row: Input<Word<2>>,
    /// This tick samples a switch in each time slot.
    pub samples: Input<Bit>,
    /// In the last beat of a time slot: the debounced state of its switch.
    pub state: Input<Bit>,
    /// The axis of the slot runs in the next tick too.
    pub goes_on: Input<Bit>,
    /// A reset: no axis waits for the source any more, and none has hit it.
    pub resetting: Input<Bit>,
    /// The axes that wait for the source; bit i is axis i.
    pub seeking: Signal<Out, Word<N>>,
    /// The axes that have hit it; bit i is axis i.
    pub hits: Signal<Out, Word<N>>,
    /// The axis of the slot has hit the source in an earlier tick: it ramps down and rests.
    pub slows: Signal<Out, Bit>,
    /// A limit that the axis of the slot finds belongs to its seek, and triggers no stop.
    pub forgives: Signal<Out, Bit>,
    /// In the last beat of a slot: its axis has waited for its own switch and has hit it.
    pub caught: Signal<Out, Bit>,
    /// In this tick the common source of all axes was hit.
    pub sweeps: Signal<Out, Bit>,
    origin: Register<Word<7>>, // `source`
    waiting: Register<Word<N>>,
    slowing: Register<Word<N>>,
    released: Register<Bit>,
    common: Register<Bit>, // `sweeps`
    // Registered, because the whole ramp depends on it from the first beat of the slot.
    mine_slows: Register<Bit>,
    mine: Signal<Local, Bit>,
    is_source: Signal<Local, Bit>,
    hit: Signal<Local, Bit>,
    found: Signal<Local, Bit>, // `caught`
    sweep: Signal<Local, Bit>,
    axis_one_hot_next: Signal<Local, Word<N>>,
    none: Literal<N, 0>,
    by_one: Literal<1, 1>,
    to_top: Parameter<3>,
}

impl<const N: usize> SeekControl<N> {
    /// Makes the seek of N axes.
    pub fn new() -> Self {
        Self { to_top: Parameter::new(N as u64 - 1), ..Self::default() }
    }
}

compiled_once::logic!(SeekControl<N = 7>);

impl<const N: usize> compiled_once::Kernel for SeekControl<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, origin, waiting, slowing, released, common, mine_slows);

        // The source, and its hit in the last beat of a time slot or at a strobe.
        if self.set_source.val() {
            self.origin.d.next = self.source.val();
        }
        self.is_source.next = (self.row.val() == self.origin.q.val().get_bits::<2>(SOURCE_ROW))
            & (self.origin.q.val().get_bit(SOURCE_OWN)
                | (self.axis.val() == self.origin.q.val().get_bits::<3>(SOURCE_AXIS)));
        self.hit.next = self.time_slot_ends.val()
            & self.samples.val()
            & self.is_source.val()
            & !(self.state.val() ^ self.origin.q.val().get_bit(SOURCE_LEVEL));
        self.mine.next = (self.waiting.q.val() & self.axis_one_hot.val()).any();
        self.found.next =
            self.hit.val() & self.origin.q.val().get_bit(SOURCE_OWN) & self.mine.val();
        self.sweep.next = self.strobe.val() & self.common.q.val();
        if self.hit.val() & !self.origin.q.val().get_bit(SOURCE_OWN) & self.waiting.q.val().any() {
            self.common.d.next = true;
        }
        if self.strobe.val() | self.resetting.val() {
            self.common.d.next = false;
        }

        // The axes that wait.
        if self.found.val() {
            self.waiting.d.next = self.waiting.q.val() & !self.axis_one_hot.val();
            self.released.d.next = false;
        }
        if self.sweep.val() {
            self.waiting.d.next = self.none.val();
            self.released.d.next = false;
        }
        if self.set.val() {
            self.waiting.d.next = self.mask.val();
            self.released.d.next = true;
        }
        if self.resetting.val() {
            self.waiting.d.next = self.none.val();
            self.released.d.next = false;
        }

        // The axes that have hit the source. Such an axis is free again when it does not run in the
        // next tick and the host has written a mask since the hit.
        if self.time_slot_ends.val()
            & self.mine_slows.q.val()
            & !self.goes_on.val()
            & self.released.q.val()
        {
            self.slowing.d.next = self.slowing.q.val() & !self.axis_one_hot.val();
        }
        if self.found.val() {
            self.slowing.d.next = self.slowing.q.val() | self.axis_one_hot.val();
        }
        if self.sweep.val() {
            self.slowing.d.next = self.slowing.q.val() | self.waiting.q.val();
        }
        if self.resetting.val() {
            self.slowing.d.next = self.none.val();
        }
        self.axis_one_hot_next.next = self.axis_one_hot.val();
        if self.time_slot_ends.val() {
            self.axis_one_hot_next.next = (self.axis_one_hot.val() << self.by_one.val())
                | (self.axis_one_hot.val() >> self.to_top.val());
        }
        // The first time slot begins in the clock after the strobe.
        self.mine_slows.d.next = (self.slowing.q.val() & self.axis_one_hot_next.val()).any()
            | (self.sweep.val() & self.waiting.q.val().get_bit(SLOT_OF_FIRST));

        self.seeking.next = self.waiting.q.val();
        self.hits.next = self.slowing.q.val();
        self.slows.next = self.mine_slows.q.val();
        self.forgives.next = self.is_source.val() & (self.mine.val() | self.mine_slows.q.val());
        self.caught.next = self.found.val();
        self.sweeps.next = self.common.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn seek_control_synthesizes() {
        assert_synthesizes(SeekControl::<6>::new(), "carrystep_seek_control");
    }
}

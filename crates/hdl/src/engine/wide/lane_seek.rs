//! Seek in an engine with several adders: [`super::super::seek_control`] for the axes of several lanes
//! at once. A hit in any lane acts on the axes of all lanes in the same clock as one adder's would.
//!
//! ```text
//! beat 12   ___/^\______________________
//! lane 0    ___ hits ___________________   waits, slows of its axis
//! lane 1    ___ rests __________________   `released` of the clock before counts for its axis
//! released  ^^^^^^\_____________________   for all lanes
//! ```
//!
//! Interface: as that of `seek_control`, with the inputs and the outputs of a time slot once per lane.
//!
//! Cost: two flip-flops per axis, one per lane, seven for the source, and two others.

use crate::engine::layout::{SOURCE_AXIS, SOURCE_LEVEL, SOURCE_OWN, SOURCE_ROW};
use crate::primitives::compiled_once;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::per_axis::PerAxis;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

/// The source of seeks, the axes that wait for it, and those that have hit it, of N axes in K lanes.
#[derive(LogicBlock, Default)]
pub struct LaneSeek<const N: usize, const K: usize> {
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
    /// The axis of lane 0, as a number.
    pub axis: Input<Word<3>>,
    /// The axis of lane 0, one-hot. At a strobe it is axis 0.
    pub axis_one_hot: Input<Word<N>>,
    /// The row of the switches that this tick samples.
    pub row: Input<Word<2>>,
    /// This tick samples a switch in each time slot.
    pub samples: Input<Bit>,
    /// In the last beat of a time slot: the debounced state of the switch of each lane; bit k is
    /// lane k.
    pub state: Input<Word<K>>,
    /// The axis of each lane runs in the next tick too.
    pub goes_on: Input<Word<K>>,
    /// A reset: no axis waits for the source any more, and none has hit it.
    pub resetting: Input<Bit>,
    /// The axes that wait for the source; bit i is axis i.
    pub seeking: Signal<Out, Word<N>>,
    /// The axes that have hit it; bit i is axis i.
    pub hits: Signal<Out, Word<N>>,
    /// The axis of each lane has hit the source in an earlier tick: it ramps down and rests.
    pub slows: Signal<Out, Word<K>>,
    /// A limit that the axis of each lane finds belongs to its seek, and triggers no stop.
    pub forgives: Signal<Out, Word<K>>,
    /// In the last beat of a slot: the axis of each lane has waited for its own switch and has hit
    /// it.
    pub caught: Signal<Out, Word<K>>,
    /// In this tick the common source of all axes was hit.
    pub sweeps: Signal<Out, Bit>,
    origin: Register<Word<7>>, // `source`
    waiting: Register<Word<N>>,
    slowing: Register<Word<N>>,
    released: Register<Bit>,
    common: Register<Bit>, // `sweeps`
    // Registered, because the whole ramp depends on it from the first beat of the slot.
    lanes_slow: Register<Word<K>>, // `slows`
    number: PerAxis<Signal<Local, Word<3>>, K>,
    one_hot: PerAxis<Signal<Local, Word<N>>, K>,
    is_source: PerAxis<Signal<Local, Bit>, K>,
    hit: PerAxis<Signal<Local, Bit>, K>,
    mine: PerAxis<Signal<Local, Bit>, K>,
    found: PerAxis<Signal<Local, Bit>, K>, // `caught`
    found_bit: PerAxis<Signal<Local, Word<N>>, K>,
    freed_bit: PerAxis<Signal<Local, Word<N>>, K>,
    next_one_hot: PerAxis<Signal<Local, Word<N>>, K>,
    slow_bit: PerAxis<Signal<Local, Word<K>>, K>,
    forgiven_bit: PerAxis<Signal<Local, Word<K>>, K>,
    caught_bit: PerAxis<Signal<Local, Word<K>>, K>,
    own: Signal<Local, Bit>,
    hits_now: Signal<Local, Bit>, // a lane has the hit of the source
    found_now: Signal<Local, Word<N>>, // the axes that hit their own switch
    freed_now: Signal<Local, Word<N>>, // the axes whose seek ends
    slow_now: Signal<Local, Word<K>>,
    forgiven_now: Signal<Local, Word<K>>, // `forgives`
    caught_now: Signal<Local, Word<K>>,   // `caught`
    sweep: Signal<Local, Bit>,
    one_lane: PerAxis<Parameter<K>, K>,
    first_axis: PerAxis<Parameter<N>, K>,
    no_axes: Literal<N, 0>,
    no_lanes: Literal<K, 0>,
    by_lane: PerAxis<Parameter<3>, K>,
    by_lanes: Parameter<4>,
    to_top: Parameter<4>,
}

impl<const N: usize, const K: usize> LaneSeek<N, K> {
    /// Makes the seek of N axes in K lanes.
    pub fn new() -> Self {
        Self {
            one_lane: PerAxis::from_fn(|lane| Parameter::new(1 << lane)),
            first_axis: PerAxis::from_fn(|lane| Parameter::new(1 << lane)),
            by_lane: PerAxis::from_fn(|lane| Parameter::new(lane as u64)),
            by_lanes: Parameter::new(K as u64),
            to_top: Parameter::new(N as u64 - K as u64),
            ..Self::default()
        }
    }
}

compiled_once::logic!(LaneSeek<N = 8, K = 6>);

impl<const N: usize, const K: usize> compiled_once::Kernel for LaneSeek<N, K> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, origin, waiting, slowing, released, common, lanes_slow);

        // The source, and its hits in the last beat of a time slot or at a strobe.
        if self.set_source.val() {
            self.origin.d.next = self.source.val();
        }
        self.own.next = self.origin.q.val().get_bit(SOURCE_OWN);
        self.sweep.next = self.strobe.val() & self.common.q.val();
        self.hits_now.next = false;
        self.found_now.next = self.no_axes.val();
        self.freed_now.next = self.no_axes.val();
        self.slow_now.next = self.no_lanes.val();
        self.forgiven_now.next = self.no_lanes.val();
        self.caught_now.next = self.no_lanes.val();
        for k in 0..K {
            self.number[k].next = self.axis.val() + self.by_lane[k].val();
            self.one_hot[k].next = self.axis_one_hot.val() << self.by_lane[k].val();
            self.is_source[k].next = (self.row.val()
                == self.origin.q.val().get_bits::<2>(SOURCE_ROW))
                & (self.own.val()
                    | (self.number[k].val() == self.origin.q.val().get_bits::<3>(SOURCE_AXIS)));
            self.hit[k].next = self.time_slot_ends.val()
                & self.samples.val()
                & self.is_source[k].val()
                & !(self.state.val().get_bit(k) ^ self.origin.q.val().get_bit(SOURCE_LEVEL));
            self.hits_now.next = self.hits_now.val() | self.hit[k].val();
            self.mine[k].next = (self.waiting.q.val() & self.one_hot[k].val()).any();
            self.found[k].next = self.hit[k].val() & self.own.val() & self.mine[k].val();
            self.found_bit[k].next = self.no_axes.val();
            if self.found[k].val() {
                self.found_bit[k].next = self.one_hot[k].val();
            }
            self.found_now.next = self.found_now.val() | self.found_bit[k].val();

            self.caught_bit[k].next = self.no_lanes.val();
            if self.found[k].val() {
                self.caught_bit[k].next = self.one_lane[k].val();
            }
            self.caught_now.next = self.caught_now.val() | self.caught_bit[k].val();
            self.forgiven_bit[k].next = self.no_lanes.val();
            if self.is_source[k].val() & (self.mine[k].val() | self.lanes_slow.q.val().get_bit(k)) {
                self.forgiven_bit[k].next = self.one_lane[k].val();
            }
            self.forgiven_now.next = self.forgiven_now.val() | self.forgiven_bit[k].val();

            // An axis that has hit the source is free again when it does not run in the next tick
            // and the host has written a mask since the hit.
            self.freed_bit[k].next = self.no_axes.val();
            if self.time_slot_ends.val()
                & self.lanes_slow.q.val().get_bit(k)
                & !self.goes_on.val().get_bit(k)
                & self.released.q.val()
            {
                self.freed_bit[k].next = self.one_hot[k].val();
            }
            self.freed_now.next = self.freed_now.val() | self.freed_bit[k].val();

            // The first time slot begins in the clock after the strobe.
            self.next_one_hot[k].next = self.one_hot[k].val();
            if self.time_slot_ends.val() {
                self.next_one_hot[k].next = (self.one_hot[k].val() << self.by_lanes.val())
                    | (self.one_hot[k].val() >> self.to_top.val());
            }
            self.slow_bit[k].next = self.no_lanes.val();
            if (self.slowing.q.val() & self.next_one_hot[k].val()).any()
                | (self.sweep.val() & (self.waiting.q.val() & self.first_axis[k].val()).any())
            {
                self.slow_bit[k].next = self.one_lane[k].val();
            }
            self.slow_now.next = self.slow_now.val() | self.slow_bit[k].val();
        }
        self.lanes_slow.d.next = self.slow_now.val();
        if self.hits_now.val() & !self.own.val() & self.waiting.q.val().any() {
            self.common.d.next = true;
        }
        if self.strobe.val() | self.resetting.val() {
            self.common.d.next = false;
        }

        // The axes that wait.
        if self.found_now.val().any() {
            self.waiting.d.next = self.waiting.q.val() & !self.found_now.val();
            self.released.d.next = false;
        }
        if self.sweep.val() {
            self.waiting.d.next = self.no_axes.val();
            self.released.d.next = false;
        }
        if self.set.val() {
            self.waiting.d.next = self.mask.val();
            self.released.d.next = true;
        }
        if self.resetting.val() {
            self.waiting.d.next = self.no_axes.val();
            self.released.d.next = false;
        }

        // The axes that have hit the source.
        self.slowing.d.next = (self.slowing.q.val() & !self.freed_now.val()) | self.found_now.val();
        if self.sweep.val() {
            self.slowing.d.next = self.slowing.q.val() | self.waiting.q.val();
        }
        if self.resetting.val() {
            self.slowing.d.next = self.no_axes.val();
        }

        self.seeking.next = self.waiting.q.val();
        self.hits.next = self.slowing.q.val();
        self.slows.next = self.lanes_slow.q.val();
        self.forgives.next = self.forgiven_now.val();
        self.caught.next = self.caught_now.val();
        self.sweeps.next = self.common.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn lane_seek_synthesizes() {
        assert_synthesizes(LaneSeek::<6, 2>::new(), "carrystep_lane_seek_2");
        assert_synthesizes(LaneSeek::<6, 6>::new(), "carrystep_lane_seek_6");
    }
}

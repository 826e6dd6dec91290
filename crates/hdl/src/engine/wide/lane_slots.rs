//! The schedule of an engine with several adders: gives the axes of each time slot, one of each
//! lane, thirteen clocks. A lane is an adder with the memories and parts that belong to it.
//!
//! ```text
//! strobe   /^\_________________________________________________
//! axis        | 0                    | K                    | ...     of lane 0; that of lane k
//! beat        | 0 | 1 | ...     | 12 | 0 | 1 | ...                    is k more
//!                                    |13 |14 |15 |16 |
//! ```
//!
//! The beats are those of [`super::super::time_slot`], for all lanes at once.
//!
//! Interface: the lanes take their schedule from `beat`, and add their numbers to `axis`.
//!
//! Cost: one flip-flop per beat, one flip-flop per axis for `axis_one_hot`, and 3 bits for the number
//! of the axis.

use crate::engine::layout::BEAT_LAST;
use crate::primitives::compiled_once;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

/// The beats, and the axis of lane 0 in the present time slot, for N axes.
#[derive(LogicBlock, Default)]
pub struct LaneSlots<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick.
    pub strobe: Input<Bit>,
    /// Bit i is asserted in beat i. Bits 13 to 16 belong to the axes of the slot before.
    pub beat: Signal<Out, Word<17>>,
    /// The axis of lane 0, as a number.
    pub axis: Signal<Out, Word<3>>,
    /// The axis of lane 0 in the next clock, as a number.
    pub axis_next: Signal<Out, Word<3>>,
    /// The axis of lane 0, one-hot. After the last slot it is axis 0.
    pub axis_one_hot: Signal<Out, Word<N>>,
    /// The time slot is the last one.
    pub is_last: Signal<Out, Bit>,
    beats: Register<Word<17>>,
    number: Register<Word<3>>,
    one_hot: Register<Word<N>>,
    ends: Signal<Local, Bit>,
    begins: Signal<Local, Bit>,
    axis_to_come: Signal<Local, Word<3>>,
    shifted: Signal<Local, Word<17>>,
    by_one: Literal<1, 1>,
    first_beat: Literal<17, 1>,
    first_axis: Literal<3, 0>,
    lanes: Parameter<3>,
    last_one_hot: Parameter<N>,
    by_lanes: Parameter<4>,
    to_top: Parameter<4>,
}

impl<const N: usize> LaneSlots<N> {
    /// Makes the schedule of N axes in this number of lanes, by which N can be divided. At
    /// configuration no bit of `beat` is asserted; the first slot begins after the first strobe.
    pub fn new(lanes: usize) -> Self {
        let rest = N as u64 - lanes as u64;
        Self {
            one_hot: Register::new(Word::new(1)),
            lanes: Parameter::new(lanes as u64 & 7),
            last_one_hot: Parameter::new(1 << rest),
            by_lanes: Parameter::new(lanes as u64),
            to_top: Parameter::new(rest),
            ..Self::default()
        }
    }
}

compiled_once::logic!(LaneSlots<N = 8>);

impl<const N: usize> compiled_once::Kernel for LaneSlots<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, beats, number, one_hot);

        self.ends.next = (self.one_hot.q.val() & self.last_one_hot.val()).any();
        self.begins.next =
            self.strobe.val() | (self.beats.q.val().get_bit(BEAT_LAST) & !self.ends.val());
        self.shifted.next = self.beats.q.val() << self.by_one.val();
        self.beats.d.next = self.shifted.val();
        if self.begins.val() {
            self.beats.d.next = self.shifted.val() | self.first_beat.val();
        }

        self.axis_to_come.next = self.number.q.val();
        if self.beats.q.val().get_bit(BEAT_LAST) {
            self.axis_to_come.next = self.number.q.val() + self.lanes.val();
            if self.ends.val() {
                self.axis_to_come.next = self.first_axis.val();
            }
        }
        if self.beats.q.val().get_bit(BEAT_LAST) {
            self.one_hot.d.next = (self.one_hot.q.val() << self.by_lanes.val())
                | (self.one_hot.q.val() >> self.to_top.val());
        }
        self.number.d.next = self.axis_to_come.val();

        self.beat.next = self.beats.q.val();
        self.axis.next = self.number.q.val();
        self.axis_next.next = self.axis_to_come.val();
        self.axis_one_hot.next = self.one_hot.q.val();
        self.is_last.next = self.ends.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn lane_slots_synthesizes() {
        assert_synthesizes(LaneSlots::<6>::new(2), "carrystep_lane_slots_2");
        assert_synthesizes(LaneSlots::<6>::new(6), "carrystep_lane_slots_6");
    }
}

//! The schedule of the engine: gives each axis in sequence a time slot of thirteen clocks.
//!
//! A clock of a time slot is a beat.
//!
//! ```text
//! strobe  /^\________________________________________________
//! axis       | 0                     | 1                     | ...
//! beat       | 0 | 1 | 2 | ...  | 12 | 0 | 1 | 2 | ...
//!                                    |13 |14 |15 |16 |
//! ```
//!
//! The bisection of an axis needs four further beats, 13 to 16, which overlap the slot of the next
//! axis. The slots begin in the clock after the strobe. After the last slot, beats 13 to 16 of its
//! axis follow; beats 0 to 12 are not asserted until the clock after the next strobe. In a short
//! tick these four beats may overlap the first slot of the next tick. So at most two bits of `beat`
//! are asserted in a clock: one of 0 to 12, and one of 13 to 16.
//!
//! Interface: all modules that work in time slots take their schedule from `beat` or from single
//! bits of it. The pulsers and the supervisor do not: they work with the strobe and with the
//! phases.
//!
//! Cost: one flip-flop per beat, in a shift register of 17 bits, so that no module needs to decode
//! a beat counter; one flip-flop per axis for `axis_one_hot`; and 3 bits for the number of the
//! axis.

use super::layout::BEAT_LAST;
use crate::primitives::compiled_once;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

/// The beats and the axis of the present time slot, for N axes.
#[derive(LogicBlock, Default)]
pub struct TimeSlot<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick.
    pub strobe: Input<Bit>,
    /// Bit i is asserted in beat i. Bits 13 to 16 belong to the axis of the slot before.
    pub beat: Signal<Out, Word<17>>,
    /// The axis of the slot, as a number.
    pub axis: Signal<Out, Word<3>>,
    /// The axis of the next clock, as a number.
    pub axis_next: Signal<Out, Word<3>>,
    /// The axis of the slot, one-hot. After the last slot it is the first axis.
    pub axis_one_hot: Signal<Out, Word<N>>,
    /// The time slot is that of the last axis.
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
    one_axis: Literal<3, 1>,
    last_one_hot: Parameter<N>,
    to_top: Parameter<3>,
}

impl<const N: usize> TimeSlot<N> {
    /// Makes the schedule of N axes. At configuration no bit of `beat` is asserted and the axis is
    /// the first one; the first slot begins after the first strobe.
    pub fn new() -> Self {
        Self {
            one_hot: Register::new(Word::new(1)),
            last_one_hot: Parameter::new(1 << (N - 1)),
            to_top: Parameter::new(N as u64 - 1),
            ..Self::default()
        }
    }
}

compiled_once::logic!(TimeSlot<N = 7>);

impl<const N: usize> compiled_once::Kernel for TimeSlot<N> {
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
            self.axis_to_come.next = self.number.q.val() + self.one_axis.val();
            if self.ends.val() {
                self.axis_to_come.next = self.first_axis.val();
            }
        }
        if self.beats.q.val().get_bit(BEAT_LAST) {
            self.one_hot.d.next = (self.one_hot.q.val() << self.by_one.val())
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
    use crate::sim::{assert_synthesizes, rising_edge, settle};
    use carrystep_core::AXES;
    use carrystep_core::engine::TIME_SLOT_CLOCKS;

    #[test]
    fn time_slot_gives_every_axis_thirteen_beats() {
        let mut time_slot = TimeSlot::<AXES>::new();
        time_slot.connect_all();
        for cycle in 0..100_u32 {
            time_slot.clock.next = false.into();
            time_slot.strobe.next = cycle == 0;
            settle(&mut time_slot);
            let time_slots = (1..=AXES as u32 * TIME_SLOT_CLOCKS).contains(&cycle);
            let (axis, beat) = (
                (cycle.wrapping_sub(1)) / TIME_SLOT_CLOCKS,
                (cycle.wrapping_sub(1)) % TIME_SLOT_CLOCKS,
            );
            let beats = time_slot.beat.val().value() as u32;
            assert_eq!(beats & 0x1fff, if time_slots { 1 << beat } else { 0 }, "cycle {cycle}");
            // After the last time slot, `axis_one_hot` is axis 0 again.
            assert_eq!(
                time_slot.axis_one_hot.val().value() as u32,
                if time_slots { 1 << axis } else { 1 },
                "cycle {cycle}"
            );
            time_slot.clock.next = true.into();
            rising_edge(&mut time_slot);
        }
    }

    #[test]
    fn time_slot_synthesizes() {
        assert_synthesizes(TimeSlot::<AXES>::new(), "carrystep_time_slot");
    }
}

//! The event wheel: one block RAM that holds the pending steps and signs of all axes, with one word
//! for the steps of each phase of four ticks, and one word for the signs of each of these ticks.
//!
//! When the time slot of an axis finds a step in phase q, the wheel writes two bits in the event
//! word of phase q, two ticks ahead: one for the step and one for its direction. When that phase
//! begins, the word is read and every axis with a set bit steps in the same clock. The word is then
//! cleared.
//!
//! ```text
//! address   tick 2 | kind 1 | phase 4        word: bit i for axis i, bit 8 + i for its direction
//! kind 0    bit i: axis i steps              read at the beginning of each phase
//! kind 1    bit i: axis i has V != 0         read in the last clock of the tick before
//! bit 8 + i of both kinds: backward
//! ```
//!
//! The pulsers set DIR from the events of kind 1, so that the set-up time begins before the step is
//! due.
//!
//! Interface: the wheel contains the tick counter and provides `strobe` and `phase_start` to the
//! engine. Events are written in clocks in which no word is cleared; a phase must therefore have at
//! least two clocks.
//!
//! Cost: one memory of 128 words of 16 bits. The axes need no phase register and no comparator; one
//! memory holds all pending step events.

use super::layout::{EVENT_AXES, EVENT_BACKWARD, EVENT_TICK};
use crate::parameters::EVENT_MEMORY;
use crate::parts::tick::Tick;
use crate::primitives::compiled_once;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::memory::Memory;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::Timebase;
use rust_hdl_core::prelude::*;

/// The tick counter and the event memory.
#[derive(LogicBlock, Default)]
pub struct EventWheel<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last beat of a time slot. The inputs of the following beats belong to its
    /// axis.
    pub time_slot_ends: Input<Bit>,
    /// The axis of the present time slot, one-hot.
    pub axis_one_hot: Input<Word<N>>,
    /// The tick of the axis contains a step.
    pub crosses: Input<Bit>,
    /// The V of the axis is not zero.
    pub has_sign: Input<Bit>,
    /// From the following beat on: V < 0.
    pub back: Input<Bit>,
    /// Asserted four beats after `time_slot_ends`: `q` is valid from the next clock on.
    pub phase_known: Input<Bit>,
    /// The phase of the step, in 1/16 tick.
    pub q: Input<Word<4>>,
    /// Asserted in the last clock of a tick.
    pub strobe: Signal<Out, Bit>,
    /// Asserted in the first clock of a phase, in which `events` are step events.
    pub phase_start: Signal<Out, Bit>,
    /// Bit i: axis i has an event.
    pub events: Signal<Out, Word<N>>,
    /// Bit i: the event of axis i is backward.
    pub backward: Signal<Out, Word<N>>,
    tick: Tick, // runs one clock ahead of the pins
    event_memory: Memory<7, 16>,
    turned: Register<Bit>,    // `strobe`
    started: Register<Bit>,   // `phase_start`
    ahead: Register<Word<2>>, // the number of the tick, one clock ahead
    read: Register<Word<7>>,  // the address of the word to clear
    place: Signal<Local, Word<7>>,
    wipes: Signal<Local, Bit>,
    sign_due: Register<Bit>,
    step_due: Register<Bit>,
    step_known: Register<Bit>,
    when: Register<Word<2>>, // the tick before the one in which the event takes place
    whose: Signal<Local, Word<N>>, // the axis of the slot before, one-hot
    writes_sign: Signal<Local, Bit>,
    writes_step: Signal<Local, Bit>,
    now: Signal<Local, Word<2>>,
    later: Signal<Local, Word<7>>,
    bits: Signal<Local, Word<16>>,
    data: Signal<Local, Word<16>>,
    one_tick: Literal<2, 1>,
    no: Literal<16, 0>,
    all: Literal<16, 0xffff>,
    forward: Literal<16, 0x00ff>,
    sign_kind: Literal<7, 0x10>,
    by_one: Literal<1, 1>,
    to_top: Parameter<3>,
    at_5: Literal<4, 5>,
    at_8: Literal<4, 8>,
    last_phase: Parameter<7>,
    q_shift: Parameter<4>,
}

impl<const N: usize> EventWheel<N> {
    /// Makes the wheel of this timebase.
    pub fn new(timebase: &Timebase) -> Self {
        Self {
            tick: Tick::ahead(timebase),
            last_phase: Parameter::new(u64::from(timebase.phases() - 1)),
            q_shift: Parameter::new(u64::from(4 - timebase.phase_bits())),
            to_top: Parameter::new(N as u64 - 1),
            event_memory: Memory::of_bits(EVENT_MEMORY.name),
            ..Self::default()
        }
    }
}

compiled_once::logic!(EventWheel<N = 8>);

impl<const N: usize> compiled_once::Kernel for EventWheel<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, turned, started, ahead, read, sign_due, step_due, step_known, when);
        clock!(self, clock, tick, event_memory);

        // The strobe and the phase start of the pins, and the number of the tick.
        self.turned.d.next = self.tick.strobe.val();
        self.started.d.next = self.tick.phase_start.val();
        if self.tick.strobe.val() {
            self.ahead.d.next = self.ahead.q.val() + self.one_tick.val();
        }

        // Each word is read one clock before its event, and cleared in the clock of the event.
        self.place.next = (bit_cast::<7, 2>(self.ahead.q.val()) << self.at_5.val())
            | bit_cast::<7, 4>(self.tick.phase.val());
        if self.tick.strobe.val() {
            self.place.next = (bit_cast::<7, 2>(self.ahead.q.val()) << self.at_5.val())
                | bit_cast::<7, 4>(self.tick.phase.val())
                | self.sign_kind.val();
        }
        self.read.d.next = self.place.val();
        self.event_memory.read_address.next = self.place.val();
        self.wipes.next = self.turned.q.val() | self.started.q.val();

        // Writes the results of a time slot, the sign first and then the step, in clocks without a
        // clear.
        self.writes_sign.next = !self.wipes.val() & self.sign_due.q.val();
        self.writes_step.next = !self.wipes.val()
            & !self.sign_due.q.val()
            & self.step_due.q.val()
            & self.step_known.q.val();
        if self.writes_sign.val() {
            self.sign_due.d.next = false;
        }
        if self.writes_step.val() {
            self.step_due.d.next = false;
        }
        if self.phase_known.val() {
            self.step_known.d.next = true;
        }
        if self.time_slot_ends.val() {
            self.sign_due.d.next = self.has_sign.val();
            self.step_due.d.next = self.crosses.val();
            self.step_known.d.next = false;
            self.when.d.next = self.read.q.val().get_bits::<2>(EVENT_TICK) + self.one_tick.val();
        }
        self.now.next = self.when.q.val() + self.one_tick.val();
        self.later.next = (bit_cast::<7, 2>(self.now.val()) << self.at_5.val())
            | bit_cast::<7, 4>(self.q.val() >> self.q_shift.val());
        if self.sign_due.q.val() {
            self.later.next = (bit_cast::<7, 2>(self.when.q.val()) << self.at_5.val())
                | self.sign_kind.val()
                | self.last_phase.val();
        }
        self.event_memory.write_address.next = self.later.val();
        if self.wipes.val() {
            self.event_memory.write_address.next = self.read.q.val();
        }
        self.data.next = self.no.val();
        if !self.wipes.val() {
            self.data.next = self.forward.val();
            if self.back.val() {
                self.data.next = self.all.val();
            }
        }
        self.event_memory.write_data.next = self.data.val();
        self.whose.next = (self.axis_one_hot.val() >> self.by_one.val())
            | (self.axis_one_hot.val() << self.to_top.val());
        self.bits.next = self.no.val();
        if self.writes_sign.val() | self.writes_step.val() {
            self.bits.next = bit_cast::<16, N>(self.whose.val())
                | (bit_cast::<16, N>(self.whose.val()) << self.at_8.val());
        }
        if self.wipes.val() {
            self.bits.next = self.all.val();
        }
        self.event_memory.write_bits.next = self.bits.val();

        self.strobe.next = self.turned.q.val();
        self.phase_start.next = self.started.q.val();
        self.events.next = self.event_memory.read_data.val().get_bits::<N>(EVENT_AXES);
        self.backward.next = self.event_memory.read_data.val().get_bits::<N>(EVENT_BACKWARD);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitives::compiled_once::assert_sizes_agree;
    use crate::sim::assert_synthesizes;

    #[test]
    fn statements_are_those_of_each_size() {
        assert_sizes_agree::<EventWheel<1>>();
        assert_sizes_agree::<EventWheel<7>>();
    }

    #[test]
    fn event_wheel_synthesizes() {
        let timebase = Timebase::new(80_000_000, 1000, 16).unwrap();
        assert_synthesizes(EventWheel::<6>::new(&timebase), "carrystep_event_wheel");
    }
}

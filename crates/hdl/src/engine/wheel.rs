//! The wheel of events: what the pins do in each phase of the ticks to come, in one block RAM.
//!
//! A turn finds that its tick steps in phase q: it leaves two bits in the word of that phase, two ticks
//! ahead. When time comes by, the word is read, every axis of it steps in the same clock, and the word is wiped.
//!
//! ```text
//! address   tick 2 | kind 1 | phase 4        word: bit i for axis i, bit 8 + i for its direction
//! kind 0    axis i steps, backward           read for each phase
//! kind 1    axis i has a sign, backward      read in the last cycle of the tick before
//! ```
//!
//! So no axis keeps its phase, compares it, or waits for it.

use crate::parts::tick::Tick;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::memory::Memory;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::Timebase;
use rust_hdl::prelude::*;

/// The tick, and the events in it.
#[derive(LogicBlock, Default)]
pub struct Wheel<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// Last beat of a turn: what follows is of its axis.
    pub turn_ends: Input<Bit>,
    /// The axis of the present turn, one bit each.
    pub lane: Input<Word<N>>,
    /// Its tick steps.
    pub crosses: Input<Bit>,
    /// Its V is not zero.
    pub has_sign: Input<Bit>,
    /// From the beat after: its V is negative.
    pub back: Input<Bit>,
    /// Four beats later: its phase is there.
    pub phase_known: Input<Bit>,
    /// The phase, of 16.
    pub q: Input<Word<4>>,
    /// Last cycle of a tick.
    pub strobe: Signal<Out, Bit>,
    /// First cycle of a phase: what `events` say of kind 0 happens.
    pub phase_start: Signal<Out, Bit>,
    /// Bit i: axis i.
    pub events: Signal<Out, Word<N>>,
    /// Bit i: backward.
    pub backward: Signal<Out, Word<N>>,
    tick: Tick, // a cycle ahead of the pins
    rim: Memory<7, 16>,
    turned: Register<Bit>,    // `strobe`
    started: Register<Bit>,   // `phase_start`
    ahead: Register<Word<2>>, // the tick, a cycle ahead
    read: Register<Word<7>>,  // what is there to be wiped
    place: Signal<Local, Word<7>>,
    wipes: Signal<Local, Bit>,
    sign_due: Register<Bit>,
    step_due: Register<Bit>,
    step_known: Register<Bit>,
    when: Register<Word<2>>,       // the tick before the one in which it happens
    whose: Signal<Local, Word<N>>, // the axis before
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

impl<const N: usize> Wheel<N> {
    /// The wheel of this timebase.
    pub fn new(timebase: &Timebase) -> Self {
        Self {
            tick: Tick::ahead(timebase),
            last_phase: Parameter::new(u64::from(timebase.phases() - 1)),
            q_shift: Parameter::new(u64::from(4 - timebase.phase_bits())),
            to_top: Parameter::new(N as u64 - 1),
            rim: Memory::of_bits(),
            ..Self::default()
        }
    }
}

impl<const N: usize> Logic for Wheel<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, turned, started, ahead, read, sign_due, step_due, step_known, when);
        clock!(self, clock, tick, rim);

        // Time, as the pins have it.
        self.turned.d.next = self.tick.strobe.val();
        self.started.d.next = self.tick.phase_start.val();
        if self.tick.strobe.val() {
            self.ahead.d.next = self.ahead.q.val() + self.one_tick.val();
        }

        // Read a cycle ahead; then wipe.
        self.place.next =
            (bit_cast::<7, 2>(self.ahead.q.val()) << self.at_5.val()) | bit_cast::<7, 4>(self.tick.phase.val());
        if self.tick.strobe.val() {
            self.place.next = (bit_cast::<7, 2>(self.ahead.q.val()) << self.at_5.val())
                | bit_cast::<7, 4>(self.tick.phase.val())
                | self.sign_kind.val();
        }
        self.read.d.next = self.place.val();
        self.rim.read_address.next = self.place.val();
        self.wipes.next = self.turned.q.val() | self.started.q.val();

        // What a turn has found: first the sign, then the step, between two wipes.
        self.writes_sign.next = !self.wipes.val() & self.sign_due.q.val();
        self.writes_step.next =
            !self.wipes.val() & !self.sign_due.q.val() & self.step_due.q.val() & self.step_known.q.val();
        if self.writes_sign.val() {
            self.sign_due.d.next = false;
        }
        if self.writes_step.val() {
            self.step_due.d.next = false;
        }
        if self.phase_known.val() {
            self.step_known.d.next = true;
        }
        if self.turn_ends.val() {
            self.sign_due.d.next = self.has_sign.val();
            self.step_due.d.next = self.crosses.val();
            self.step_known.d.next = false;
            self.when.d.next = self.read.q.val().get_bits::<2>(5) + self.one_tick.val();
        }
        self.now.next = self.when.q.val() + self.one_tick.val();
        self.later.next = (bit_cast::<7, 2>(self.now.val()) << self.at_5.val())
            | bit_cast::<7, 4>(self.q.val() >> self.q_shift.val());
        if self.sign_due.q.val() {
            self.later.next =
                (bit_cast::<7, 2>(self.when.q.val()) << self.at_5.val()) | self.sign_kind.val() | self.last_phase.val();
        }
        self.rim.write_address.next = self.later.val();
        if self.wipes.val() {
            self.rim.write_address.next = self.read.q.val();
        }
        self.data.next = self.no.val();
        if !self.wipes.val() {
            self.data.next = self.forward.val();
            if self.back.val() {
                self.data.next = self.all.val();
            }
        }
        self.rim.write_data.next = self.data.val();
        self.whose.next = (self.lane.val() >> self.by_one.val()) | (self.lane.val() << self.to_top.val());
        self.bits.next = self.no.val();
        if self.writes_sign.val() | self.writes_step.val() {
            self.bits.next =
                bit_cast::<16, N>(self.whose.val()) | (bit_cast::<16, N>(self.whose.val()) << self.at_8.val());
        }
        if self.wipes.val() {
            self.bits.next = self.all.val();
        }
        self.rim.write_bits.next = self.bits.val();

        self.strobe.next = self.turned.q.val();
        self.phase_start.next = self.started.q.val();
        self.events.next = self.rim.read_data.val().get_bits::<N>(0);
        self.backward.next = self.rim.read_data.val().get_bits::<N>(8);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn wheel_synthesizes() {
        let timebase = Timebase::new(80_000_000, 1000, 16).unwrap();
        assert_synthesizes(Wheel::<6>::new(&timebase), "carrystep_wheel");
    }
}

//! Samples and debounces the limit switches, and reports when an axis has reached one.
//!
//! ```text
//! word     state | count, 7 bits                      address   axis 3 | max
//! ```
//!
//! A memory holds one word per switch: `state` is the debounced state, and `count` is the number of
//! consecutive samples that differ from it. The state changes after as many different samples in
//! sequence as the build specifies (1 to 127). Each limit is sampled once per round of ticks, in
//! the time slot of its axis.
//!
//! The pin of the slot's axis is selected first and then passes two flip-flops. These synchronize
//! it, and it has the whole slot to settle.
//!
//! Cost: one synchronizer and one debouncer for all switches, and a memory of 16 words of 8 bits.

use super::layout::{SWITCH_COUNT, SWITCH_STATE};
use crate::parameters::{DEBOUNCE_SAMPLES, LIMITS, LIMITS_LOW};
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::memory::Memory;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::engine::{Guard, LimitWiring as Wiring, MAX_DEBOUNCE_SAMPLES};
use rust_hdl::prelude::*;

/// The debouncer of all limit switches, and the decision whether a switch stops the axis.
#[derive(LogicBlock, Default)]
pub struct LimitSwitches<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last beat of a time slot.
    pub time_slot_ends: Input<Bit>,
    /// The axis of the slot, as a number.
    pub axis: Input<Word<3>>,
    /// The axis of the next clock, as a number.
    pub axis_next: Input<Word<3>>,
    /// The axis of the slot, one-hot.
    pub axis_one_hot: Input<Word<N>>,
    /// The first tick of a round: `limit_min` is sampled.
    pub tick_0: Input<Bit>,
    /// The second tick of a round: `limit_max` is sampled.
    pub tick_1: Input<Bit>,
    /// The pins at the low ends. With one switch per axis, the pin of that switch; with one for all
    /// axes, bit 0. Asynchronous.
    pub limit_min: Input<Word<N>>,
    /// The pins at the high ends; asynchronous.
    pub limit_max: Input<Word<N>>,
    /// The axis moves in this tick, with V != 0.
    pub goes: Input<Bit>,
    /// V < 0 in this tick.
    pub back: Input<Bit>,
    /// A reset: the switch of this tick becomes inactive, as at configuration.
    pub resetting: Input<Bit>,
    /// The axis has reached a limit.
    pub hit: Signal<Out, Bit>,
    switches: Memory<4, 8>,
    max: Signal<Local, Bit>,
    samples: Signal<Local, Bit>, // a switch is sampled in this clock
    pins: Signal<Local, Word<N>>,
    chosen: Signal<Local, Word<N>>,
    sync: Register<Bit>, // first flip-flop of the synchronizer
    now: Register<Bit>,  // the synchronized pin
    word: Signal<Local, Word<8>>,
    differs: Signal<Local, Bit>,
    flips: Signal<Local, Bit>,
    state: Signal<Local, Bit>,
    count: Signal<Local, Word<7>>,
    next_word: Signal<Local, Word<8>>,
    exist: Parameter<1>,
    pair: Parameter<1>,
    one_for_all: Parameter<1>,
    low: Parameter<1>,
    last_sample: Parameter<7>,
    first_one_hot: Literal<N, 1>,
    one: Literal<7, 1>,
    none: Literal<7, 0>,
    active: Literal<8, { 1 << SWITCH_STATE }>,
    no: Literal<8, 0>,
    all: Literal<8, 0xff>,
    side: Literal<4, 1>,
    no_side: Literal<4, 0>,
    max_bit: Signal<Local, Word<4>>,
    by_one: Literal<1, 1>,
    limits_out_of_range: ParameterRefusal,
    limits_low_out_of_range: ParameterRefusal,
    debounce_samples_out_of_range: ParameterRefusal,
}

impl<const N: usize> LimitSwitches<N> {
    /// Makes the limits of this guard. The caller has checked the guard.
    pub fn new(guard: &Guard) -> Self {
        let number = |wiring| match wiring {
            Wiring::None => 0_u32,
            Wiring::Pair => 1,
            Wiring::Each => 2,
            Wiring::One => 3,
        };
        let wiring = LIMITS.of::<32>(number(guard.limits));
        let is = |one| wiring.whole().is(&Formula::number(number(one).into()));
        let (low, samples) =
            (LIMITS_LOW.of::<32>(guard.limits_low), DEBOUNCE_SAMPLES.of::<32>(guard.debounce));
        Self {
            exist: Parameter::of(
                &wiring.whole().is_not(&Formula::number(number(Wiring::None).into())),
            ),
            pair: Parameter::of(&is(Wiring::Pair)),
            one_for_all: Parameter::of(&is(Wiring::One)),
            low: Parameter::of(&low.bits(0)),
            last_sample: Parameter::of(&(samples.bits(0) - Formula::number(1))),
            limits_out_of_range: ParameterRefusal::of(&wiring.is_outside(0, 3)),
            limits_low_out_of_range: ParameterRefusal::of(&low.is_outside(0, 1)),
            debounce_samples_out_of_range: ParameterRefusal::of(
                &samples.is_outside(1, MAX_DEBOUNCE_SAMPLES.into()),
            ),
            ..Self::default()
        }
    }
}

impl<const N: usize> Logic for LimitSwitches<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, sync, now);
        clock!(self, clock, switches);

        // Selects and synchronizes the pin of this time slot.
        self.max.next = self.tick_1.val() & self.pair.val().any();
        self.samples.next = self.time_slot_ends.val() & (self.tick_0.val() | self.max.val());
        self.pins.next = self.limit_min.val();
        if self.max.val() {
            self.pins.next = self.limit_max.val();
        }
        self.chosen.next = self.pins.val() & self.axis_one_hot.val();
        if self.one_for_all.val().any() {
            self.chosen.next = self.pins.val() & self.first_one_hot.val();
        }
        self.sync.d.next = self.chosen.val().any() ^ self.low.val().any();
        self.now.d.next = self.sync.q.val();

        // The debounced state and its count.
        self.max_bit.next = self.no_side.val();
        if self.max.val() {
            self.max_bit.next = self.side.val();
        }
        self.switches.read_address.next =
            (bit_cast::<4, 3>(self.axis_next.val()) << self.by_one.val()) | self.max_bit.val();
        self.switches.write_address.next =
            (bit_cast::<4, 3>(self.axis.val()) << self.by_one.val()) | self.max_bit.val();
        self.word.next = self.switches.read_data.val();
        self.differs.next = self.now.q.val() ^ self.word.val().get_bit(SWITCH_STATE);
        self.flips.next = self.differs.val()
            & (self.word.val().get_bits::<7>(SWITCH_COUNT) == self.last_sample.val());
        self.state.next =
            (self.word.val().get_bit(SWITCH_STATE) ^ self.flips.val()) & !self.resetting.val();
        self.count.next = self.none.val();
        if self.differs.val() & !self.flips.val() & !self.resetting.val() {
            self.count.next = self.word.val().get_bits::<7>(SWITCH_COUNT) + self.one.val();
        }
        self.next_word.next = bit_cast::<8, 7>(self.count.val());
        if self.state.val() {
            self.next_word.next = bit_cast::<8, 7>(self.count.val()) | self.active.val();
        }
        self.switches.write_data.next = self.next_word.val();
        self.switches.write_bits.next = self.no.val();
        if self.samples.val() & self.exist.val().any() {
            self.switches.write_bits.next = self.all.val();
        }

        // A switch of a pair stops the axis in one direction, as long as it is active. A single
        // switch stops the axis only when it becomes active, so that the axis can leave it in
        // either direction.
        self.hit.next = self.samples.val()
            & self.exist.val().any()
            & self.goes.val()
            & self.state.val()
            & ((self.pair.val().any() & (self.back.val() ^ self.max.val()))
                | (!self.pair.val().any() & self.flips.val()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn limits_synthesizes() {
        let guard = Guard { limits: Wiring::Pair, debounce: 10, ..Guard::minimal(Vec::new()) };
        assert_synthesizes(LimitSwitches::<6>::new(&guard), "carrystep_limits");
    }
}

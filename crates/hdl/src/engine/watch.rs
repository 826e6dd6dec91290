//! What is watched beside the axes: the e-stop, the host's signs of life, the drivers' power.
//!
//! ```text
//! strobe   _/^\__/^\__/^\__/^\__/^\__/^\__/^\__/^\__
//! round     0 |  1 |  2 |  3 |  0 |  1 |  2 |  3 |      slow times are counted in rounds
//! e-stop   __________/^^^^^^^^^^^^^^                    pressed when it has been so for a tick
//! ```

use crate::parameters::{ENABLE_ROUNDS, ESTOP_LOW, ROUND_TICKS, WATCHDOG_ROUNDS};
use crate::primitives::constant::{Literal, Parameter, Refusal};
use crate::primitives::formula::Formula;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::engine::{Guard, MAX_ROUND, MAX_ROUNDS};
use rust_hdl::prelude::*;

/// E-stop, watchdog, ENABLE, and the round.
#[derive(LogicBlock, Default)]
pub struct Watch {
    /// The clock.
    pub clock: Input<Clock>,
    /// Last cycle of a tick.
    pub strobe: Input<Bit>,
    /// The e-stop's pin.
    pub estop: Input<Bit>,
    /// The host was heard of.
    pub kick: Input<Bit>,
    /// The host wants the drivers to be powered.
    pub enable: Input<Bit>,
    /// Nothing moves or will.
    pub idle: Input<Bit>,
    /// At a strobe: the e-stop was active for a tick.
    pub pressed: Signal<Out, Bit>,
    /// The host has been silent for too long.
    pub missed: Signal<Out, Bit>,
    /// The drivers are to be powered,
    pub enabled: Signal<Out, Bit>,
    /// and have been for long enough.
    pub warm: Signal<Out, Bit>,
    /// First tick of a round.
    pub tick_0: Signal<Out, Bit>,
    /// Second tick of a round.
    pub tick_1: Signal<Out, Bit>,
    sync: Register<Bit>,
    now: Register<Bit>,
    held: Register<Bit>,
    round: Register<Word<10>>,
    silence: Register<Word<12>>,
    power: Register<Bit>, // `enabled`
    warmth: Register<Word<12>>,
    round_over: Signal<Local, Bit>,
    silent: Signal<Local, Bit>,
    is_warm: Signal<Local, Bit>,
    pressed_low: Parameter<1>,
    round_bits: Parameter<10>,
    watchdog: Parameter<12>,
    silence_bits: Parameter<12>,
    warm_at: Parameter<12>,
    warm_bits: Parameter<12>,
    first_tick: Literal<10, 0>,
    one_tick: Literal<10, 1>,
    no_round: Literal<12, 0>,
    one_round: Literal<12, 1>,
    round_ticks_out_of_range: Refusal,
    watchdog_rounds_out_of_range: Refusal,
    enable_rounds_out_of_range: Refusal,
    estop_low_out_of_range: Refusal,
}

impl Watch {
    /// The watch of this guard, which has been checked.
    pub fn new(guard: &Guard) -> Self {
        let (watchdog, enable) = (WATCHDOG_ROUNDS.of::<32>(guard.watchdog), ENABLE_ROUNDS.of::<32>(guard.enable));
        let (round, estop_low) = (ROUND_TICKS.of::<32>(guard.round), ESTOP_LOW.of::<32>(guard.estop_low));
        let no_power = (round.whole() & (round.whole() - Formula::number(1))).is_not(&Formula::number(0));
        Self {
            pressed_low: Parameter::of(&estop_low.bits(0)),
            round_bits: Parameter::of(&(round.bits(0) - Formula::number(1))),
            watchdog: Parameter::of(&watchdog.bits(0)),
            silence_bits: Parameter::of(&watchdog.bits::<12>(0).used_bits()),
            warm_at: Parameter::of(&enable.bits(0)),
            warm_bits: Parameter::of(&enable.bits::<12>(0).used_bits()),
            round_ticks_out_of_range: Refusal::of(&(round.is_outside(2, MAX_ROUND.into()) | no_power)),
            watchdog_rounds_out_of_range: Refusal::of(&watchdog.is_outside(0, MAX_ROUNDS.into())),
            enable_rounds_out_of_range: Refusal::of(&enable.is_outside(0, MAX_ROUNDS.into())),
            estop_low_out_of_range: Refusal::of(&estop_low.is_outside(0, 1)),
            ..Self::default()
        }
    }
}

impl Logic for Watch {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, sync, now, held, round, silence, power, warmth);

        // The e-stop.
        self.sync.d.next = self.estop.val() ^ self.pressed_low.val().any();
        self.now.d.next = self.sync.q.val();
        self.held.d.next = self.now.q.val() & (self.held.q.val() | self.strobe.val());
        self.pressed.next = self.held.q.val() & self.now.q.val();

        // The round.
        self.round_over.next = self.strobe.val() & (self.round.q.val() == self.round_bits.val());
        if self.strobe.val() {
            self.round.d.next = (self.round.q.val() + self.one_tick.val()) & self.round_bits.val();
        }
        self.tick_0.next = self.round.q.val() == self.first_tick.val();
        self.tick_1.next = self.round.q.val() == self.one_tick.val();

        // The host.
        self.silent.next = self.silence.q.val() == self.watchdog.val();
        if self.round_over.val() & !self.silent.val() {
            self.silence.d.next = (self.silence.q.val() + self.one_round.val()) & self.silence_bits.val();
        }
        if self.kick.val() {
            self.silence.d.next = self.no_round.val();
        }
        self.missed.next = self.silent.val() & self.watchdog.val().any();

        // The drivers.
        self.power.d.next = self.enable.val() | (self.power.q.val() & !self.idle.val());
        self.is_warm.next = self.warmth.q.val() == self.warm_at.val();
        if self.round_over.val() & !self.is_warm.val() {
            self.warmth.d.next = (self.warmth.q.val() + self.one_round.val()) & self.warm_bits.val();
        }
        if !self.power.q.val() {
            self.warmth.d.next = self.no_round.val();
        }
        self.warm.next = self.is_warm.val() & self.power.q.val();
        self.enabled.next = self.power.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn watch_synthesizes() {
        let guard = Guard { watchdog: 100, enable: 3, ..Guard::minimal(Vec::new()) };
        assert_synthesizes(Watch::new(&guard), "carrystep_watch");
    }
}

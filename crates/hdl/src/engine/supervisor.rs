//! Monitors the e-stop and the host, times the power of the drivers, and counts the rounds.
//!
//! ```text
//! strobe   _/^\__/^\__/^\__/^\__/^\__/^\__/^\__/^\__
//! round     0 |  1 |  2 |  3 |  0 |  1 |  2 |  3 |      long times are counted in rounds of ticks
//! e-stop   __________/^^^^^^^^^^^^^^                    pressed if active in a whole tick
//! ```
//!
//! A round is a number of ticks, a power of two. The watchdog and the warm-up of the drivers count
//! rounds, so that their counters stay short.
//!
//! Interface: `pressed` and `missed` call stops at a strobe ([`super::stops`]); `warm` permits
//! starts.
//!
//! Cost: a counter of the ticks in a round, up to 10 bits, and two counters of rounds, up to 12
//! bits each.

use super::layout::{ROUND_FOURS, ROUND_ROW};
use crate::parameters::{ENABLE_ROUNDS, ESTOP_LOW, ROUND_TICKS, WATCHDOG_ROUNDS};
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::engine::{Guard, MAX_ROUND, MAX_ROUNDS};
use rust_hdl_core::prelude::*;

/// The e-stop, the watchdog, the power of the drivers, and the round.
#[derive(LogicBlock, Default)]
pub struct Supervisor {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick.
    pub strobe: Input<Bit>,
    /// The e-stop pin; asynchronous.
    pub estop: Input<Bit>,
    /// A sign of life of the host: the watchdog restarts.
    pub kick: Input<Bit>,
    /// The host requests power for the motor drivers.
    pub enable: Input<Bit>,
    /// All axes are at rest and no start is armed.
    pub idle: Input<Bit>,
    /// A reset is under way: the watchdog and the warm-up restart.
    pub ending: Input<Bit>,
    /// The last two ticks of a reset: the drivers get no power.
    pub resetting: Input<Bit>,
    /// A reset: the round restarts.
    pub restarts_round: Input<Bit>,
    /// At a strobe: the e-stop was active in the whole tick.
    pub pressed: Signal<Out, Bit>,
    /// The watchdog has timed out: no `kick` for the specified number of rounds.
    pub missed: Signal<Out, Bit>,
    /// The drivers are to be powered.
    pub enabled: Signal<Out, Bit>,
    /// The drivers have been powered for the specified number of rounds.
    pub warm: Signal<Out, Bit>,
    /// The number of the tick in its round, modulo 4: the row of the switches that are sampled.
    pub row: Signal<Out, Word<2>>,
    /// The tick is one of the first four of a round.
    pub begins_round: Signal<Out, Bit>,
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
    no_fours: Literal<8, 0>,
    no_round: Literal<12, 0>,
    one_round: Literal<12, 1>,
    round_ticks_out_of_range: ParameterRefusal,
    watchdog_rounds_out_of_range: ParameterRefusal,
    enable_rounds_out_of_range: ParameterRefusal,
    estop_low_out_of_range: ParameterRefusal,
}

impl Supervisor {
    /// Makes the monitor of this guard. The caller has checked the guard.
    pub fn new(guard: &Guard) -> Self {
        let (watchdog, enable) =
            (WATCHDOG_ROUNDS.of::<32>(guard.watchdog), ENABLE_ROUNDS.of::<32>(guard.enable));
        let (round, estop_low) =
            (ROUND_TICKS.of::<32>(guard.round), ESTOP_LOW.of::<32>(guard.estop_low));
        let no_power =
            (round.whole() & (round.whole() - Formula::number(1))).is_not(&Formula::number(0));
        Self {
            pressed_low: Parameter::of(&estop_low.bits(0)),
            round_bits: Parameter::of(&(round.bits(0) - Formula::number(1))),
            watchdog: Parameter::of(&watchdog.bits(0)),
            silence_bits: Parameter::of(&watchdog.bits::<12>(0).used_bits()),
            warm_at: Parameter::of(&enable.bits(0)),
            warm_bits: Parameter::of(&enable.bits::<12>(0).used_bits()),
            round_ticks_out_of_range: ParameterRefusal::of(
                &(round.is_outside(2, MAX_ROUND.into()) | no_power),
            ),
            watchdog_rounds_out_of_range: ParameterRefusal::of(
                &watchdog.is_outside(0, MAX_ROUNDS.into()),
            ),
            enable_rounds_out_of_range: ParameterRefusal::of(
                &enable.is_outside(0, MAX_ROUNDS.into()),
            ),
            estop_low_out_of_range: ParameterRefusal::of(&estop_low.is_outside(0, 1)),
            ..Self::default()
        }
    }
}

impl Logic for Supervisor {
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
        if self.restarts_round.val() {
            self.round.d.next = self.first_tick.val();
        }
        self.row.next = self.round.q.val().get_bits::<2>(ROUND_ROW);
        self.begins_round.next =
            self.round.q.val().get_bits::<8>(ROUND_FOURS) == self.no_fours.val();

        // The watchdog.
        self.silent.next = self.silence.q.val() == self.watchdog.val();
        if self.round_over.val() & !self.silent.val() {
            self.silence.d.next =
                (self.silence.q.val() + self.one_round.val()) & self.silence_bits.val();
        }
        if self.kick.val() | self.ending.val() {
            self.silence.d.next = self.no_round.val();
        }
        self.missed.next = self.silent.val() & self.watchdog.val().any();

        // The power of the drivers, and the time since it was switched on.
        self.power.d.next =
            (self.enable.val() | (self.power.q.val() & !self.idle.val())) & !self.resetting.val();
        self.is_warm.next = self.warmth.q.val() == self.warm_at.val();
        if self.round_over.val() & !self.is_warm.val() {
            self.warmth.d.next =
                (self.warmth.q.val() + self.one_round.val()) & self.warm_bits.val();
        }
        if !self.power.q.val() | self.ending.val() {
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
    fn supervisor_synthesizes() {
        let guard = Guard { watchdog: 100, enable: 3, ..Guard::minimal(Vec::new()) };
        assert_synthesizes(Supervisor::new(&guard), "carrystep_supervisor");
    }
}

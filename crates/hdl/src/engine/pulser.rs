//! Turns requested steps into STEP and DIR pulses for one axis of the engine. Its pins equal those
//! of [`crate::parts::shaper`] in every clock.
//!
//! ```text
//! DIR  ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\_______
//!          :DIR_SETUP:<-DIR_HOLD>:             :
//! STEP ______________/^^^^^^\________/^^^^^^\__________
//!           STEP_HIGH:<---->:<------>:STEP_LOW
//! ```
//!
//! `STEP_HIGH` is the least time for which STEP is high, `STEP_LOW` that for which it is low; so
//! two rising edges are at least their sum apart. `DIR_SETUP` is the set-up of DIR before STEP
//! rises, `DIR_HOLD` its hold after STEP has risen. All are in clocks, from 1 to 65536
//! ([`MAX_CLOCKS`]).
//!
//! A step that this timing delays is held back (`due` in the code, `held_back` at the output), at
//! most one. When a second step arrives, there are two cases:
//! - If the first one rises in this clock, the second one takes its place and is held back.
//! - Otherwise the second one is discarded and counted, and `overruns` is asserted. This calls the
//!   engine's stop `overrun`, which freezes the pins from the next clock on: in that clock the
//!   first step is discarded and counted too.
//!
//! As soon as the hold time is over, DIR takes the direction of the step that is due or held back.
//! If there is none, it takes the direction of the last speed that was not zero (`want`). In the
//! code, `dir_changes` means that DIR changes.
//!
//! Two free-running counters measure the time: `since` counts clocks since STEP rose, `after`
//! clocks since DIR changed. A counter that reaches a limit only ends a condition (the pulse, the
//! gap, the hold or the set-up). The counters therefore need not stop, and their wrap-around has no
//! effect.
//!
//! Pulses and discarded steps are counted modulo eight. The queue and the adder compare these
//! counts with the 32-bit counters in memory, and correct the memory by at most one pulse of each
//! axis per tick. Discarded steps follow in the same way while the axis does not run.
//!
//! Cost: there is one pulser per axis; every other module of the engine exists once. The counters
//! of a pulser are as wide as its pin timing requires.

use crate::HdlError;
use crate::parameters::{DIR_HOLD, DIR_SETUP, STEP_HIGH, STEP_LOW};
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::PinTiming;
use carrystep_core::build::MAX_CLOCKS;
use rust_hdl_core::prelude::*;

/// The STEP and DIR pins of one axis.
#[derive(LogicBlock, Default)]
pub struct Pulser {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in a freezing stop. No new pulse starts and DIR does not change.
    pub frozen: Input<Bit>,
    /// A step is due in this clock.
    pub request: Input<Bit>,
    /// The requested step is backward.
    pub request_back: Input<Bit>,
    /// Asserted only at a strobe, if V != 0 in the tick before the one that ends: with the strobe
    /// that ends tick n + 1 the V of tick n, whose step is made in tick n + 2. The register `want`
    /// keeps the direction.
    pub has_sign: Input<Bit>,
    /// V < 0 in that tick; valid with `has_sign`.
    pub sign_back: Input<Bit>,
    /// The STEP pin.
    pub step: Signal<Out, Bit>,
    /// The DIR pin; 1 is backward.
    pub dir: Signal<Out, Bit>,
    /// A step is held back.
    pub held_back: Signal<Out, Bit>,
    /// Bits 2 to 0: steps forward less steps backward, modulo 8. Bits 5 to 3: discarded steps,
    /// modulo 8.
    pub counts: Signal<Out, Word<6>>,
    /// A second step arrives while one is held back that does not rise in this clock. The stop
    /// takes effect in the next clock.
    pub overruns: Signal<Out, Bit>,
    step_pin: Register<Bit>,
    dir_pin: Register<Bit>,
    want: Register<Bit>,
    due: Register<Bit>,        // `held_back`
    due_back: Register<Bit>,   // the direction of the step that is held back
    since: Register<Word<17>>, // clocks since STEP rose
    after: Register<Word<16>>, // clocks since DIR changed
    busy: Register<Bit>,       // the pulse or its gap lasts
    held: Register<Bit>,       // the hold time lasts: DIR may not change
    settled: Register<Bit>,    // the set-up time has elapsed
    count: Register<Word<3>>,  // the lower half of `counts`
    lost: Register<Word<3>>,   // the upper half of `counts`
    pending: Signal<Local, Bit>,
    first_back: Signal<Local, Bit>,
    rise: Signal<Local, Bit>,
    aim: Signal<Local, Bit>,
    dir_changes: Signal<Local, Bit>,
    second: Signal<Local, Bit>,
    late_now: Signal<Local, Bit>,
    change: Signal<Local, Word<3>>,
    step_high_over: Parameter<17>,
    step_low_over: Parameter<17>,
    hold_over: Parameter<17>,
    since_bits: Parameter<17>,
    setup_over: Parameter<16>,
    after_bits: Parameter<16>,
    holds: Parameter<1>,
    instant: Parameter<1>, // the set-up is one clock: STEP may rise in the clock after DIR changes
    since_rise: Literal<17, 0>,
    since_one: Literal<17, 1>,
    after_dir_change: Literal<16, 0>,
    after_one: Literal<16, 1>,
    at_3: Literal<4, 3>,
    one: Literal<3, 1>,
    minus_one: Literal<3, 7>,
    // Where a parameter is not from 1 to 65536, the Verilog instantiates a module that does not
    // exist, so that no tool accepts the design.
    step_high_out_of_range: ParameterRefusal,
    step_low_out_of_range: ParameterRefusal,
    dir_setup_out_of_range: ParameterRefusal,
    dir_hold_out_of_range: ParameterRefusal,
}

impl Pulser {
    /// Makes the pulser of an axis with this timing.
    ///
    /// # Errors
    /// Returns [`HdlError::PinTiming`] if a time is not from 1 to [`MAX_CLOCKS`] clocks.
    pub fn new(pins: &PinTiming) -> Result<Self, HdlError> {
        let &PinTiming { step_high, step_low, dir_setup, dir_hold } = pins;
        for (name, clocks) in [
            ("step_high", step_high),
            ("step_low", step_low),
            ("dir_setup", dir_setup),
            ("dir_hold", dir_hold),
        ] {
            if !(1..=MAX_CLOCKS).contains(&clocks) {
                return Err(HdlError::PinTiming { name, clocks });
            }
        }
        let (step_high, step_low) = (STEP_HIGH.of::<32>(step_high), STEP_LOW.of::<32>(step_low));
        let (dir_setup, dir_hold) = (DIR_SETUP.of::<32>(dir_setup), DIR_HOLD.of::<32>(dir_hold));
        let most = u64::from(MAX_CLOCKS);
        let step_high_over = step_high.bits::<17>(0) - Formula::number(1);
        let step_low_over = (step_high.bits::<17>(0) + step_low.bits::<17>(0)) - Formula::number(2);
        let hold_over = dir_hold.bits::<17>(0).without(Formula::number(2));
        // A set-up of 65536 clocks is 0 in 16 bits, and 0 - 2 wraps to 65534, the right limit.
        let at_once = dir_setup.whole().is(&Formula::number(1));
        let setup_over =
            Formula::number(0).where_or(&at_once, dir_setup.bits::<16>(0) - Formula::number(2));
        let greatest = step_low_over.clone().or_more(hold_over.clone());
        Ok(Self {
            step_high_over: Parameter::of(&step_high_over),
            step_low_over: Parameter::of(&step_low_over),
            hold_over: Parameter::of(&hold_over),
            since_bits: Parameter::of(&greatest.or_more(step_high_over).used_bits()),
            setup_over: Parameter::of(&setup_over),
            after_bits: Parameter::of(&setup_over.used_bits()),
            holds: Parameter::of(&dir_hold.whole().is_more(&Formula::number(1))),
            instant: Parameter::of(&at_once),
            step_high_out_of_range: ParameterRefusal::of(&step_high.is_outside(1, most)),
            step_low_out_of_range: ParameterRefusal::of(&step_low.is_outside(1, most)),
            dir_setup_out_of_range: ParameterRefusal::of(&dir_setup.is_outside(1, most)),
            dir_hold_out_of_range: ParameterRefusal::of(&dir_hold.is_outside(1, most)),
            ..Self::default()
        })
    }
}

impl Logic for Pulser {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self, clock, step_pin, dir_pin, want, due, due_back, since, after, busy, held, settled
        );
        dff_setup!(self, clock, count, lost);

        // The direction that DIR should have, and the direction of the step that is due.
        if self.has_sign.val() {
            self.want.d.next = self.sign_back.val();
        }
        self.pending.next = self.due.q.val() | self.request.val();
        self.first_back.next = self.request_back.val();
        if self.due.q.val() {
            self.first_back.next = self.due_back.q.val();
        }

        // Decides whether STEP rises and whether DIR changes in this clock.
        self.rise.next = self.pending.val()
            & !self.frozen.val()
            & !self.busy.q.val()
            & (self.settled.q.val() | self.instant.val().any())
            & (self.dir_pin.q.val() == self.first_back.val());
        self.aim.next = self.want.q.val();
        if self.pending.val() {
            self.aim.next = self.first_back.val();
        }
        self.dir_changes.next =
            !self.frozen.val() & !self.held.q.val() & (self.dir_pin.q.val() != self.aim.val());

        // The pins.
        self.step_pin.d.next = self.rise.val()
            | (self.step_pin.q.val() & (self.since.q.val() != self.step_high_over.val()));
        self.dir_pin.d.next = self.dir_pin.q.val() ^ self.dir_changes.val();

        // The time since STEP rose limits the pulse, the gap and the hold.
        self.since.d.next = (self.since.q.val() + self.since_one.val()) & self.since_bits.val();
        self.busy.d.next = self.busy.q.val() & (self.since.q.val() != self.step_low_over.val());
        self.held.d.next = self.held.q.val() & (self.since.q.val() != self.hold_over.val());
        if self.rise.val() {
            self.since.d.next = self.since_rise.val();
            self.busy.d.next = true;
            self.held.d.next = self.holds.val().any();
        }

        // The time since DIR changed limits the set-up.
        self.after.d.next = (self.after.q.val() + self.after_one.val()) & self.after_bits.val();
        self.settled.d.next = self.settled.q.val() | (self.after.q.val() == self.setup_over.val());
        if self.dir_changes.val() {
            self.after.d.next = self.after_dir_change.val();
            self.settled.d.next = false;
        }

        // The position, modulo 8.
        self.change.next = self.one.val();
        if self.dir_pin.q.val() {
            self.change.next = self.minus_one.val();
        }
        if self.rise.val() {
            self.count.d.next = self.count.q.val() + self.change.val();
        }

        // The step that is held back, and the count of discarded steps, at most one per clock.
        // Every requested step is made, held back or counted as discarded.
        self.second.next = self.due.q.val() & self.request.val();
        self.late_now.next = self.second.val() & !self.rise.val() & !self.frozen.val();
        self.due.d.next =
            (self.pending.val() & !self.rise.val() & !self.frozen.val()) | self.second.val();
        if !self.due.q.val() | self.rise.val() {
            self.due_back.d.next = self.request_back.val();
        }
        if (self.frozen.val() & self.pending.val()) | self.late_now.val() {
            self.lost.d.next = self.lost.q.val() + self.one.val();
        }

        self.step.next = self.step_pin.q.val();
        self.dir.next = self.dir_pin.q.val();
        self.held_back.next = self.due.q.val();
        self.counts.next = bit_cast::<6, 3>(self.count.q.val())
            | (bit_cast::<6, 3>(self.lost.q.val()) << self.at_3.val());
        self.overruns.next = self.late_now.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn pulser_synthesizes() {
        let pins = PinTiming { step_high: 12, step_low: 5, dir_setup: 3, dir_hold: 2 };
        assert_synthesizes(Pulser::new(&pins).unwrap(), "carrystep_pulser");
    }
}

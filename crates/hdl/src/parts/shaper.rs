//! Turns requested steps into STEP and DIR pulses that keep the timing of the motor driver.
//!
//! ```text
//! DIR  ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\_______
//!          :DIR_SETUP:<-DIR_HOLD>:             :
//! STEP ______________/^^^^^^\________/^^^^^^\__________
//!           STEP_HIGH:<---->:<------>:STEP_LOW
//! ```
//!
//! `STEP_HIGH` is the least time for which STEP is high, `STEP_LOW` that for which it is low.
//! `DIR_SETUP` is the set-up of DIR before STEP rises, `DIR_HOLD` its hold after STEP has risen.
//! All are in clocks.
//!
//! Interface: the edge requests a step for one clock. If the pin timing delays the step, the shaper
//! holds it back (`held_back` in the code), at most one per axis. If a second step arrives while
//! one is held back, the shaper reports the fault `overrun`. DIR follows the sign of V as soon as
//! it is known, so that the set-up time has normally elapsed before the step is due.
//!
//! Cost: three timers that count down: `busy` for the pulse and its gap, `hold` and `setup` for
//! DIR; and two counters of 32 bits for the position and the discarded steps. The engine's
//! [`crate::engine::pulser`] does the same with shorter counters.

use crate::HdlError;
use crate::parameters::{DIR_HOLD, DIR_SETUP, STEP_HIGH, STEP_LOW};
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::PinTiming;
use carrystep_core::build::MAX_CLOCKS;
use rust_hdl_core::prelude::*;

/// The STEP and DIR pins and the position counter of one axis.
#[derive(LogicBlock, Default)]
pub struct Shaper {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted while a fault is latched. No new pulse starts and DIR does not change.
    pub frozen: Input<Bit>,
    /// Clears the fault.
    pub clear: Input<Bit>,
    /// A step is due in this clock.
    pub request: Input<Bit>,
    /// The requested step is backward.
    pub request_back: Input<Bit>,
    /// V > 0: DIR should be forward.
    pub want_fwd: Input<Bit>,
    /// V < 0: DIR should be backward.
    pub want_back: Input<Bit>,
    /// The STEP pin.
    pub step: Signal<Out, Bit>,
    /// The DIR pin; 1 is backward.
    pub dir: Signal<Out, Bit>,
    /// A step is held back.
    pub held_back: Signal<Out, Bit>,
    /// The steps forward less the steps backward, 32 bits two's complement.
    pub position: Signal<Out, Word<32>>,
    /// The number of steps that were requested but not made, modulo 2^32: the step of an overrun
    /// and those discarded while frozen.
    pub discarded: Signal<Out, Word<32>>,
    /// Latched fault: a second step arrived while one was held back.
    pub overrun: Signal<Out, Bit>,
    step_pin: Register<Bit>,
    dir_pin: Register<Bit>,
    want: Register<Bit>,
    due: Register<Bit>,      // `held_back` of docs/clock-by-clock.md
    due_back: Register<Bit>, // `held_back_dir`
    busy: Register<Word<17>>,
    hold: Register<Word<16>>,
    setup: Register<Word<16>>,
    steps: Register<Word<32>>, // `position`
    lost: Register<Word<32>>,  // `discarded`
    late: Register<Bit>,       // `overrun`
    want_now: Signal<Local, Bit>,
    pending: Signal<Local, Bit>,
    first_back: Signal<Local, Bit>,
    rise: Signal<Local, Bit>,
    aim: Signal<Local, Bit>,
    dir_changes: Signal<Local, Bit>,
    second: Signal<Local, Bit>,
    step_falls_at: Parameter<17>,
    busy_load: Parameter<17>,
    busy_bits: Parameter<17>,
    hold_load: Parameter<16>,
    hold_bits: Parameter<16>,
    setup_load: Parameter<16>,
    setup_bits: Parameter<16>,
    busy_one: Literal<17, 1>,
    timer_one: Literal<16, 1>,
    one: Literal<32, 1>,
    two: Literal<32, 2>,
    step_high_out_of_range: ParameterRefusal,
    step_low_out_of_range: ParameterRefusal,
    dir_setup_out_of_range: ParameterRefusal,
    dir_hold_out_of_range: ParameterRefusal,
}

impl Shaper {
    /// Makes the shaper of an axis with this timing.
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
        let busy_load = (step_high.bits::<17>(0) + step_low.bits::<17>(0)) - Formula::number(1);
        let (setup_load, hold_load) = (
            dir_setup.bits::<16>(0) - Formula::number(1),
            dir_hold.bits::<16>(0) - Formula::number(1),
        );
        Ok(Self {
            setup: Register::of(&setup_load),
            step_falls_at: Parameter::of(&step_low.bits(0)),
            busy_load: Parameter::of(&busy_load),
            busy_bits: Parameter::of(&busy_load.used_bits()),
            hold_load: Parameter::of(&hold_load),
            hold_bits: Parameter::of(&hold_load.used_bits()),
            setup_load: Parameter::of(&setup_load),
            setup_bits: Parameter::of(&setup_load.used_bits()),
            step_high_out_of_range: ParameterRefusal::of(&step_high.is_outside(1, most)),
            step_low_out_of_range: ParameterRefusal::of(&step_low.is_outside(1, most)),
            dir_setup_out_of_range: ParameterRefusal::of(&dir_setup.is_outside(1, most)),
            dir_hold_out_of_range: ParameterRefusal::of(&dir_hold.is_outside(1, most)),
            ..Self::default()
        })
    }
}

impl Logic for Shaper {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self, clock, step_pin, dir_pin, want, due, due_back, busy, hold, setup, steps, lost,
            late
        );

        // The direction that DIR should have, and the direction of the step that is due.
        self.want_now.next = self.want_back.val() | (self.want.q.val() & !self.want_fwd.val());
        self.want.d.next = self.want_now.val();
        self.pending.next = self.due.q.val() | self.request.val();
        self.first_back.next = self.request_back.val();
        if self.due.q.val() {
            self.first_back.next = self.due_back.q.val();
        }

        // Decides whether STEP rises and whether DIR changes in this clock.
        self.rise.next = self.pending.val()
            & !self.frozen.val()
            & !self.busy.q.val().any()
            & !self.setup.q.val().any()
            & (self.dir_pin.q.val() == self.first_back.val());
        self.aim.next = self.want_now.val();
        if self.pending.val() {
            self.aim.next = self.first_back.val();
        }
        self.dir_changes.next = !self.frozen.val()
            & !self.hold.q.val().any()
            & (self.dir_pin.q.val() != self.aim.val());

        // The pins.
        self.step_pin.d.next = self.rise.val()
            | (self.step_pin.q.val() & (self.busy.q.val() != self.step_falls_at.val()));
        self.dir_pin.d.next = self.dir_pin.q.val() ^ self.dir_changes.val();

        // The timers.
        if self.rise.val() {
            self.busy.d.next = self.busy_load.val();
        } else if self.busy.q.val().any() {
            self.busy.d.next = (self.busy.q.val() - self.busy_one.val()) & self.busy_bits.val();
        }
        if self.rise.val() {
            self.hold.d.next = self.hold_load.val();
        } else if self.hold.q.val().any() {
            self.hold.d.next = (self.hold.q.val() - self.timer_one.val()) & self.hold_bits.val();
        }
        if self.dir_changes.val() {
            self.setup.d.next = self.setup_load.val();
        } else if self.setup.q.val().any() {
            self.setup.d.next = (self.setup.q.val() - self.timer_one.val()) & self.setup_bits.val();
        }

        // The position counter.
        if self.rise.val() {
            if self.dir_pin.q.val() {
                self.steps.d.next = self.steps.q.val() - self.one.val();
            } else {
                self.steps.d.next = self.steps.q.val() + self.one.val();
            }
        }

        // The step that is held back, and the count of discarded steps. Every requested step is
        // made, held back or counted as discarded.
        self.second.next = self.due.q.val() & self.request.val();
        self.due.d.next = self.pending.val() & !self.rise.val();
        if self.rise.val() {
            self.due.d.next = self.second.val();
        }
        if !self.due.q.val() | self.rise.val() {
            self.due_back.d.next = self.request_back.val();
        }
        if self.frozen.val() {
            self.due.d.next = false;
            self.due_back.d.next = self.due_back.q.val();
            if self.second.val() {
                self.lost.d.next = self.lost.q.val() + self.two.val();
            } else if self.pending.val() {
                self.lost.d.next = self.lost.q.val() + self.one.val();
            }
        } else if self.second.val() & !self.rise.val() {
            self.late.d.next = true;
            self.lost.d.next = self.lost.q.val() + self.one.val();
        }
        if self.clear.val() {
            self.late.d.next = false;
        }

        self.step.next = self.step_pin.q.val();
        self.dir.next = self.dir_pin.q.val();
        self.held_back.next = self.due.q.val();
        self.position.next = self.steps.q.val();
        self.discarded.next = self.lost.q.val();
        self.overrun.next = self.late.q.val();
    }
}

#[cfg(test)]
mod tests;

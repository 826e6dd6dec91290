//! The PWM: a pin that is active for a part of each period, its duty.
//!
//! ```text
//! count    0 | 1 | 2 | 3 | ...      | 4095 | 0 | 1 |      each for PWM_DIVIDER clocks
//! pin      ^^^^^^^^^^^^\_______________________/^^^^^^^    duty 3: active for 3 of 4096 steps
//! ```
//!
//! The counter runs freely from configuration on; a new duty counts from the clock in which it is
//! set. The pin is a register, one clock behind the counter.
//!
//! Interface: [`super::outputs`] sets the duty at a strobe.
//!
//! Cost: twelve flip-flops each for the counter and the duty, their comparison, and as many for the
//! divider as it has bits.

use crate::parameters::PWM_DIVIDER;
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::engine::MAX_PWM_DIVIDER;
use rust_hdl_core::prelude::*;

/// The counter, the duty and the pin.
#[derive(LogicBlock, Default)]
pub struct PulseWidth {
    /// The clock.
    pub clock: Input<Clock>,
    /// The duty changes.
    pub set: Input<Bit>,
    /// The new duty, valid with `set`.
    pub duty: Input<Word<12>>,
    /// The pin is off from the next clock on, and the duty is 0.
    pub off: Input<Bit>,
    /// The pin; 1 is active.
    pub pin: Signal<Out, Bit>,
    divided: Register<Word<8>>,
    count: Register<Word<12>>,
    width: Register<Word<12>>, // the duty
    high: Register<Bit>,       // `pin`
    over: Signal<Local, Bit>,
    last: Parameter<8>,
    divider_bits: Parameter<8>,
    steps: Parameter<12>, // all bits of the counter; 0 without a PWM
    one_clock: Literal<8, 1>,
    no_clock: Literal<8, 0>,
    one_step: Literal<12, 1>,
    no_duty: Literal<12, 0>,
    pwm_divider_out_of_range: ParameterRefusal,
}

impl PulseWidth {
    /// Makes the PWM with this number of clocks for each step; with 0 its pin is always off.
    pub fn new(divider: u32) -> Self {
        let divider = PWM_DIVIDER.of::<32>(divider);
        let number = Formula::<32>::number;
        let exists = divider.whole().is_not(&number(0));
        let last = || {
            let last = divider.bits::<8>(0) - Formula::number(1);
            last.where_or(&exists, Formula::number(0))
        };
        Self {
            last: Parameter::of(&last()),
            divider_bits: Parameter::of(&last().used_bits()),
            steps: Parameter::of(&Formula::number(0xfff).where_or(&exists, Formula::number(0))),
            pwm_divider_out_of_range: ParameterRefusal::of(
                &divider.is_outside(0, MAX_PWM_DIVIDER.into()),
            ),
            ..Self::default()
        }
    }
}

impl Logic for PulseWidth {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, divided, count, width, high);

        self.over.next = self.divided.q.val() == self.last.val();
        self.divided.d.next =
            (self.divided.q.val() + self.one_clock.val()) & self.divider_bits.val();
        if self.over.val() {
            self.divided.d.next = self.no_clock.val();
            self.count.d.next = (self.count.q.val() + self.one_step.val()) & self.steps.val();
        }
        if self.set.val() {
            self.width.d.next = self.duty.val() & self.steps.val();
        }
        if self.off.val() {
            self.width.d.next = self.no_duty.val();
        }
        self.high.d.next = (self.count.q.val() < self.width.q.val()) & !self.off.val();
        self.pin.next = self.high.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn pulse_width_synthesizes() {
        assert_synthesizes(PulseWidth::new(7), "carrystep_pulse_width");
    }
}

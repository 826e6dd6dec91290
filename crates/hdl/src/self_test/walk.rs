//! The walk: one output at a time is 1, for a period of two halves of H clocks.
//!
//! ```text
//! active   | 1 (no pin)    | row 1         | ... | row W         | 1 (no pin)
//! lit      ^^^^^^^^\_______/^^^^^^^^\_______       ^^^^^^^^\_______/^^^^
//!          |<- H ->|<- H ->|
//! walks                  /^\                            /^\
//! ```
//!
//! Interface: `walks` is asserted in the clock in which the next output becomes active. At the end
//! of a period the walk waits for `idle`, so that the name of the output is sent at once.
//!
//! Cost: a timer that is as wide as H requires, and a flip-flop for each output.

use crate::parameters::HALF_CLOCKS;
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::SelfTest;
use carrystep_core::self_test::MAX_HALF_CLOCKS;
use rust_hdl_core::prelude::*;

/// The timer and the active output.
#[derive(LogicBlock, Default)]
pub struct Walk {
    /// The clock.
    pub clock: Input<Clock>,
    /// Nothing is being sent or waits to be sent.
    pub idle: Input<Bit>,
    /// The next output becomes active.
    pub walks: Signal<Out, Bit>,
    /// The row of that output; 0: none becomes active.
    pub next_slot: Signal<Out, Word<6>>,
    /// The output that is 1, at the bit of its row; bit 0: none is.
    pub active: Signal<Out, Word<64>>,
    /// The period is in its first half.
    pub lit: Signal<Out, Bit>,
    timer: Register<Word<30>>,
    second: Register<Bit>,
    slot: Register<Word<6>>,
    bits: Register<Word<64>>, // `active`
    over: Signal<Local, Bit>,
    due: Signal<Local, Bit>,
    goes: Signal<Local, Bit>,
    at_end: Signal<Local, Bit>,
    to_slot: Signal<Local, Word<6>>,
    last_clock: Parameter<30>,
    timer_bits: Parameter<30>,
    last_slot: Parameter<6>,
    one_clock: Literal<30, 1>,
    one_slot: Literal<6, 1>,
    no_slot: Literal<6, 0>,
    no_pin: Literal<64, 1>,
    by_one: Literal<1, 1>,
    half_clocks_out_of_range: ParameterRefusal,
}

impl Walk {
    /// Makes the walk of this build, in its first period, in which no output is active.
    pub fn new(build: &SelfTest) -> Self {
        let half = HALF_CLOCKS.of::<32>(build.half_clocks());
        // 2^30 clocks are 0 in 30 bits, and one less is their last.
        let last = half.bits::<30>(0) - Formula::number(1);
        Self {
            timer: Register::of(&last),
            bits: Register::new(Word::from(1_u64)),
            last_clock: Parameter::of(&last),
            timer_bits: Parameter::of(&last.used_bits()),
            last_slot: Parameter::new(build.last_output() as u64),
            half_clocks_out_of_range: ParameterRefusal::of(
                &half.is_outside(1, MAX_HALF_CLOCKS.into()),
            ),
            ..Self::default()
        }
    }
}

impl Logic for Walk {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, timer, second, slot, bits);
        self.over.next = !self.timer.q.val().any();
        self.due.next = self.over.val() & self.second.q.val();
        self.goes.next = self.due.val() & self.idle.val();
        self.at_end.next = self.slot.q.val() == self.last_slot.val();
        self.to_slot.next = self.slot.q.val() + self.one_slot.val();
        if self.at_end.val() {
            self.to_slot.next = self.no_slot.val();
        }

        if !self.over.val() {
            self.timer.d.next = (self.timer.q.val() - self.one_clock.val()) & self.timer_bits.val();
        }
        if self.over.val() & !self.second.q.val() {
            self.timer.d.next = self.last_clock.val();
            self.second.d.next = true;
        }
        if self.goes.val() {
            self.timer.d.next = self.last_clock.val();
            self.second.d.next = false;
            self.slot.d.next = self.to_slot.val();
            self.bits.d.next = self.bits.q.val() << self.by_one.val();
            if self.at_end.val() {
                self.bits.d.next = self.no_pin.val();
            }
        }

        self.walks.next = self.goes.val();
        self.next_slot.next = self.to_slot.val();
        self.active.next = self.bits.q.val();
        self.lit.next = !self.second.q.val();
    }
}

//! From events to pins: the shaper of the engine. Its pins are those of [`crate::shaper`] in every clock.
//!
//! ```text
//! DIR  ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\_______
//!          :<-- D -->:<--- H --->:             :
//! STEP ______________/^^^^^^\________/^^^^^^\__________
//!                    :<-W ->:<- S -->:
//! ```
//!
//! What it does not have are counters of 32 bits: it counts pulses and discarded steps modulo eight, and
//! the engine carries them on in memory, one a tick.

use crate::HdlError;
use crate::constant::{Literal, Parameter, used_bits};
use crate::register::{Input, Register};
use crate::word::{Word, bit_cast};
use carrystep_spec::PinTiming;
use carrystep_spec::build::MAX_CLOCKS;
use rust_hdl::prelude::*;

/// STEP and DIR of one axis.
#[derive(LogicBlock, Default)]
pub struct Pulser {
    /// The clock.
    pub clock: Input<Clock>,
    /// A fault is latched: nothing new rises, DIR stays.
    pub frozen: Input<Bit>,
    /// Forget the fault.
    pub clear: Input<Bit>,
    /// A step is due.
    pub request: Input<Bit>,
    /// It goes backward.
    pub request_back: Input<Bit>,
    /// The next tick's V is not zero.
    pub has_sign: Input<Bit>,
    /// The next tick's V is negative.
    pub sign_back: Input<Bit>,
    /// The STEP pin.
    pub step: Signal<Out, Bit>,
    /// The DIR pin, 1 is backward.
    pub dir: Signal<Out, Bit>,
    /// A step is owed.
    pub owed: Signal<Out, Bit>,
    /// Steps forward less steps backward, modulo 8; above that the discarded steps, modulo 8.
    pub counts: Signal<Out, Word<6>>,
    /// A second step is owed: the fault comes with the next cycle.
    pub overruns: Signal<Out, Bit>,
    /// Fault: a second step was owed.
    pub overrun: Signal<Out, Bit>,
    step_pin: Register<Bit>,
    dir_pin: Register<Bit>,
    want: Register<Bit>,
    due: Register<Bit>,      // `owed`
    due_back: Register<Bit>, // its direction
    busy: Register<Word<17>>,
    hold: Register<Word<16>>,
    setup: Register<Word<16>>,
    count: Register<Word<3>>, // of `counts`
    lost: Register<Word<3>>,
    late: Register<Bit>, // `overrun`
    pending: Signal<Local, Bit>,
    first_back: Signal<Local, Bit>,
    rise: Signal<Local, Bit>,
    aim: Signal<Local, Bit>,
    turn: Signal<Local, Bit>,
    second: Signal<Local, Bit>,
    lates: Signal<Local, Bit>,
    gap: Parameter<17>,
    busy_load: Parameter<17>,
    busy_bits: Parameter<17>,
    hold_load: Parameter<16>,
    hold_bits: Parameter<16>,
    setup_load: Parameter<16>,
    setup_bits: Parameter<16>,
    busy_one: Literal<17, 1>,
    timer_one: Literal<16, 1>,
    at_3: Literal<4, 3>,
    one: Literal<3, 1>,
    two: Literal<3, 2>,
    minus_one: Literal<3, 7>,
}

impl Pulser {
    /// The pulser of an axis with this timing.
    ///
    /// # Errors
    /// [`HdlError::PinTiming`] where a figure is not from 1 to [`MAX_CLOCKS`].
    pub fn new(pins: &PinTiming) -> Result<Self, HdlError> {
        let &PinTiming { width, gap, setup, hold } = pins;
        for (name, clocks) in [("width", width), ("gap", gap), ("setup", setup), ("hold", hold)] {
            if !(1..=MAX_CLOCKS).contains(&clocks) {
                return Err(HdlError::PinTiming { name, clocks });
            }
        }
        let [width, gap, setup, hold] = [width, gap, setup, hold].map(u64::from);
        let (busy_load, setup_load, hold_load) = (width + gap - 1, setup - 1, hold - 1);
        Ok(Self {
            setup: Register::new(Word::from(setup_load)),
            gap: Parameter::new(gap),
            busy_load: Parameter::new(busy_load),
            busy_bits: Parameter::new(used_bits(busy_load)),
            hold_load: Parameter::new(hold_load),
            hold_bits: Parameter::new(used_bits(hold_load)),
            setup_load: Parameter::new(setup_load),
            setup_bits: Parameter::new(used_bits(setup_load)),
            ..Self::default()
        })
    }
}

impl Logic for Pulser {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, step_pin, dir_pin, want, due, due_back, busy, hold, setup, count, lost, late);

        // Which way DIR should point, and which step is due.
        if self.has_sign.val() {
            self.want.d.next = self.sign_back.val();
        }
        self.pending.next = self.due.q.val() | self.request.val();
        self.first_back.next = self.request_back.val();
        if self.due.q.val() {
            self.first_back.next = self.due_back.q.val();
        }

        // May it rise; may DIR turn.
        self.rise.next = self.pending.val()
            & !self.frozen.val()
            & !self.busy.q.val().any()
            & !self.setup.q.val().any()
            & (self.dir_pin.q.val() == self.first_back.val());
        self.aim.next = self.want.q.val();
        if self.pending.val() {
            self.aim.next = self.first_back.val();
        }
        self.turn.next = !self.frozen.val() & !self.hold.q.val().any() & (self.dir_pin.q.val() != self.aim.val());

        // The pins.
        self.step_pin.d.next = self.rise.val() | (self.step_pin.q.val() & (self.busy.q.val() != self.gap.val()));
        self.dir_pin.d.next = self.dir_pin.q.val() ^ self.turn.val();

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
        if self.turn.val() {
            self.setup.d.next = self.setup_load.val();
        } else if self.setup.q.val().any() {
            self.setup.d.next = (self.setup.q.val() - self.timer_one.val()) & self.setup_bits.val();
        }

        // Where the axis is.
        if self.rise.val() {
            if self.dir_pin.q.val() {
                self.count.d.next = self.count.q.val() + self.minus_one.val();
            } else {
                self.count.d.next = self.count.q.val() + self.one.val();
            }
        }

        // What is owed, and what is lost: in silence nothing is.
        self.second.next = self.due.q.val() & self.request.val();
        self.due.d.next = !self.frozen.val() & ((self.pending.val() & !self.rise.val()) | self.second.val());
        if !self.due.q.val() | self.rise.val() {
            self.due_back.d.next = self.request_back.val();
        }
        self.lates.next = self.second.val() & !self.rise.val() & !self.frozen.val();
        if self.frozen.val() & self.second.val() {
            self.lost.d.next = self.lost.q.val() + self.two.val();
        } else if (self.frozen.val() & self.pending.val()) | self.lates.val() {
            self.lost.d.next = self.lost.q.val() + self.one.val();
        }
        if self.clear.val() {
            self.late.d.next = false;
        } else if self.lates.val() {
            self.late.d.next = true;
        }

        self.step.next = self.step_pin.q.val();
        self.dir.next = self.dir_pin.q.val();
        self.owed.next = self.due.q.val();
        self.counts.next =
            bit_cast::<6, 3>(self.count.q.val()) | (bit_cast::<6, 3>(self.lost.q.val()) << self.at_3.val());
        self.overruns.next = self.lates.val();
        self.overrun.next = self.late.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn pulser_synthesizes() {
        let pins = PinTiming { width: 12, gap: 5, setup: 3, hold: 2 };
        assert_synthesizes(Pulser::new(&pins).unwrap(), "carrystep_pulser");
    }
}

//! The reset: freezes the engine, waits until it is at rest, and returns it to its state at
//! configuration within two ticks.
//!
//! ```text
//! reset    _/^\________________________________________
//! ending   ___/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\____   a freeze; no new pulse
//! stage_1  _______________________/^^^^^^\____________   one tick: switches of the rows 0 and 2
//! stage_2  ______________________________/^^^^^^\_____   one tick: switches of the rows 1 and 3,
//! completes ___________________________________/^\_____   queues, P and counters; then the rest
//! ```
//!
//! Interface: [`super::stops`] freezes all axes while `ending` is asserted, and treats `stage_2` as
//! the tick that clears. The modules with counters of their own return them to their initial
//! values while `resetting` is asserted.
//!
//! Cost: three flip-flops, and some 30 cells in all modules. If `reset` is tied to 0, synthesis
//! removes all of it.

use crate::primitives::register::{Input, Register};
use rust_hdl_core::prelude::*;

/// The stages of a reset.
#[derive(LogicBlock, Default)]
pub struct Resets {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick.
    pub strobe: Input<Bit>,
    /// The host requests a reset.
    pub reset: Input<Bit>,
    /// A stop has been complete for a whole tick, and no clear of it is under way.
    pub settled: Input<Bit>,
    /// A step is held back, or a STEP pin is high.
    pub pins_busy: Input<Bit>,
    /// A reset is under way: all axes freeze.
    pub ending: Signal<Out, Bit>,
    /// The first of the two ticks in which the state is reset.
    pub stage_1: Signal<Out, Bit>,
    /// The second of them. It is repeated while `reset` is asserted.
    pub stage_2: Signal<Out, Bit>,
    /// One of the two ticks.
    pub resetting: Signal<Out, Bit>,
    /// Asserted in the last clock of a reset.
    pub completes: Signal<Out, Bit>,
    /// At a strobe: the counter of ticks in a round restarts.
    pub restarts_round: Signal<Out, Bit>,
    asked: Register<Bit>, // `ending`
    first: Register<Bit>,
    second: Register<Bit>,
    over: Signal<Local, Bit>,
}

impl Logic for Resets {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, asked, first, second);

        self.over.next = self.strobe.val() & self.second.q.val() & !self.reset.val();
        if self.over.val() {
            self.asked.d.next = false;
        }
        if self.reset.val() {
            self.asked.d.next = true;
        }
        if self.strobe.val() {
            self.first.d.next = self.asked.q.val()
                & self.settled.val()
                & !self.pins_busy.val()
                & !self.first.q.val()
                & !self.second.q.val();
            self.second.d.next = self.first.q.val() | (self.second.q.val() & self.reset.val());
        }

        self.ending.next = self.asked.q.val();
        self.stage_1.next = self.first.q.val();
        self.stage_2.next = self.second.q.val();
        self.resetting.next = self.first.q.val() | self.second.q.val();
        self.completes.next = self.over.val();
        self.restarts_round.next = self.asked.q.val() & self.strobe.val() & !self.first.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn resets_synthesizes() {
        assert_synthesizes(Resets::default(), "carrystep_resets");
    }
}

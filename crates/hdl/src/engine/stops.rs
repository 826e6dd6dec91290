//! Who stops the axes, and how far the stop has come.
//!
//! ```text
//! fault    ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\____   the first cause stays, with its axes
//! frozen   ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\____   a freeze: the pins, at once
//! ramp     ________/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\____   from the strobe on
//! halted   ________/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\____   a freeze: likewise; a ramp: when all axes rest
//! settled  ____________/^^^^^^^^^^^^^^^^^^^^^^^^^^^^\____
//! clearing ____________________________________/^^^^\____
//! ```

use crate::parameters::LIMIT_FREEZES;
use crate::primitives::constant::{Literal, Parameter, Refusal};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::engine::Guard;
use rust_hdl::prelude::*;

/// The stop that is under way.
#[derive(LogicBlock, Default)]
pub struct Stops<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// Last cycle of a tick.
    pub strobe: Input<Bit>,
    /// Last beat of a turn: what the axis finds counts.
    pub turn_ends: Input<Bit>,
    /// The axis, one bit.
    pub lane: Input<Word<N>>,
    /// It runs in this tick.
    pub runs: Input<Bit>,
    /// Its V does not fit.
    pub too_fast: Input<Bit>,
    /// It has reached a limit.
    pub limit: Input<Bit>,
    /// Its queue is dry.
    pub dry: Input<Bit>,
    /// These axes owe a second step.
    pub late: Input<Word<N>>,
    /// The e-stop is pressed.
    pub pressed: Input<Bit>,
    /// The host breaks the protocol.
    pub breaks: Input<Bit>,
    /// The host is missed.
    pub missed: Input<Bit>,
    /// The host asks for a stop.
    pub asked: Input<Bit>,
    /// The host wants to go on.
    pub clear: Input<Bit>,
    /// A step is owed, or a STEP is high.
    pub pins_busy: Input<Bit>,
    /// A stop is called.
    pub fault: Signal<Out, Bit>,
    /// This tick has found a cause.
    pub finds: Signal<Out, Bit>,
    /// No new edges.
    pub frozen: Signal<Out, Bit>,
    /// All axes slow down.
    pub ramp: Signal<Out, Bit>,
    /// No axis moves.
    pub halted: Signal<Out, Bit>,
    /// In this tick everything is cleared.
    pub clearing: Signal<Out, Bit>,
    /// The first cause.
    pub cause: Signal<Out, Word<3>>,
    /// The axes that it came from.
    pub culprits: Signal<Out, Word<N>>,
    called: Register<Bit>, // `fault`
    freeze: Register<Bit>, // `frozen`
    slow: Register<Bit>,   // `ramp`
    still: Register<Bit>,  // `halted`
    settled: Register<Bit>,
    wiping: Register<Bit>, // `clearing`
    first: Register<Word<3>>,
    axes: Register<Word<N>>,
    found: Register<Bit>,
    kind: Register<Word<3>>, // of what is found
    found_freezing: Register<Bit>,
    ran: Register<Bit>,
    finds_now: Signal<Local, Bit>,
    urgent: Signal<Local, Bit>,
    ripe: Signal<Local, Bit>,
    by_host: Signal<Local, Bit>,
    calls: Signal<Local, Bit>,
    limits_freeze: Parameter<1>,
    e_stop: Literal<3, 0>,
    overrun: Literal<3, 1>,
    protocol: Literal<3, 2>,
    watchdog: Literal<3, 3>,
    overspeed: Literal<3, 4>,
    limited: Literal<3, 5>,
    underrun: Literal<3, 6>,
    host: Literal<3, 7>,
    limit_freezes_out_of_range: Refusal,
}

impl<const N: usize> Stops<N> {
    /// The stops of this guard.
    pub fn new(guard: &Guard) -> Self {
        let freezes = LIMIT_FREEZES.of::<32>(guard.limit_freezes);
        Self {
            limits_freeze: Parameter::of(&freezes.bits(0)),
            limit_freezes_out_of_range: Refusal::of(&freezes.is_outside(0, 1)),
            ..Self::default()
        }
    }
}

impl<const N: usize> Logic for Stops<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, called, freeze, slow, still, settled, wiping);
        dff_setup!(self, clock, first, axes, found, kind, found_freezing, ran);

        // What the turns find.
        self.finds_now.next = self.turn_ends.val() & (self.too_fast.val() | self.limit.val() | self.dry.val());
        if self.finds_now.val() {
            self.found.d.next = true;
        }
        if self.finds_now.val() & !self.found.q.val() {
            self.kind.d.next = self.underrun.val();
            if self.limit.val() {
                self.kind.d.next = self.limited.val();
            }
            if self.too_fast.val() {
                self.kind.d.next = self.overspeed.val();
            }
        }
        if self.turn_ends.val() & (self.too_fast.val() | (self.limit.val() & self.limits_freeze.val().any())) {
            self.found_freezing.d.next = true;
        }
        if self.turn_ends.val() & self.runs.val() {
            self.ran.d.next = true;
        }

        // The first call.
        self.urgent.next = self.late.val().any() | (self.strobe.val() & self.pressed.val()) | self.breaks.val();
        self.ripe.next = self.strobe.val() & self.found.q.val();
        self.by_host.next = (self.strobe.val() & self.missed.val()) | self.asked.val();
        self.calls.next = self.urgent.val() | self.ripe.val() | self.by_host.val();
        if !self.called.q.val() {
            if self.urgent.val() | (self.by_host.val() & !self.ripe.val()) {
                self.axes.d.next = self.late.val();
            } else if self.finds_now.val() & !self.found.q.val() {
                self.axes.d.next = self.lane.val();
            }
        }
        if self.calls.val() & !self.called.q.val() {
            self.first.d.next = self.host.val();
            if self.strobe.val() & self.missed.val() {
                self.first.d.next = self.watchdog.val();
            }
            if self.ripe.val() {
                self.first.d.next = self.kind.q.val();
            }
            if self.breaks.val() {
                self.first.d.next = self.protocol.val();
            }
            if self.strobe.val() & self.pressed.val() {
                self.first.d.next = self.e_stop.val();
            }
            if self.late.val().any() {
                self.first.d.next = self.overrun.val();
            }
        }

        // How far it has come.
        if self.calls.val() {
            self.called.d.next = true;
        }
        if self.urgent.val() | (self.strobe.val() & self.found_freezing.q.val()) {
            self.freeze.d.next = true;
        }
        if self.strobe.val() {
            self.found.d.next = false;
            self.found_freezing.d.next = false;
            self.ran.d.next = false;
            self.slow.d.next = self.called.q.val() | self.found.q.val();
            self.still.d.next =
                self.freeze.q.val() | self.found_freezing.q.val() | (self.slow.q.val() & !self.ran.q.val());
            self.settled.d.next = self.still.q.val();
            self.wiping.d.next = self.clear.val()
                & self.settled.q.val()
                & !self.wiping.q.val()
                & !self.pins_busy.val()
                & !self.pressed.val();
            if self.wiping.q.val() {
                self.called.d.next = false;
                self.freeze.d.next = false;
                self.slow.d.next = false;
                self.still.d.next = false;
                self.settled.d.next = false;
            }
        }

        self.fault.next = self.called.q.val();
        self.finds.next = self.found.q.val();
        self.frozen.next = self.freeze.q.val();
        self.ramp.next = self.slow.q.val();
        self.halted.next = self.still.q.val();
        self.clearing.next = self.wiping.q.val();
        self.cause.next = self.first.q.val();
        self.culprits.next = self.axes.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn stops_synthesizes() {
        assert_synthesizes(Stops::<6>::new(&Guard::minimal(Vec::new())), "carrystep_stops");
    }
}

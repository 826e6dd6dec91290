//! Latches the first cause of a stop and controls the stop until it is cleared.
//!
//! ```text
//! fault    ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\____   the first cause is latched
//! frozen   ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\____   only in a freeze
//! ramp     ________/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\____   from the strobe on
//! halted   ________/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\____   in a ramp: only when all axes rest
//! settled  ____________/^^^^^^^^^^^^^^^^^^^^^^^^^^^^\____   one tick later
//! clearing ____________________________________/^^^\____   the tick that clears everything
//! ```
//!
//! A stop is either a freeze, in which no new pulse starts, or a ramp, in which each axis slows
//! down by its stop acceleration. The cause decides which, and for a limit the build does;
//! `docs/clock-by-clock.md` lists the causes. A freezing cause during a ramp freezes the axes too.
//!
//! Interface: causes arrive from the time slots (`too_fast`, `limit`, `dry`), from the pulsers
//! (`late`), from [`super::supervisor`] and from the host. Causes of a time slot take effect at the
//! strobe.
//!
//! Cost: about a dozen flip-flops, two registers of 4 bits for causes, and one flip-flop per axis.

use crate::parameters::LIMIT_FREEZES;
use crate::primitives::compiled_once;
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::engine::{CAUSE_BITS, Cause, Guard};
use rust_hdl_core::prelude::*;

/// The state of the present stop.
#[derive(LogicBlock, Default)]
pub struct Stops<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick.
    pub strobe: Input<Bit>,
    /// Asserted in the last beat of a time slot. The inputs about the slot's axis are valid in this
    /// clock.
    pub time_slot_ends: Input<Bit>,
    /// The axis of the slot, one-hot.
    pub axis_one_hot: Input<Word<N>>,
    /// The axis of the slot runs in this tick.
    pub runs: Input<Bit>,
    /// The V of the axis is out of range.
    pub too_fast: Input<Bit>,
    /// The axis has reached a limit.
    pub limit: Input<Bit>,
    /// The axis needs a segment, and its queue is empty.
    pub dry: Input<Bit>,
    /// The axes at which a second step arrives while one is held back.
    pub late: Input<Word<N>>,
    /// The e-stop is active.
    pub pressed: Input<Bit>,
    /// The host breaks the segment protocol.
    pub breaks: Input<Bit>,
    /// The watchdog has timed out.
    pub missed: Input<Bit>,
    /// The interlock is open.
    pub interlock: Input<Bit>,
    /// The host requests a controlled stop.
    pub asked: Input<Bit>,
    /// The host requests that the stop is cleared.
    pub clear: Input<Bit>,
    /// A step is held back, or a STEP pin is high.
    pub pins_busy: Input<Bit>,
    /// A reset is under way: all axes freeze, and `clear` has no effect.
    pub ending: Input<Bit>,
    /// The second tick of a reset, which clears the state of all axes.
    pub stage_2: Input<Bit>,
    /// Asserted in the last clock of a reset: the stop ends.
    pub completes: Input<Bit>,
    /// A stop has been called and has not been cleared.
    pub fault: Signal<Out, Bit>,
    /// A time slot of this tick has found a cause.
    pub finds: Signal<Out, Bit>,
    /// The stop is a freeze: no new pulse starts.
    pub frozen: Signal<Out, Bit>,
    /// All axes ramp down.
    pub ramp: Signal<Out, Bit>,
    /// No axis moves any more.
    pub halted: Signal<Out, Bit>,
    /// A stop has been complete for a whole tick, and `clear` is not clearing it.
    pub settles: Signal<Out, Bit>,
    /// This tick clears the state of all axes.
    pub clearing: Signal<Out, Bit>,
    /// The first cause.
    pub cause: Signal<Out, Word<CAUSE_BITS>>,
    /// The axes that caused the stop; bit i is axis i.
    pub culprits: Signal<Out, Word<N>>,
    called: Register<Bit>, // `fault`
    freeze: Register<Bit>, // `frozen`
    slow: Register<Bit>,   // `ramp`
    still: Register<Bit>,  // `halted`
    settled: Register<Bit>,
    wiping: Register<Bit>, // `clearing`
    first: Register<Word<CAUSE_BITS>>,
    axes: Register<Word<N>>,
    found: Register<Bit>,
    kind: Register<Word<CAUSE_BITS>>, // the cause found by a time slot
    found_freezing: Register<Bit>,
    ran: Register<Bit>,
    finds_now: Signal<Local, Bit>,
    urgent: Signal<Local, Bit>,
    ripe: Signal<Local, Bit>,
    by_host: Signal<Local, Bit>,
    calls: Signal<Local, Bit>,
    limits_freeze: Parameter<1>,
    e_stop: Literal<CAUSE_BITS, { Cause::EStop as u64 }>,
    overrun: Literal<CAUSE_BITS, { Cause::Overrun as u64 }>,
    protocol: Literal<CAUSE_BITS, { Cause::Protocol as u64 }>,
    watchdog: Literal<CAUSE_BITS, { Cause::Watchdog as u64 }>,
    overspeed: Literal<CAUSE_BITS, { Cause::Overspeed as u64 }>,
    limited: Literal<CAUSE_BITS, { Cause::Limit as u64 }>,
    underrun: Literal<CAUSE_BITS, { Cause::Underrun as u64 }>,
    host: Literal<CAUSE_BITS, { Cause::Stop as u64 }>,
    opened: Literal<CAUSE_BITS, { Cause::Interlock as u64 }>,
    limit_freezes_out_of_range: ParameterRefusal,
}

impl<const N: usize> Stops<N> {
    /// Makes the stop control of this guard.
    pub fn new(guard: &Guard) -> Self {
        let freezes = LIMIT_FREEZES.of::<32>(guard.limit_freezes);
        Self {
            limits_freeze: Parameter::of(&freezes.bits(0)),
            limit_freezes_out_of_range: ParameterRefusal::of(&freezes.is_outside(0, 1)),
            ..Self::default()
        }
    }
}

compiled_once::logic!(Stops<N = 7>);

impl<const N: usize> compiled_once::Kernel for Stops<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, called, freeze, slow, still, settled, wiping);
        dff_setup!(self, clock, first, axes, found, kind, found_freezing, ran);

        // Collects the causes that the time slots find.
        self.finds_now.next =
            self.time_slot_ends.val() & (self.too_fast.val() | self.limit.val() | self.dry.val());
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
        if self.time_slot_ends.val()
            & (self.too_fast.val() | (self.limit.val() & self.limits_freeze.val().any()))
        {
            self.found_freezing.d.next = true;
        }
        if self.time_slot_ends.val() & self.runs.val() {
            self.ran.d.next = true;
        }

        // Latches the first cause. Of several causes in one clock, the one assigned last below has
        // priority.
        self.urgent.next =
            self.late.val().any() | (self.strobe.val() & self.pressed.val()) | self.breaks.val();
        self.ripe.next = self.strobe.val() & self.found.q.val();
        self.by_host.next = (self.strobe.val() & (self.missed.val() | self.interlock.val()))
            | self.asked.val()
            | self.ending.val();
        self.calls.next = self.urgent.val() | self.ripe.val() | self.by_host.val();
        if !self.called.q.val() {
            if self.urgent.val() | (self.by_host.val() & !self.ripe.val()) {
                self.axes.d.next = self.late.val();
            } else if !self.found.q.val() {
                // Whether this slot finds a cause is known too late to decide here: the axis of the
                // slot that does so is the last one that is latched.
                self.axes.d.next = self.axis_one_hot.val();
            }
        }
        if self.calls.val() & !self.called.q.val() {
            self.first.d.next = self.host.val();
            if self.strobe.val() & self.interlock.val() {
                self.first.d.next = self.opened.val();
            }
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

        // The progress of the stop.
        if self.calls.val() {
            self.called.d.next = true;
        }
        if self.urgent.val() | (self.strobe.val() & self.found_freezing.q.val()) | self.ending.val()
        {
            self.freeze.d.next = true;
        }
        if self.strobe.val() {
            self.found.d.next = false;
            self.found_freezing.d.next = false;
            self.ran.d.next = false;
            self.slow.d.next = self.called.q.val() | self.found.q.val();
            self.still.d.next = self.freeze.q.val()
                | self.found_freezing.q.val()
                | (self.slow.q.val() & !self.ran.q.val());
            self.settled.d.next = self.still.q.val();
            self.wiping.d.next = self.clear.val()
                & self.settled.q.val()
                & !self.wiping.q.val()
                & !self.pins_busy.val()
                & !self.pressed.val()
                & !self.interlock.val()
                & !self.ending.val();
            if self.wiping.q.val() | self.completes.val() {
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
        self.settles.next = self.settled.q.val() & !self.wiping.q.val();
        self.clearing.next = self.wiping.q.val() | self.stage_2.val();
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

//! Finds the phase of a step within its tick by bisection, and requests the step from the shaper.
//!
//! A tick that steps carries somewhere between P and P + V. The module finds the position of the
//! carry in Q-ths of the tick with additions only. It adds half of V, then a quarter, then an
//! eighth and so on. A part that does not carry yet is kept, and its bit of the phase is set.
//!
//! ```text
//! strobe        /^\______________________ ... /^\________________________ ... /^\___
//! tick n        accumulate | bisect | wait      | emitted at its phase q        |
//!                           k=1 2 3 4            0    1    2  q    ...  Q-1
//! request       ___________________________..._____________/^\________________...
//! ```
//!
//! A tick is accumulated at one strobe, bisected during the next tick and emitted during the tick
//! after that.
//!
//! Interface: the axis provides P and V of each tick at its strobe; the shaper receives `request`
//! for one clock at the phase of the step.
//!
//! Cost: one adder of 32 bits, two registers of 32 bits, and the emission registers. Only the upper
//! 32 bits of P and V take part; the phase is that of these truncated values.

use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use rust_hdl_core::prelude::*;

/// The bisection and the emission of one axis.
#[derive(LogicBlock, Default)]
pub struct StepEdge {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick, even while the core is frozen.
    pub strobe: Input<Bit>,
    /// Asserted in the first clock of a phase.
    pub phase_start: Input<Bit>,
    /// The number of the present phase, 0 to Q - 1.
    pub phase: Input<Word<4>>,
    /// Asserted while a fault is latched. No new tick enters; steps that have already been found
    /// continue.
    pub frozen: Input<Bit>,
    /// Clears the stored signs of V.
    pub clear: Input<Bit>,
    /// The tick that ends at this strobe contains a step.
    pub crosses: Input<Bit>,
    /// V > 0 in the tick that ends at this strobe.
    pub forward: Input<Bit>,
    /// V < 0 in the tick that ends at this strobe.
    pub backward: Input<Bit>,
    /// The upper 32 bits of P before the addition.
    pub p: Input<Word<32>>,
    /// The upper 32 bits of V before the addition.
    pub v: Input<Word<32>>,
    /// Asserted for one clock when a step is due.
    pub request: Signal<Out, Bit>,
    /// The requested step is backward.
    pub request_back: Signal<Out, Bit>,
    /// V > 0 in the tick that is being emitted.
    pub want_fwd: Signal<Out, Bit>,
    /// V < 0 in the tick that is being emitted.
    pub want_back: Signal<Out, Bit>,
    /// A step has been found and may not have been requested yet.
    pub in_flight: Signal<Out, Bit>,
    /// The tick accumulated last contained a step.
    pub crossed: Signal<Out, Bit>,
    /// V < 0 in the tick accumulated last.
    pub back: Signal<Out, Bit>,
    /// The phase of that step, valid when the bisection has finished.
    pub q: Signal<Out, Word<4>>,
    tick_crossed: Register<Bit>, // `crossed` of docs/clock-by-clock.md
    tick_back: Register<Bit>,    // `back`
    sign_fwd: Register<Bit>,
    sign_back: Register<Bit>,
    bisect_p: Register<Word<32>>, // `bp`
    // `bv`, shifted right by one bit per clock, so that no barrel shifter is needed.
    bisect_v: Register<Word<32>>,
    bisect_q: Register<Word<4>>, // `bq`
    // The weight of the phase bit to decide next; 0 when the bisection has finished.
    weight: Register<Word<4>>,
    emit: Register<Bit>,
    emit_back: Register<Bit>,
    emit_q: Register<Word<4>>,
    dir_fwd: Register<Bit>,  // `want_fwd`
    dir_back: Register<Bit>, // `want_back`
    half: Signal<Local, Word<32>>,
    trial: Signal<Local, Word<33>>,
    trial_crosses: Signal<Local, Bit>,
    sign: Literal<32, 0x8000_0000>,
    by_one: Literal<32, 1>,
    weight_by_one: Literal<4, 1>,
    first_weight: Parameter<4>,
    phase_zero: Literal<4, 0>,
}

impl StepEdge {
    /// Makes the module for ticks of Q phases. Q is 1, 4 or 16.
    pub(crate) fn new(phases: u32) -> Self {
        Self { first_weight: Parameter::new(u64::from(phases / 2)), ..Self::default() }
    }
}

impl Logic for StepEdge {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self,
            clock,
            tick_crossed,
            tick_back,
            sign_fwd,
            sign_back,
            bisect_p,
            bisect_v,
            bisect_q,
            weight
        );
        dff_setup!(self, clock, emit, emit_back, emit_q, dir_fwd, dir_back);

        // The bisection decides one bit of the phase per clock, the highest bit first.
        self.half.next = (self.bisect_v.q.val() >> self.by_one.val())
            | (self.bisect_v.q.val() & self.sign.val());
        self.trial.next =
            bit_cast::<33, 32>(self.bisect_p.q.val()) + bit_cast::<33, 32>(self.half.val());
        self.trial_crosses.next = self.trial.val().get_bit(32) ^ self.bisect_v.q.val().get_bit(31);
        if self.weight.q.val().any() {
            self.weight.d.next = self.weight.q.val() >> self.weight_by_one.val();
            self.bisect_v.d.next = self.half.val();
            if !self.trial_crosses.val() {
                self.bisect_p.d.next = self.trial.val().get_bits::<32>(0);
                self.bisect_q.d.next = self.bisect_q.q.val() | self.weight.q.val();
            }
        }

        // At the strobe, each tick moves to its next stage.
        if self.strobe.val() {
            self.emit.d.next = self.tick_crossed.q.val();
            self.emit_back.d.next = self.tick_back.q.val();
            self.emit_q.d.next = self.bisect_q.q.val();
            self.dir_fwd.d.next = self.sign_fwd.q.val();
            self.dir_back.d.next = self.sign_back.q.val();
            self.tick_crossed.d.next = self.crosses.val() & !self.frozen.val();
            self.sign_fwd.d.next = self.forward.val() & !self.frozen.val();
            self.sign_back.d.next = self.backward.val() & !self.frozen.val();
            if !self.frozen.val() {
                self.tick_back.d.next = self.backward.val();
                self.bisect_p.d.next = self.p.val();
                self.bisect_v.d.next = self.v.val();
                self.bisect_q.d.next = self.phase_zero.val();
                self.weight.d.next = self.first_weight.val();
            }
        }
        if self.clear.val() {
            self.sign_fwd.d.next = false;
            self.sign_back.d.next = false;
            self.dir_fwd.d.next = false;
            self.dir_back.d.next = false;
        }

        self.request.next =
            self.emit.q.val() & self.phase_start.val() & (self.phase.val() == self.emit_q.q.val());
        self.request_back.next = self.emit_back.q.val();
        self.want_fwd.next = self.dir_fwd.q.val();
        self.want_back.next = self.dir_back.q.val();
        self.in_flight.next = self.tick_crossed.q.val() | self.emit.q.val();
        self.crossed.next = self.tick_crossed.q.val();
        self.back.next = self.tick_back.q.val();
        self.q.next = self.bisect_q.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{assert_synthesizes, rising_edge, settle};

    fn clock(edge: &mut StepEdge) {
        edge.clock.next = false.into();
        settle(edge);
        edge.clock.next = true.into();
        rising_edge(edge);
        settle(edge);
    }

    /// Makes an edge of Q phases, accumulates one tick that contains a step, and finishes its
    /// bisection.
    fn bisected(phases: u32, p: u64, v: u64) -> StepEdge {
        let mut edge = StepEdge::new(phases);
        edge.connect_all();
        edge.strobe.next = true;
        edge.crosses.next = true;
        edge.backward.next = v >> 31 == 1;
        edge.p.next = Word::from(p);
        edge.v.next = Word::from(v);
        clock(&mut edge);
        edge.strobe.next = false;
        edge.crosses.next = false;
        for _ in 0..phases.ilog2() {
            clock(&mut edge);
        }
        edge
    }

    #[test]
    fn bisection_finds_the_phase_of_a_forward_carry() {
        // From 3/4 step at half a step per tick, the carry comes after half a tick. The next two
        // cases carry late and early in the tick.
        assert_eq!(bisected(16, 0xc000_0000, 0x7fff_ffff).q.val().value(), 8);
        assert_eq!(bisected(16, 0x8000_0001, 0x7fff_ffff).q.val().value(), 15);
        assert_eq!(bisected(16, 0xffff_ffff, 0x7fff_ffff).q.val().value(), 0);
        assert_eq!(bisected(4, 0xc000_0000, 0x7fff_ffff).q.val().value(), 2);
        assert_eq!(bisected(1, 0xc000_0000, 0x7fff_ffff).q.val().value(), 0);
    }

    #[test]
    fn bisection_finds_the_phase_of_a_missing_carry_when_backward() {
        let edge = bisected(16, 0x4000_0000, 0x8000_0000);
        assert_eq!(edge.q.val().value(), 8);
        assert!(edge.back.val());
    }

    #[test]
    fn edge_requests_a_step_once_at_its_phase_in_the_next_tick() {
        let mut edge = bisected(16, 0xc000_0000, 0x7fff_ffff);
        edge.strobe.next = true;
        clock(&mut edge);
        edge.strobe.next = false;
        let mut requests = Vec::new();
        for cycle in 0..32_u64 {
            edge.phase.next = Word::from(cycle / 2);
            edge.phase_start.next = cycle % 2 == 0;
            edge.clock.next = false.into();
            settle(&mut edge);
            if edge.request.val() {
                requests.push(cycle);
            }
            clock(&mut edge);
        }
        assert_eq!(requests, [16]);
    }

    #[test]
    fn edge_synthesizes() {
        assert_synthesizes(StepEdge::new(16), "carrystep_step_edge");
    }
}

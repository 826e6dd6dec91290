//! When inside its tick a step is due: the phase by bisection, and the request to the shaper.
//!
//! A tick that steps carries somewhere between P and P + V. Where, in Q-ths of a tick, is found by adding
//! only: half of V, a quarter, an eighth ...; each part that does not yet carry is kept and sets its bit.
//!
//! ```text
//! strobe        /^\______________________ ... /^\________________________ ... /^\___
//! tick n        accumulate | bisect | wait      | emitted at its phase q        |
//!                           k=1 2 3 4            0    1    2  q    ...  Q-1
//! request       ___________________________..._____________/^\________________...
//! ```
//!
//! So tick n is added at one strobe, bisected during the next tick and emitted during the one after.

use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use rust_hdl::prelude::*;

/// Bisection and emission of one axis.
#[derive(LogicBlock, Default)]
pub struct Edge {
    /// The clock.
    pub clock: Input<Clock>,
    /// Last cycle of a tick, frozen or not.
    pub strobe: Input<Bit>,
    /// First cycle of a phase.
    pub phase_start: Input<Bit>,
    /// The phase.
    pub phase: Input<Word<4>>,
    /// A fault is latched: no tick is added, what is on its way goes on.
    pub frozen: Input<Bit>,
    /// Forget the sign of V.
    pub clear: Input<Bit>,
    /// This tick steps.
    pub crosses: Input<Bit>,
    /// V > 0 in this tick.
    pub forward: Input<Bit>,
    /// V < 0 in this tick.
    pub backward: Input<Bit>,
    /// Top of the old P.
    pub p: Input<Word<32>>,
    /// Top of the old V.
    pub v: Input<Word<32>>,
    /// A step is due, one cycle.
    pub request: Signal<Out, Bit>,
    /// It goes backward.
    pub request_back: Signal<Out, Bit>,
    /// The emitted tick's V > 0.
    pub want_fwd: Signal<Out, Bit>,
    /// The emitted tick's V < 0.
    pub want_back: Signal<Out, Bit>,
    /// A step is on its way.
    pub in_flight: Signal<Out, Bit>,
    /// The last tick stepped.
    pub crossed: Signal<Out, Bit>,
    /// It had V < 0.
    pub back: Signal<Out, Bit>,
    /// Its phase, when the bisection is over.
    pub q: Signal<Out, Word<4>>,
    tick_crossed: Register<Bit>, // `crossed` of docs/clock-by-clock.md
    tick_back: Register<Bit>,    // `back`
    sign_fwd: Register<Bit>,
    sign_back: Register<Bit>,
    bisect_p: Register<Word<32>>, // `bp`
    bisect_v: Register<Word<32>>, // `bv`, halved from step to step: one shift instead of a shifter
    bisect_q: Register<Word<4>>,  // `bq`
    weight: Register<Word<4>>,    // of the phase bit in question; 0: nothing to do
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

impl Edge {
    /// For ticks of Q phases: 1, 4 or 16.
    pub(crate) fn new(phases: u32) -> Self {
        Self { first_weight: Parameter::new(u64::from(phases / 2)), ..Self::default() }
    }
}

impl Logic for Edge {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, tick_crossed, tick_back, sign_fwd, sign_back, bisect_p, bisect_v, bisect_q, weight);
        dff_setup!(self, clock, emit, emit_back, emit_q, dir_fwd, dir_back);

        // Bisection: one phase bit a cycle, the highest first.
        self.half.next = (self.bisect_v.q.val() >> self.by_one.val()) | (self.bisect_v.q.val() & self.sign.val());
        self.trial.next = bit_cast::<33, 32>(self.bisect_p.q.val()) + bit_cast::<33, 32>(self.half.val());
        self.trial_crosses.next = self.trial.val().get_bit(32) ^ self.bisect_v.q.val().get_bit(31);
        if self.weight.q.val().any() {
            self.weight.d.next = self.weight.q.val() >> self.weight_by_one.val();
            self.bisect_v.d.next = self.half.val();
            if !self.trial_crosses.val() {
                self.bisect_p.d.next = self.trial.val().get_bits::<32>(0);
                self.bisect_q.d.next = self.bisect_q.q.val() | self.weight.q.val();
            }
        }

        // At a strobe all moves one place on.
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

        self.request.next = self.emit.q.val() & self.phase_start.val() & (self.phase.val() == self.emit_q.q.val());
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

    fn clock(edge: &mut Edge) {
        edge.clock.next = false.into();
        settle(edge);
        edge.clock.next = true.into();
        rising_edge(edge);
        settle(edge);
    }

    /// An edge of Q phases after the strobe of a tick that crosses, and its bisection.
    fn bisected(phases: u32, p: u64, v: u64) -> Edge {
        let mut edge = Edge::new(phases);
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
    fn the_phase_is_where_the_carry_falls() {
        // From 3/4 of a step at half a step per tick: half a tick. Then a late and an early carry.
        assert_eq!(bisected(16, 0xc000_0000, 0x7fff_ffff).q.val().value(), 8);
        assert_eq!(bisected(16, 0x8000_0001, 0x7fff_ffff).q.val().value(), 15);
        assert_eq!(bisected(16, 0xffff_ffff, 0x7fff_ffff).q.val().value(), 0);
        assert_eq!(bisected(4, 0xc000_0000, 0x7fff_ffff).q.val().value(), 2);
        assert_eq!(bisected(1, 0xc000_0000, 0x7fff_ffff).q.val().value(), 0);
    }

    #[test]
    fn backward_it_is_where_the_carry_is_missing() {
        let edge = bisected(16, 0x4000_0000, 0x8000_0000);
        assert_eq!(edge.q.val().value(), 8);
        assert!(edge.back.val());
    }

    #[test]
    fn the_request_comes_once_at_its_phase_in_the_next_tick() {
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
        assert_synthesizes(Edge::new(16), "carrystep_step_edge");
    }
}

//! The accumulator of one axis of the parallel core. Every carry out of P is a step.
//!
//! ```text
//!      J ----> + ----> A ----> + ----> V ----> + ----> P    each tick, from the old values
//!              ^-------'       ^-------'       ^-------'
//!                                              `-- carry out: a step
//! ```
//!
//! P is the position within a step, V the speed per tick, A the acceleration and J the jerk, all in
//! units of 2^-64 step. Each tick adds J to A, A to V and V to P, always with the values from
//! before the tick. When P passes a whole step, the 64-bit addition carries. Forward, the carry is
//! the step. Backward, V is a negative number in two's complement, so that every addition carries
//! except the one that passes a whole step; there the missing carry is the step.
//!
//! Interface: the axis accepts one segment while another runs, and requests steps from the shaper.
//! The [`Sequencer`] decides when a segment is loaded; [`StepEdge`] finds the phase of a step
//! within its tick.
//!
//! Cost: three adders of 64 bits, registers for P, V, A and J, and the waiting segment of the
//! sequencer. The engine ([`mod@crate::engine`]) performs the same additions on one adder of 32
//! bits.

use crate::parallel::sequencer::Sequencer;
use crate::parameters::START_HALF;
use crate::parts::edge::StepEdge;
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::StartPhase;
use rust_hdl_core::prelude::*;

/// One axis of the parallel core, from the offered segment to the requested step.
#[derive(LogicBlock, Default)]
pub struct ParallelAxis {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick.
    pub strobe: Input<Bit>,
    /// Asserted in the first clock of a phase.
    pub phase_start: Input<Bit>,
    /// The number of the present phase, 0 to Q - 1.
    pub phase: Input<Word<4>>,
    /// Asserted while a fault of any axis is latched. The axis does not move.
    pub frozen: Input<Bit>,
    /// Sets P to its start value and clears the segments and the faults.
    pub clear: Input<Bit>,
    /// The waiting segment may start this axis at the strobe in this clock.
    pub go: Input<Bit>,
    /// The axis stores the offered segment in this clock.
    pub push: Input<Bit>,
    /// Offered segment: its duration in ticks.
    pub seg_ticks: Input<Word<32>>,
    /// Offered segment: the initial speed V, in 2^-64 step per tick, two's complement.
    pub seg_v: Input<Word<64>>,
    /// Offered segment: the initial acceleration A, in 2^-64 step per tick^2, two's complement.
    pub seg_a: Input<Word<64>>,
    /// Offered segment: the jerk J, in 2^-64 step per tick^3, two's complement.
    pub seg_j: Input<Word<64>>,
    /// Offered segment: it is the last of its move, and the axis rests after it.
    pub seg_last: Input<Bit>,
    /// A segment is stored and not yet loaded.
    pub waiting: Signal<Out, Bit>,
    /// The waiting segment could start at a strobe in this clock.
    pub startable: Signal<Out, Bit>,
    /// Asserted for one clock when a step is due.
    pub request: Signal<Out, Bit>,
    /// The requested step is backward.
    pub request_back: Signal<Out, Bit>,
    /// V > 0 in the tick that is being emitted.
    pub want_fwd: Signal<Out, Bit>,
    /// V < 0 in the tick that is being emitted.
    pub want_back: Signal<Out, Bit>,
    /// A step has been found and may not have reached the shaper.
    pub in_flight: Signal<Out, Bit>,
    /// The axis is at rest, no segment waits, and every step has reached the shaper.
    pub drained: Signal<Out, Bit>,
    /// Latched fault: the next V would have been outside -2^63 < V < 2^63.
    pub overspeed: Signal<Out, Bit>,
    /// Latched fault: a segment that was not the last of its move ended, and no segment was
    /// waiting.
    pub underrun: Signal<Out, Bit>,
    /// For observation: the last tick contained a step.
    pub crossed: Signal<Out, Bit>,
    /// For observation: V < 0 in the last tick.
    pub back: Signal<Out, Bit>,
    /// For observation: the phase of that step, valid when the bisection has finished.
    pub q: Signal<Out, Word<4>>,
    /// For observation: P.
    pub p: Signal<Out, Word<64>>,
    /// For observation: V.
    pub v: Signal<Out, Word<64>>,
    position: Register<Word<64>>, // P
    speed: Register<Word<64>>,    // V
    accel: Register<Word<64>>,    // A
    jerk: Register<Word<64>>,     // J
    too_fast: Register<Bit>,      // `overspeed` of docs/clock-by-clock.md
    sequencer: Sequencer,
    step_edge: StepEdge,
    tick: Signal<Local, Bit>,
    sum: Signal<Local, Word<65>>,
    backward: Signal<Local, Bit>,
    faster: Signal<Local, Word<64>>,
    overflow: Signal<Local, Bit>,
    next_speed: Signal<Local, Word<64>>,
    off_limits: Signal<Local, Bit>,
    start_value: Parameter<64>,
    zero: Literal<64, 0>,
    least: Literal<64, 0x8000_0000_0000_0000>,
    start_half_out_of_range: ParameterRefusal,
}

impl ParallelAxis {
    /// Makes an axis for ticks of Q phases. [`carrystep_core::Timebase`] has checked that Q is 1, 4
    /// or 16.
    pub(crate) fn new(phases: u32, start: StartPhase) -> Self {
        let half = START_HALF.of::<32>(start == StartPhase::Half);
        let value = |start: StartPhase| Formula::number(start.start_value());
        let start = value(StartPhase::Half).where_or(&half.bits(0), value(StartPhase::Zero));
        Self {
            position: Register::of(&start),
            start_value: Parameter::of(&start),
            start_half_out_of_range: ParameterRefusal::of(&half.is_outside(0, 1)),
            step_edge: StepEdge::new(phases),
            ..Self::default()
        }
    }
}

impl Logic for ParallelAxis {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, position, speed, accel, jerk, too_fast);
        clock!(self, clock, sequencer, step_edge);

        // The addition P + V. Its carry, compared with the sign of V, tells whether the tick steps.
        self.tick.next = self.strobe.val() & !self.frozen.val();
        self.sum.next =
            bit_cast::<65, 64>(self.position.q.val()) + bit_cast::<65, 64>(self.speed.q.val());
        self.backward.next = self.speed.q.val().get_bit(63);
        self.step_edge.crosses.next = self.sum.val().get_bit(64) ^ self.backward.val();
        if self.tick.val() {
            self.position.d.next = self.sum.val().get_bits::<64>(0);
        }

        // The next V, and whether it is in range.
        self.faster.next = self.speed.q.val() + self.accel.q.val();
        self.overflow.next = (self.backward.val() == self.accel.q.val().get_bit(63))
            & (self.backward.val() != self.faster.val().get_bit(63));
        self.next_speed.next = self.zero.val();
        if self.sequencer.load.val() {
            self.next_speed.next = self.sequencer.v.val();
        } else if self.sequencer.advance.val() {
            self.next_speed.next = self.faster.val();
        }
        self.off_limits.next = self.tick.val()
            & ((self.next_speed.val() == self.least.val())
                | (self.sequencer.advance.val() & self.overflow.val()));

        // At a tick, V and A advance, or a segment is loaded, or the axis comes to rest.
        if self.tick.val() {
            self.speed.d.next = self.next_speed.val();
        }
        if self.sequencer.load.val() {
            self.accel.d.next = self.sequencer.a.val();
            self.jerk.d.next = self.sequencer.j.val();
        } else if self.sequencer.advance.val() {
            self.accel.d.next = self.accel.q.val() + self.jerk.q.val();
        } else if self.tick.val() {
            self.accel.d.next = self.zero.val();
            self.jerk.d.next = self.zero.val();
        }
        if self.off_limits.val() | self.frozen.val() {
            self.speed.d.next = self.zero.val();
            self.accel.d.next = self.zero.val();
            self.jerk.d.next = self.zero.val();
        }
        self.too_fast.d.next = self.too_fast.q.val() | self.off_limits.val();
        if self.clear.val() {
            self.position.d.next = self.start_value.val();
            self.too_fast.d.next = false;
        }

        // The inputs of the sequencer.
        self.sequencer.strobe.next = self.tick.val();
        self.sequencer.frozen.next = self.frozen.val();
        self.sequencer.stop.next = self.off_limits.val();
        self.sequencer.clear.next = self.clear.val();
        self.sequencer.go.next = self.go.val();
        self.sequencer.push.next = self.push.val();
        self.sequencer.seg_ticks.next = self.seg_ticks.val();
        self.sequencer.seg_v.next = self.seg_v.val();
        self.sequencer.seg_a.next = self.seg_a.val();
        self.sequencer.seg_j.next = self.seg_j.val();
        self.sequencer.seg_last.next = self.seg_last.val();

        // The inputs of the edge.
        self.step_edge.strobe.next = self.strobe.val();
        self.step_edge.phase_start.next = self.phase_start.val();
        self.step_edge.phase.next = self.phase.val();
        self.step_edge.frozen.next = self.frozen.val();
        self.step_edge.clear.next = self.clear.val();
        self.step_edge.forward.next = self.speed.q.val().any() & !self.backward.val();
        self.step_edge.backward.next = self.backward.val();
        self.step_edge.p.next = self.position.q.val().get_bits::<32>(32);
        self.step_edge.v.next = self.speed.q.val().get_bits::<32>(32);

        self.waiting.next = self.sequencer.waiting.val();
        self.startable.next = self.sequencer.startable.val();
        self.request.next = self.step_edge.request.val();
        self.request_back.next = self.step_edge.request_back.val();
        self.want_fwd.next = self.step_edge.want_fwd.val();
        self.want_back.next = self.step_edge.want_back.val();
        self.in_flight.next = self.step_edge.in_flight.val();
        self.drained.next = !(self.sequencer.running.val()
            | self.sequencer.waiting.val()
            | self.step_edge.in_flight.val());
        self.overspeed.next = self.too_fast.q.val();
        self.underrun.next = self.sequencer.underrun.val();
        self.crossed.next = self.step_edge.crossed.val();
        self.back.next = self.step_edge.back.val();
        self.q.next = self.step_edge.q.val();
        self.p.next = self.position.q.val();
        self.v.next = self.speed.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::AxisSim;
    use crate::sim::assert_synthesizes;
    use carrystep_core::Segment;

    fn started(start: StartPhase, segment: Segment) -> AxisSim {
        let mut axis = AxisSim::new(16, start).unwrap();
        assert!(axis.offer(&segment));
        assert!(!axis.tick(true).crossed);
        axis
    }

    const QUARTER: i64 = 1 << 62;

    #[test]
    fn axis_steps_at_every_carry() {
        let segment = Segment { ticks: 9, v: QUARTER, a: 0, j: 0, last: true };
        let mut axis = started(StartPhase::Zero, segment);
        let steps: Vec<bool> = (0..12).map(|_| axis.tick(false).crossed).collect();
        let [o, x] = [false, true];
        assert_eq!(steps, [o, o, o, x, o, o, o, x, o, o, o, o]);
    }

    #[test]
    fn axis_steps_backward_at_every_missing_carry() {
        let segment = Segment { ticks: 5, v: -QUARTER, a: 0, j: 0, last: true };
        let mut axis = started(StartPhase::Zero, segment);
        let steps: Vec<bool> = (0..6).map(|_| axis.tick(false).crossed).collect();
        assert_eq!(steps, [true, false, false, false, true, false]);
    }

    #[test]
    fn axis_adds_the_values_from_before_the_tick() {
        let segment = Segment { ticks: 4, v: 100, a: 10, j: 1, last: false };
        let mut axis = started(StartPhase::Zero, segment);
        let ticks: Vec<(u64, i64)> =
            (0..3).map(|_| axis.tick(false)).map(|tick| (tick.p, tick.v)).collect();
        assert_eq!(ticks, [(100, 110), (210, 121), (331, 133)]);
    }

    #[test]
    fn speed_out_of_range_stops_the_axis_with_overspeed() {
        let segment = Segment { ticks: 9, v: QUARTER, a: QUARTER, j: 0, last: true };
        let mut axis = started(StartPhase::Half, segment);
        assert_eq!(axis.tick(false).v, 0);
        assert_eq!(axis.faults(), (true, false));
        let least = started(StartPhase::Half, Segment { v: i64::MIN, a: 0, ..segment });
        assert_eq!(least.faults(), (true, false));
    }

    #[test]
    fn axis_rejects_an_invalid_number_of_phases() {
        assert!(AxisSim::new(8, StartPhase::Half).is_err());
    }

    #[test]
    fn axis_synthesizes() {
        assert_synthesizes(ParallelAxis::new(16, StartPhase::Half), "carrystep_axis");
    }
}

//! The core of N parallel axes: it accepts segments and starts, and freezes all axes at a fault.
//!
//! ```text
//!                 .------.  strobe, phase
//!                 | tick |----+---------------+----- ... to all axes
//!                 '------'    v               v
//!  seg_*   ---->  push ->  .------. request .--------.  ---> step, dir
//!  start_* ---->  go   ->  | axis |-------->| shaper |  ---> position
//!                          '------'         '--------'
//!  clear   ---->  frozen <-- overspeed, underrun, overrun, protocol
//! ```
//!
//! A start names axes by a mask. All of them start at the same strobe, which is the first at which
//! each of them can start. Any latched fault freezes every axis from the next clock on, until
//! `clear`.
//!
//! Interface: segments and starts are accepted where valid and ready are both 1. The outputs are
//! the pins and the state of each axis.
//!
//! Cost: N axes and N shapers, which share one tick counter.

use crate::HdlError;
use crate::parallel::axis::ParallelAxis;
use crate::parts::shaper::Shaper;
use crate::parts::tick::Tick;
use crate::primitives::compiled_once;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::per_axis::PerAxis;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::Build;
use rust_hdl_core::prelude::*;

/// The core of N axes. Its ports are listed in [`carrystep_core::ports::PARALLEL_PORTS`].
#[derive(LogicBlock, Default)]
pub struct ParallelCore<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// The host offers a segment and holds it until the core accepts it.
    pub seg_valid: Input<Bit>,
    /// The number of the axis that the segment is for. A segment for an axis that the core does not
    /// have is a breach of the segment protocol.
    pub seg_axis: Input<Word<3>>,
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
    /// The core accepts an offered segment in this clock.
    pub seg_ready: Signal<Out, Bit>,
    /// The host offers a start and holds it until the core accepts it.
    pub start_valid: Input<Bit>,
    /// The axes to start; bit i is axis i.
    pub start_mask: Input<Word<N>>,
    /// The core accepts an offered start in this clock.
    pub start_ready: Signal<Out, Bit>,
    /// Clears a fault. The host holds it until `fault` falls.
    pub clear: Input<Bit>,
    /// The STEP pins; bit i is axis i. A rising edge is a step.
    pub step: PerAxis<Signal<Out, Bit>, N>,
    /// The DIR pins; bit i is axis i; 1 is backward.
    pub dir: PerAxis<Signal<Out, Bit>, N>,
    /// The steps forward less the steps backward of each axis, 32 bits two's complement; axis 0 is
    /// in the lowest bits.
    pub position: PerAxis<Signal<Out, Word<32>>, N>,
    /// The number of steps of each axis that were requested but not made, modulo 2^32; axis 0 is in
    /// the lowest bits.
    pub discarded: PerAxis<Signal<Out, Word<32>>, N>,
    /// All axes are at rest, no segment waits and no start is armed.
    pub idle: Signal<Out, Bit>,
    /// A fault is latched, and all axes are frozen.
    pub fault: Signal<Out, Bit>,
    /// Latched fault of an axis: a second step arrived while one was held back.
    pub overrun: PerAxis<Signal<Out, Bit>, N>,
    /// Latched fault of an axis: the next V would have been outside -2^63 < V < 2^63.
    pub overspeed: PerAxis<Signal<Out, Bit>, N>,
    /// Latched fault of an axis: a segment that was not the last of its move ended, and no segment
    /// was waiting.
    pub underrun: PerAxis<Signal<Out, Bit>, N>,
    /// Latched fault: the host broke the segment protocol.
    pub protocol: Signal<Out, Bit>,
    /// Axes start at the end of this clock; asserted for one clock per start.
    pub started: Signal<Out, Bit>,
    tick: Tick,
    pub(crate) axis: PerAxis<ParallelAxis, N>,
    shaper: PerAxis<Shaper, N>,
    armed: Register<Bit>,
    mask: Register<Word<N>>,
    broken: Register<Bit>,
    frozen: Signal<Local, Bit>,
    selected: Signal<Local, Word<N>>,
    waiting: Signal<Local, Bit>,
    nobody: Signal<Local, Bit>,
    taken: Signal<Local, Bit>,
    push: Signal<Local, Bit>,
    start: Signal<Local, Bit>,
    unfed: Signal<Local, Bit>,
    all_startable: Signal<Local, Bit>,
    go: Signal<Local, Bit>,
    at_rest: Signal<Local, Bit>,
    in_flight: Signal<Local, Bit>,
    clear_now: Signal<Local, Bit>,
    first: Literal<N, 1>,
    axes: Parameter<3>,
    no_ticks: Literal<32, 0>,
}

impl<const N: usize> ParallelCore<N> {
    /// Makes the core of a build, with the first N of its pin timings. The caller ensures that N is
    /// 1 to 6.
    ///
    /// # Errors
    /// Returns [`HdlError::PinTiming`] if the pin timing of one of these axes is out of range.
    pub(super) fn new(build: &Build) -> Result<Self, HdlError> {
        let mut shaper = PerAxis::<Shaper, N>::default();
        for (shaper, pins) in shaper.iter_mut().zip(&build.pins) {
            *shaper = Shaper::new(pins)?;
        }
        let phases = build.timebase.phases();
        Ok(Self {
            tick: Tick::new(&build.timebase),
            axis: PerAxis::from_fn(|_| ParallelAxis::new(phases, build.phase)),
            shaper,
            axes: Parameter::new(N as u64),
            ..Self::default()
        })
    }
}

compiled_once::logic!(ParallelCore<N = 6>);

impl<const N: usize> compiled_once::Kernel for ParallelCore<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, armed, mask, broken);
        clock!(self, clock, tick);

        // Any latched fault freezes all axes.
        self.frozen.next = self.broken.q.val();
        self.in_flight.next = false;
        self.at_rest.next = !self.armed.q.val();
        for i in 0..N {
            self.frozen.next = self.frozen.val()
                | self.shaper[i].overrun.val()
                | self.axis[i].overspeed.val()
                | self.axis[i].underrun.val();
            self.in_flight.next =
                self.in_flight.val() | self.axis[i].in_flight.val() | self.shaper[i].step.val();
            self.at_rest.next = self.at_rest.val()
                & self.axis[i].drained.val()
                & !(self.shaper[i].held_back.val() | self.shaper[i].step.val());
        }
        self.clear_now.next = self.clear.val() & self.frozen.val() & !self.in_flight.val();

        // The port for segments.
        self.selected.next = self.first.val() << self.seg_axis.val();
        self.nobody.next = self.seg_axis.val() >= self.axes.val();
        self.waiting.next = false;
        for i in 0..N {
            self.waiting.next =
                self.waiting.val() | (self.selected.val().get_bit(i) & self.axis[i].waiting.val());
        }
        self.seg_ready.next = !(self.frozen.val() | self.waiting.val());
        self.taken.next = self.seg_valid.val() & self.seg_ready.val();
        self.push.next =
            self.taken.val() & !self.nobody.val() & (self.seg_ticks.val() != self.no_ticks.val());

        // The port for starts. A start stays armed until every axis of its mask can start; then all
        // start at one strobe.
        self.start_ready.next = !(self.frozen.val() | self.armed.q.val());
        self.start.next = self.start_valid.val() & self.start_ready.val();
        self.unfed.next = false;
        self.all_startable.next = true;
        for i in 0..N {
            self.unfed.next =
                self.unfed.val() | (self.start_mask.val().get_bit(i) & !self.axis[i].waiting.val());
            self.all_startable.next = self.all_startable.val()
                & (!self.mask.q.val().get_bit(i) | self.axis[i].startable.val());
        }
        self.go.next = self.armed.q.val()
            & self.tick.strobe.val()
            & self.all_startable.val()
            & !self.frozen.val();
        if self.go.val() | self.frozen.val() {
            self.armed.d.next = false;
        }
        if self.start.val() & !self.unfed.val() {
            self.armed.d.next = true;
            self.mask.d.next = self.start_mask.val();
        }

        // A breach of the segment protocol latches the fault `protocol`.
        if (self.taken.val() & !self.push.val()) | (self.start.val() & self.unfed.val()) {
            self.broken.d.next = true;
        }
        if self.clear_now.val() {
            self.broken.d.next = false;
        }

        for i in 0..N {
            self.axis[i].clock.next = self.clock.val();
            self.axis[i].strobe.next = self.tick.strobe.val();
            self.axis[i].phase_start.next = self.tick.phase_start.val();
            self.axis[i].phase.next = self.tick.phase.val();
            self.axis[i].frozen.next = self.frozen.val();
            self.axis[i].clear.next = self.clear_now.val();
            self.axis[i].go.next = self.go.val() & self.mask.q.val().get_bit(i);
            self.axis[i].push.next = self.push.val() & self.selected.val().get_bit(i);
            self.axis[i].seg_ticks.next = self.seg_ticks.val();
            self.axis[i].seg_v.next = self.seg_v.val();
            self.axis[i].seg_a.next = self.seg_a.val();
            self.axis[i].seg_j.next = self.seg_j.val();
            self.axis[i].seg_last.next = self.seg_last.val();

            self.shaper[i].clock.next = self.clock.val();
            self.shaper[i].frozen.next = self.frozen.val();
            self.shaper[i].clear.next = self.clear_now.val();
            self.shaper[i].request.next = self.axis[i].request.val();
            self.shaper[i].request_back.next = self.axis[i].request_back.val();
            self.shaper[i].want_fwd.next = self.axis[i].want_fwd.val();
            self.shaper[i].want_back.next = self.axis[i].want_back.val();

            self.step[i].next = self.shaper[i].step.val();
            self.dir[i].next = self.shaper[i].dir.val();
            self.position[i].next = self.shaper[i].position.val();
            self.discarded[i].next = self.shaper[i].discarded.val();
            self.overrun[i].next = self.shaper[i].overrun.val();
            self.overspeed[i].next = self.axis[i].overspeed.val();
            self.underrun[i].next = self.axis[i].underrun.val();
        }
        self.idle.next = self.at_rest.val();
        self.fault.next = self.frozen.val();
        self.protocol.next = self.broken.q.val();
        self.started.next = self.go.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitives::compiled_once::assert_sizes_agree;
    use crate::sim::assert_synthesizes;
    use carrystep_core::{AXES, PinTiming, StartPhase, Timebase};

    #[test]
    fn statements_are_those_of_each_size() {
        assert_sizes_agree::<ParallelCore<1>>();
        assert_sizes_agree::<ParallelCore<5>>();
    }

    #[test]
    fn parallel_core_of_any_number_of_axes_synthesizes() {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        assert_synthesizes(ParallelCore::<1>::new(&build).unwrap(), "carrystep_parallel_1");
        assert_synthesizes(ParallelCore::<3>::new(&build).unwrap(), "carrystep_parallel_3");
        assert_synthesizes(ParallelCore::<6>::new(&build).unwrap(), "carrystep_parallel_6");
    }
}

//! Makes the parallel core, whose number of axes is known only at run time, and simulates it or one
//! of its axes alone, clock by clock.

use crate::HdlError;
use crate::parallel::axis::ParallelAxis;
use crate::parallel::core::ParallelCore;
use crate::primitives::word::Word;
use crate::sim::{connected, mask, rising_edge, settle};
use carrystep_core::build::ParallelAxesError;
use carrystep_core::ports::{Inputs, Outputs};
use carrystep_core::{AXES, Build, Faults, Segment, StartPhase};
use rust_hdl_core::prelude::{Block, Out, Signal, check_all};

/// A parallel core whose number of axes is not part of its type.
pub trait AnyParallelCore: Block {
    /// Applies the inputs and returns the outputs of the present cycle.
    fn settle(&mut self, inputs: &Inputs) -> Outputs;
    /// Advances to the next cycle. The inputs are those of the last call of `settle`.
    fn clock(&mut self);
    /// The P of an axis in the present cycle; `None` if the core does not have this axis.
    fn fraction(&self, axis: usize) -> Option<u64>;
}

/// Makes the parallel core of this build with this number of axes, which have the first pin timings
/// of the build.
///
/// # Errors
/// Returns [`HdlError::ParallelAxes`] if the number of axes is not 1 to 6, and
/// [`HdlError::PinTiming`] if the pin timing of one of the axes is out of range.
pub fn parallel_core(build: &Build, axes: usize) -> Result<Box<dyn AnyParallelCore>, HdlError> {
    Ok(match axes {
        1 => Box::new(ParallelCore::<1>::new(build)?),
        2 => Box::new(ParallelCore::<2>::new(build)?),
        3 => Box::new(ParallelCore::<3>::new(build)?),
        4 => Box::new(ParallelCore::<4>::new(build)?),
        5 => Box::new(ParallelCore::<5>::new(build)?),
        6 => Box::new(ParallelCore::<6>::new(build)?),
        _ => return Err(ParallelAxesError(axes).into()),
    })
}

impl<const N: usize> AnyParallelCore for ParallelCore<N> {
    fn settle(&mut self, inputs: &Inputs) -> Outputs {
        self.clock.next = false.into();
        let (axis, segment) = inputs.segment.unwrap_or((0, NO_SEGMENT));
        self.seg_valid.next = inputs.segment.is_some();
        self.seg_axis.next = Word::from(u64::from(axis));
        self.seg_ticks.next = Word::from(u64::from(segment.ticks));
        self.seg_v.next = Word::from(segment.v);
        self.seg_a.next = Word::from(segment.a);
        self.seg_j.next = Word::from(segment.j);
        self.seg_last.next = segment.last;
        self.start_valid.next = inputs.start.is_some();
        self.start_mask.next = Word::from(u64::from(inputs.start.unwrap_or(0)));
        self.clear.next = inputs.clear;
        settle(self);
        let words = |ports: &[Signal<Out, Word<32>>]| {
            let mut words = [0; AXES];
            for (word, port) in words.iter_mut().zip(ports) {
                *word = port.val().value() as u32;
            }
            words
        };
        Outputs {
            seg_ready: self.seg_ready.val(),
            start_ready: self.start_ready.val(),
            step: mask(&*self.step),
            dir: mask(&*self.dir),
            position: words(&*self.position).map(u32::cast_signed),
            discarded: words(&*self.discarded),
            idle: self.idle.val(),
            faults: Faults {
                overrun: mask(&*self.overrun),
                overspeed: mask(&*self.overspeed),
                underrun: mask(&*self.underrun),
                protocol: self.protocol.val(),
            },
            started: self.started.val(),
        }
    }

    fn clock(&mut self) {
        if self.clock.val().clk {
            self.clock.next = false.into();
            settle(self);
        }
        self.clock.next = true.into();
        rising_edge(self);
    }

    fn fraction(&self, axis: usize) -> Option<u64> {
        self.axis.get(axis).map(|axis| axis.p.val().value() as u64)
    }
}

/// A simulated parallel core.
pub struct ParallelSim {
    core: Box<dyn AnyParallelCore>,
}

impl ParallelSim {
    /// Makes the core of this build with this number of axes, in cycle 0.
    ///
    /// # Errors
    /// Returns an [`HdlError`] if the core cannot be built.
    pub fn new(build: &Build, axes: usize) -> Result<Self, HdlError> {
        let mut core = parallel_core(build, axes)?;
        core.connect_all();
        check_all(core.as_ref()).map_err(|error| HdlError::Check(format!("{error:?}")))?;
        Ok(Self { core })
    }

    /// Applies the inputs and returns the outputs of the present cycle. Inputs that are not offered
    /// are driven as zero, so that `seg_ready` without a segment is that of axis 0.
    pub fn settle(&mut self, inputs: &Inputs) -> Outputs {
        self.core.settle(inputs)
    }

    /// Advances to the next cycle. The inputs are those of the last call of `settle`.
    pub fn clock(&mut self) {
        self.core.clock();
    }

    /// The P of an axis in the present cycle; `None` if the core does not have this axis. At rest
    /// after a whole move it equals the start value.
    pub fn fraction(&self, axis: usize) -> Option<u64> {
        self.core.fraction(axis)
    }
}

const NO_SEGMENT: Segment = Segment { ticks: 0, v: 0, a: 0, j: 0, last: false };

/// The result of one tick of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisTick {
    /// The tick contained a step.
    pub crossed: bool,
    /// V was negative in the tick.
    pub back: bool,
    /// The phase of the step, if there is one.
    pub q: u8,
    /// P after the tick.
    pub p: u64,
    /// V after the tick.
    pub v: i64,
}

/// A simulated axis without tick counter and shaper, for long runs. Each tick lasts only as many
/// clocks as its bisection needs.
pub struct AxisSim {
    axis: Box<ParallelAxis>,
    bisection: u32,
}

impl AxisSim {
    /// Makes an axis at rest, for ticks of Q phases.
    ///
    /// # Errors
    /// Returns [`HdlError::Phases`] unless Q is 1, 4 or 16.
    pub fn new(phases: u32, start: StartPhase) -> Result<Self, HdlError> {
        if ![1, 4, 16].contains(&phases) {
            return Err(HdlError::Phases(phases));
        }
        Ok(Self { axis: connected(ParallelAxis::new(phases, start))?, bisection: phases.ilog2() })
    }

    /// Offers a segment for one clock. Returns whether the axis accepted it.
    pub fn offer(&mut self, segment: &Segment) -> bool {
        let axis = &mut self.axis;
        axis.clock.next = false.into();
        settle(axis.as_mut());
        let taken = !axis.waiting.val();
        axis.push.next = taken;
        axis.seg_ticks.next = Word::from(u64::from(segment.ticks));
        axis.seg_v.next = Word::from(segment.v);
        axis.seg_a.next = Word::from(segment.a);
        axis.seg_j.next = Word::from(segment.j);
        axis.seg_last.next = segment.last;
        self.clock();
        self.axis.push.next = false;
        taken
    }

    /// Runs one tick: its strobe, at which a waiting segment may start if `go` is set, then its
    /// bisection.
    pub fn tick(&mut self, go: bool) -> AxisTick {
        self.axis.strobe.next = true;
        self.axis.go.next = go;
        self.clock();
        self.axis.strobe.next = false;
        for _ in 0..self.bisection {
            self.clock();
        }
        let axis = &mut self.axis;
        axis.clock.next = false.into();
        settle(axis.as_mut());
        AxisTick {
            crossed: axis.crossed.val(),
            back: axis.back.val(),
            q: axis.q.val().value() as u8,
            p: axis.p.val().value() as u64,
            v: axis.v.val().value() as u64 as i64,
        }
    }

    /// Returns whether a segment waits.
    pub fn waiting(&self) -> bool {
        self.axis.waiting.val()
    }

    /// The latched faults overspeed and underrun, in this order.
    pub fn faults(&self) -> (bool, bool) {
        (self.axis.overspeed.val(), self.axis.underrun.val())
    }

    fn clock(&mut self) {
        self.axis.clock.next = false.into();
        settle(self.axis.as_mut());
        self.axis.clock.next = true.into();
        rising_edge(self.axis.as_mut());
    }
}

//! Simulates the parallel core, or one of its axes alone, clock by clock.

use crate::HdlError;
use crate::parallel::axis::ParallelAxis;
use crate::parallel::six_axis::SixAxis;
use crate::primitives::word::Word;
use crate::sim::{connected, mask, rising_edge, settle};
use carrystep_core::ports::{Inputs, Outputs};
use carrystep_core::{AXES, Build, Faults, Segment, StartPhase};

/// A simulated six-axis core.
pub struct SixAxisSim {
    core: Box<SixAxis>,
}

impl SixAxisSim {
    /// Makes the core of this build, in cycle 0.
    ///
    /// # Errors
    /// Returns an [`HdlError`] if the core cannot be built.
    pub fn new(build: &Build) -> Result<Self, HdlError> {
        Ok(Self { core: connected(SixAxis::new(build)?)? })
    }

    /// Applies the inputs and returns the outputs of the present cycle. Inputs that are not offered
    /// are driven as zero, so that `seg_ready` without a segment is that of axis 0.
    pub fn settle(&mut self, inputs: &Inputs) -> Outputs {
        let core = &mut self.core;
        core.clock.next = false.into();
        let (axis, segment) = inputs.segment.unwrap_or((0, NO_SEGMENT));
        core.seg_valid.next = inputs.segment.is_some();
        core.seg_axis.next = Word::from(u64::from(axis));
        core.seg_ticks.next = Word::from(u64::from(segment.ticks));
        core.seg_v.next = Word::from(segment.v);
        core.seg_a.next = Word::from(segment.a);
        core.seg_j.next = Word::from(segment.j);
        core.seg_last.next = segment.last;
        core.start_valid.next = inputs.start.is_some();
        core.start_mask.next = Word::from(u64::from(inputs.start.unwrap_or(0)));
        core.clear.next = inputs.clear;
        settle(core.as_mut());
        self.outputs()
    }

    /// Advances to the next cycle. The inputs are those of the last call of `settle`.
    pub fn clock(&mut self) {
        if self.core.clock.val().clk {
            self.core.clock.next = false.into();
            settle(self.core.as_mut());
        }
        self.core.clock.next = true.into();
        rising_edge(self.core.as_mut());
    }

    /// The P of each axis in the present cycle. At rest after a whole move it equals the start
    /// value.
    pub fn fractions(&self) -> [u64; AXES] {
        std::array::from_fn(|axis| self.core.axis[axis].p.val().value() as u64)
    }

    fn outputs(&self) -> Outputs {
        let core = &self.core;
        Outputs {
            seg_ready: core.seg_ready.val(),
            start_ready: core.start_ready.val(),
            step: mask(&core.step),
            dir: mask(&core.dir),
            position: std::array::from_fn(|axis| core.position[axis].val().value() as u32 as i32),
            discarded: std::array::from_fn(|axis| core.discarded[axis].val().value() as u32),
            idle: core.idle.val(),
            faults: Faults {
                overrun: mask(&core.overrun),
                overspeed: mask(&core.overspeed),
                underrun: mask(&core.underrun),
                protocol: core.protocol.val(),
            },
            started: core.started.val(),
        }
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

//! Drives the modules from outside, one clock cycle at a time.
//!
//! ```text
//! clock    ____/^^^^\____/^^^^\____
//!            ^    ^    ^    ^
//!       settle  clock  settle  clock      inputs change with the falling edge, outputs are read before the rising one
//! ```

use crate::HdlError;
use crate::axis::Axis;
use crate::six_axis::SixAxis;
use crate::word::Word;
use carrystep_spec::ports::{Inputs, Outputs};
use carrystep_spec::{AXES, Build, Faults, Segment, StartPhase};
use rust_hdl::prelude::{Bit, Block, Out, Signal, check_all, simulate};

/// Passes in which any module here settles, with room to spare.
const PASSES: usize = 50;

/// Lets the combinational outputs follow the inputs.
pub(crate) fn settle<B: Block>(block: &mut B) {
    let settled = simulate(block, PASSES);
    debug_assert!(settled, "a combinational loop, which check_all would have refused");
}

/// Moves every register on: the clock edge reaches all of them in one pass ([`crate::register`]).
pub(crate) fn rising_edge<B: Block>(block: &mut B) {
    block.update_all();
}

pub(crate) fn connected<B: Block>(mut block: B) -> Result<Box<B>, HdlError> {
    block.connect_all();
    check_all(&block).map_err(|error| HdlError::Check(format!("{error:?}")))?;
    Ok(Box::new(block))
}

/// The six-axis core under simulation.
pub struct SixAxisSim {
    core: Box<SixAxis>,
}

impl SixAxisSim {
    /// The core of this build in cycle 0.
    ///
    /// # Errors
    /// [`HdlError`] where the build cannot be made.
    pub fn new(build: &Build) -> Result<Self, HdlError> {
        Ok(Self { core: connected(SixAxis::new(build)?)? })
    }

    /// The outputs of the present cycle with these inputs. What is not offered is driven as zero, so that
    /// `seg_ready` without a segment is that of axis 0.
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

    /// Goes to the next cycle, with the inputs as last settled.
    pub fn clock(&mut self) {
        if self.core.clock.val().clk {
            self.core.clock.next = false.into();
            settle(self.core.as_mut());
        }
        self.core.clock.next = true.into();
        rising_edge(self.core.as_mut());
    }

    /// P of each axis in the present cycle: at rest after a whole move it is the start value again.
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

/// The pins of all axes, bit i is axis i.
pub(crate) fn mask(bits: &[Signal<Out, Bit>]) -> u8 {
    bits.iter().rev().fold(0, |mask, bit| mask << 1 | u8::from(bit.val()))
}

/// What one tick of an axis did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisTick {
    /// It stepped.
    pub crossed: bool,
    /// V was negative.
    pub back: bool,
    /// The phase of the step, where there is one.
    pub q: u8,
    /// P after the tick.
    pub p: u64,
    /// V after the tick.
    pub v: i64,
}

/// One axis without tick and shaper, for long runs: a tick is as short as its bisection allows.
pub struct AxisSim {
    axis: Box<Axis>,
    bisection: u32,
}

impl AxisSim {
    /// An axis at rest, for ticks of Q phases.
    ///
    /// # Errors
    /// [`HdlError::Phases`] unless Q is 1, 4 or 16.
    pub fn new(phases: u32, start: StartPhase) -> Result<Self, HdlError> {
        if ![1, 4, 16].contains(&phases) {
            return Err(HdlError::Phases(phases));
        }
        Ok(Self { axis: connected(Axis::new(phases, start))?, bisection: phases.ilog2() })
    }

    /// Offers a segment for one clock; whether it was taken.
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

    /// One tick: its strobe, in which a waiting segment may start if `go` is set, then its bisection.
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

    /// Whether a segment waits.
    pub fn waiting(&self) -> bool {
        self.axis.waiting.val()
    }

    /// The latched faults: overspeed, underrun.
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

/// Rust-HDL's checks, its Verilog and yosys accept the module.
#[cfg(test)]
pub(crate) fn assert_synthesizes<B: Block>(module: B, name: &str) {
    use rust_hdl::prelude::{generate_verilog, yosys_validate};
    let module = connected(module).unwrap();
    yosys_validate(name, &generate_verilog(module.as_ref())).unwrap();
}

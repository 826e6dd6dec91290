//! The parallel core, clock by clock: N accumulators, N step shapers, one tick counter, a segment
//! port, a start mask and the freeze after a fault. It must stay equal to the section "parallel" of
//! docs/clock-by-clock.md.
//!
//! ```text
//! cycle   c-1 | c                 | c+C               | c+2C
//! strobe   ^  |                ^  |                ^  |
//! axis        | tick n is added   :                   |
//! stage       |                   | phase is known    |
//! emission    |                   |                   | request at phase q, pin one clock later
//! ```

use crate::parallel::axis;
use crate::parts::cubic::Cubic;
use crate::parts::moving::Moving;
use crate::parts::shaper;
use crate::parts::stage::Stage;
use carrystep_core::ports::{Inputs, Outputs};
use carrystep_core::{AXES, Build, Faults};

/// One axis: its accumulator, the two stages behind it, its latched faults and its step shaper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct AxisModel {
    pub axis: axis::AxisRegisters,
    pub computed: Stage,
    pub emitted: Stage,
    pub overspeed: bool,
    pub underrun: bool,
    pub shaper: shaper::ShaperState,
}

/// The state of the core. [`ParallelCore::outputs`] and [`ParallelCore::clock`] together are one
/// clock cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParallelCore {
    pub(crate) build: Build,
    axes: usize,
    sub: u32,
    phase: u32,
    armed: Option<u8>,
    protocol: bool,
    /// The axes. Those from N on do not exist: no command reaches them, and they stay at rest.
    pub(crate) axis_models: [AxisModel; AXES],
}

impl ParallelCore {
    /// The core of this number of axes, 1 to 6, at configuration. It has the first pin timings of
    /// the build. A greater number counts as 6.
    pub fn new(build: &Build, axes: usize) -> Self {
        let axis_model = |axis: usize| AxisModel {
            axis: axis::AxisRegisters::at_rest(build.phase.start_value()),
            computed: Stage::default(),
            emitted: Stage::default(),
            overspeed: false,
            underrun: false,
            shaper: shaper::ShaperState::at_configuration(build.pins[axis]),
        };
        Self {
            build: build.clone(),
            axes: axes.min(AXES),
            sub: 0,
            phase: 0,
            armed: None,
            protocol: false,
            axis_models: std::array::from_fn(axis_model),
        }
    }

    /// The registers of an axis' accumulator; at rest if the core does not have this axis. Panics
    /// if `axis` is not less than 6.
    pub fn axis(&self, axis: usize) -> &axis::AxisRegisters {
        &self.axis_models[axis].axis
    }

    /// The registers of an axis' step shaper; at rest if the core does not have this axis. Panics
    /// if `axis` is not less than 6.
    pub fn shaper(&self, axis: usize) -> &shaper::ShaperState {
        &self.axis_models[axis].shaper
    }

    /// The outputs in this cycle for these inputs.
    pub fn outputs(&self, inputs: &Inputs) -> Outputs {
        let faults = self.faults();
        let frozen = faults.any();
        let bits = |of: fn(&AxisModel) -> bool| bits(&self.axis_models, of);
        Outputs {
            seg_ready: !frozen && self.takes(inputs.segment.map_or(0, |(axis, _)| axis)),
            start_ready: !frozen && self.armed.is_none(),
            step: bits(|axis_model| axis_model.shaper.step),
            dir: bits(|axis_model| axis_model.shaper.dir),
            position: std::array::from_fn(|axis| self.axis_models[axis].shaper.position),
            discarded: std::array::from_fn(|axis| self.axis_models[axis].shaper.discarded),
            idle: self.armed.is_none() && self.axis_models.iter().all(AxisModel::idle),
            faults,
            started: !frozen && self.strobe() && self.go().is_some(),
        }
    }

    /// Advances by one cycle.
    pub fn clock(&mut self, inputs: &Inputs) {
        let frozen = self.faults().any();
        let strobe = self.strobe();
        let clear = inputs.clear && frozen && !self.axis_models.iter().any(AxisModel::on_its_way);
        let go = self.go().filter(|_| strobe && !frozen);
        let phase_start = self.sub == 0;
        let armed_before = self.armed;
        let seg_ready = !frozen && self.takes(inputs.segment.map_or(0, |(axis, _)| axis));
        let waiting_before: u8 =
            bits(&self.axis_models, |axis_model| axis_model.axis.waiting.is_some());

        for (axis, axis_model) in self.axis_models.iter_mut().enumerate() {
            let request =
                axis_model.emitted.step.filter(|step| phase_start && step.phase == self.phase);
            let input = shaper::ShaperInput {
                request: request.map(|step| step.backward),
                sign: axis_model.emitted.sign,
                frozen,
            };
            axis_model.shaper = shaper::clock(axis_model.shaper, input, self.build.pins[axis]);
            if strobe {
                let selected = go.is_some_and(|mask| mask >> axis & 1 == 1);
                axis_model.tick(selected, frozen, self.build.timebase.phase_bits());
            }
            if frozen {
                axis_model.axis = axis_model.axis.stopped();
            }
            if clear {
                axis_model.clear(self.build.phase.start_value());
            }
        }
        if go.is_some() || frozen {
            self.armed = None;
        }
        if clear {
            self.protocol = false;
        }
        if let Some((axis, segment)) = inputs.segment.filter(|_| seg_ready) {
            let axis_models = &mut self.axis_models[..self.axes];
            match axis_models.get_mut(usize::from(axis)).filter(|_| segment.ticks > 0) {
                Some(axis_model) => axis_model.axis.waiting = Some(segment),
                None => self.protocol = true,
            }
        }
        if let Some(offered) = inputs.start.filter(|_| !frozen && armed_before.is_none()) {
            // The port has one bit for each axis of the core.
            let mask = offered & ((1 << self.axes) - 1);
            if mask & !waiting_before == 0 {
                self.armed = Some(mask);
            } else {
                self.protocol = true;
            }
        }
        self.advance();
    }

    /// The latched faults. Any of them freezes the core.
    pub fn faults(&self) -> Faults {
        Faults {
            overrun: bits(&self.axis_models, |axis_model| axis_model.shaper.overrun),
            overspeed: bits(&self.axis_models, |axis_model| axis_model.overspeed),
            underrun: bits(&self.axis_models, |axis_model| axis_model.underrun),
            protocol: self.protocol,
        }
    }

    /// True if a segment for this axis is accepted: its waiting slot is free, or the axis does not
    /// exist (a protocol fault).
    fn takes(&self, axis: u8) -> bool {
        self.axis_models[..self.axes]
            .get(usize::from(axis))
            .is_none_or(|axis_model| axis_model.axis.waiting.is_none())
    }

    /// The axes that start in the coming tick: all armed axes together, or `None`.
    fn go(&self) -> Option<u8> {
        let startable = bits(&self.axis_models, |axis_model| axis_model.axis.startable());
        self.armed.filter(|mask| mask & !startable == 0)
    }

    fn strobe(&self) -> bool {
        let time = &self.build.timebase;
        self.sub == time.clocks_per_phase() - 1 && self.phase == time.phases() - 1
    }

    fn advance(&mut self) {
        let time = &self.build.timebase;
        self.sub += 1;
        if self.sub == time.clocks_per_phase() {
            self.sub = 0;
            self.phase = (self.phase + 1) % time.phases();
        }
    }
}

/// Access for the fast model, which passes many cycles at once.
impl ParallelCore {
    /// Cycles since the beginning of the tick.
    pub(crate) fn clock_of_tick(&self) -> u64 {
        let time = &self.build.timebase;
        u64::from(self.phase * time.clocks_per_phase() + self.sub)
    }

    /// Advances the counters of the tick by this many clocks.
    pub(crate) fn pass(&mut self, clocks: u64) {
        let time = &self.build.timebase;
        let now = (self.clock_of_tick() + clocks) % u64::from(time.clocks_per_tick());
        let per_phase = u64::from(time.clocks_per_phase());
        // Both values are less than the number of clocks per tick, which is a `u32`.
        (self.phase, self.sub) = ((now / per_phase) as u32, (now % per_phase) as u32);
    }

    /// True if the inputs change nothing in this cycle, the next strobe only adds, and neither
    /// `idle` nor a fault can occur before a segment ends.
    pub(crate) fn only_adds(&self, inputs: &Inputs) -> bool {
        let moving = self.armed.is_some()
            || self.axis_models.iter().any(|l| l.axis.running || l.axis.waiting.is_some());
        moving && !self.faults().any() && self.go().is_none() && !self.hears(inputs)
    }

    /// True if nothing changes as long as the inputs stay the same.
    pub(crate) fn is_still(&self, inputs: &Inputs) -> bool {
        let frozen = self.faults().any();
        let deaf = if frozen {
            !inputs.clear && self.armed.is_none()
        } else {
            self.go().is_none() && !self.hears(inputs)
        };
        deaf && self.axis_models.iter().all(AxisModel::is_still)
    }

    /// True if a core that is not frozen would accept an offered segment or start in this cycle.
    fn hears(&self, inputs: &Inputs) -> bool {
        inputs.segment.is_some_and(|(axis, _)| self.takes(axis))
            || (inputs.start.is_some() && self.armed.is_none())
    }
}

impl AxisModel {
    /// Executes the strobe: the stages advance, and one tick is added unless the core is frozen.
    pub(crate) fn tick(&mut self, go: bool, frozen: bool, phase_bits: u32) {
        self.emitted = self.computed;
        self.computed = Stage::default();
        if !frozen {
            let (next, output) = axis::tick(self.axis, go, phase_bits);
            self.axis = next;
            self.computed = Stage { step: output.step, sign: output.sign };
            self.overspeed |= output.overspeed;
            self.underrun |= output.underrun;
        }
    }

    fn clear(&mut self, start_value: u64) {
        self.axis = axis::AxisRegisters::at_rest(start_value);
        self.computed.sign = 0;
        self.emitted.sign = 0;
        self.overspeed = false;
        self.underrun = false;
        self.shaper.overrun = false;
    }

    /// True if a step has left the accumulator and its pulse on the pin is not yet over.
    fn on_its_way(&self) -> bool {
        self.computed.step.is_some() || self.emitted.step.is_some() || self.shaper.step
    }

    /// True if no clock and no strobe changes the axis.
    fn is_still(&self) -> bool {
        !self.axis.running
            && self.computed.is_empty()
            && self.emitted.is_empty()
            && self.shaper.is_still(false)
    }

    /// The part of the axis that a window of the fast model changes.
    pub(crate) fn moving(&self) -> Moving {
        let cubic = Cubic { v: self.axis.v, a: self.axis.a, j: self.axis.j };
        Moving {
            p: self.axis.p,
            cubic,
            computed: self.computed,
            emitted: self.emitted,
            shaper: self.shaper,
        }
    }

    /// Writes back the axis as it is after a window with this many strobes.
    pub(crate) fn moved(&mut self, moved: &Moving, strobes: u32) {
        let Moving { p, cubic: Cubic { v, a, .. }, computed, emitted, shaper } = *moved;
        let left = self.axis.left - if self.axis.running { strobes } else { 0 };
        self.axis = axis::AxisRegisters { p, v, a, left, ..self.axis };
        (self.computed, self.emitted, self.shaper) = (computed, emitted, shaper);
    }

    fn idle(&self) -> bool {
        !self.axis.running
            && self.axis.waiting.is_none()
            && self.shaper.held_back.is_none()
            && !self.on_its_way()
    }
}

fn bits(axis_models: &[AxisModel; AXES], of: impl Fn(&AxisModel) -> bool) -> u8 {
    axis_models
        .iter()
        .enumerate()
        .fold(0, |bits, (axis, axis_model)| bits | u8::from(of(axis_model)) << axis)
}

//! The engine without the words of state that it outputs for a host: up to eight accumulators with
//! queues. The results of a tick take effect for all axes together at the strobe that ends it. The
//! contract is the section "engine" of docs/clock-by-clock.md up to "Several latches"; change both
//! together.
//!
//! ```text
//! tick     |       n       |     n + 1     |     n + 2     |
//! strobe   _______________/^______________/^______________/^
//! segment  |  committed    |  in the queue
//! step     |  computed     |  waits        |  requested in phase q
//! ```
//!
//! A segment whose commit arrives in tick n is in the queue from tick n + 1 on. The additions of
//! tick n find a step and its phase q; the strobe that ends tick n commits them. The step is
//! requested of the shaper two ticks later, in the first clock of phase q of tick n + 2, and is on
//! the pin one clock after that.

mod axis_model;
mod cut;
mod guard;
mod inspection;
mod latch;
mod observed;
mod outputs;
mod plain;
mod reset;
mod seek;
mod strobe;
mod switches;
mod words;

use crate::parts::shaper;
use axis_model::{AxisModel, Queued, Tick};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{
    COMMIT, CUT_WORD, Cause, Commit, EngineInputs, EngineOutputs, PUT_BEAT, Put, StateWords,
};
use cut::Cut;
use guard::{Stop, Supervisor};
use latch::LatchState;
pub(crate) use observed::Ending;
use outputs::OutputState;
use reset::Reset;
use seek::Seek;
use std::ops::Range;
use std::sync::Arc;
use strobe::Decision;
use switches::LAST_BEAT;

/// The state of the motion. [`Motion::outputs`] and [`Motion::clock`] together are one clock cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Motion {
    build: Arc<EngineBuild>,
    /// Number of the clock in the tick, from 0.
    clock: u32,
    /// False in the first tick after configuration, which has no time slots.
    time_slots: bool,
    armed: Option<u8>,
    stop: Stop,
    /// The word taken in the cycle before was not the next one of its segment.
    misplaced: bool,
    /// The commit taken in the cycle before had bits that it must not have.
    stray: bool,
    reset: Reset,
    supervisor: Supervisor,
    /// Number of whole ticks, saturating at 2, in which no axis ran and no queue held a segment.
    rest: u32,
    axis_models: Vec<AxisModel>,
    /// The level of the switch that each axis has sampled in its last time slot; true is active,
    /// false if it has sampled none.
    pins: Vec<bool>,
    /// The interlock was open at its last sample.
    interlock: bool,
    seek: Seek,
    latch: LatchState,
    outputs: OutputState,
    cut: Cut,
}

impl Motion {
    /// The engine at configuration.
    pub fn new(build: &EngineBuild) -> Self {
        let axis_model = |(pins, stop): (_, &u64)| {
            AxisModel::new(
                build.phase.start_value(),
                *stop,
                build.slots(),
                shaper::ShaperState::at_configuration(pins),
            )
        };
        Self {
            build: Arc::new(build.clone()),
            clock: 0,
            time_slots: false,
            armed: None,
            stop: Stop::default(),
            misplaced: false,
            stray: false,
            reset: Reset::default(),
            supervisor: Supervisor::new(),
            rest: 2,
            axis_models: build
                .pins
                .iter()
                .copied()
                .zip(&build.guard.stop)
                .map(axis_model)
                .collect(),
            pins: vec![false; build.axes()],
            interlock: false,
            seek: Seek::default(),
            latch: LatchState::default(),
            outputs: OutputState::default(),
            cut: Cut::default(),
        }
    }

    /// P of an axis, in 2^-64 step. Panics if the axis does not exist.
    pub fn fraction(&self, axis: usize) -> u64 {
        self.axis_models[axis].p
    }

    /// The registers of an axis' step shaper. Panics if the axis does not exist.
    pub fn shaper(&self, axis: usize) -> &shaper::ShaperState {
        &self.axis_models[axis].shaper
    }

    /// The outputs in this cycle for these inputs, without words of state.
    pub fn outputs(&self, inputs: &EngineInputs) -> EngineOutputs {
        let (strobe, guard) = (self.strobe(), &self.build.guard);
        let put_axis = usize::from(inputs.put.map_or(inputs.room_of, |put| put.axis));
        EngineOutputs {
            put_ready: self.put_ready(inputs),
            cut_busy: self.cut.is_busy(),
            cut_refused: self.cut.refused || !self.build.cuts,
            start_ready: self.start_ready(inputs),
            step: bits(&self.axis_models, |axis_model| axis_model.shaper.step),
            dir: bits(&self.axis_models, |axis_model| axis_model.shaper.dir),
            outputs: self.outputs.levels,
            pwm: self.outputs.pwm,
            enabled: self.supervisor.enabled,
            idle: self.is_idle(),
            fault: self.stop.fault,
            halted: self.stop.halted,
            resetting: self.reset.is_resetting(),
            armed: self.armed.is_some(),
            ready: inputs.enable && self.supervisor.is_warm(guard),
            seeking: bits(&self.axis_models, |axis_model| axis_model.seek.waits),
            hits: bits(&self.axis_models, |axis_model| axis_model.seek.slows),
            latch_armed: self.latch.armed(),
            latch_edges: self.latch.edges(),
            latch_records: self.latch.records(),
            state: StateWords::NONE,
            refreshed: false,
            room: self.is_at(PUT_BEAT, put_axis).then(|| self.axis_models[put_axis].room()),
            // Without an armed start there is no decision, and no need for the tick.
            started: strobe
                && self.armed.is_some()
                && matches!(self.decision(&self.ticked()), Decision::Go(_)),
        }
    }

    /// True if the engine accepts the word that the host offers in this cycle. If the host offers
    /// none, true if the engine would accept one for the axis whose room the host asks for.
    fn put_ready(&self, inputs: &EngineInputs) -> bool {
        let axis = usize::from(inputs.put.map_or(inputs.room_of, |put| put.axis));
        let names = inputs.put.is_some_and(|put| put.word & CUT_WORD != 0);
        self.stop.fault.is_none() && self.takes(axis, names)
    }

    /// True if a start is accepted in this cycle.
    fn start_ready(&self, inputs: &EngineInputs) -> bool {
        self.stop.fault.is_none()
            && self.strobe()
            && self.armed.is_none()
            && inputs.enable
            && self.supervisor.is_warm(&self.build.guard)
    }

    /// True if no axis moves and none will without the host.
    fn is_idle(&self) -> bool {
        self.rest == 2 && self.armed.is_none() && !self.pins_busy()
    }

    /// Advances by one cycle.
    pub fn clock(&mut self, inputs: &EngineInputs) {
        let (put_ready, start_ready) = (self.put_ready(inputs), self.start_ready(inputs));
        let (idle, strobe) = (self.is_idle(), self.strobe());
        let (before, reset) = (self.stop, self.reset);
        // The order of these calls is the priority of the causes: the first one is latched. It is
        // overrun, e-stop, protocol, the causes found in the tick (`end_tick`), watchdog,
        // interlock, stop.
        let mut stop = before;
        let busy = self.pins_busy();
        let late = self.shape();
        if late != 0 {
            stop.call(Cause::Overrun, late, &self.build.guard);
        }
        if strobe && self.supervisor.pressed() {
            stop.call(Cause::EStop, 0, &self.build.guard);
        }
        let nobody = inputs.put.is_some_and(|put| usize::from(put.axis) >= self.axis_models.len());
        let missing = latch::arms_a_missing_one(&self.build.guard, inputs);
        let breaks = nobody || inputs.broken || missing || self.misplaced || self.stray;
        if breaks && before.fault.is_none() {
            stop.call(Cause::Protocol, 0, &self.build.guard);
        }
        self.sample(inputs);
        let taken = inputs.put.filter(|_| put_ready && !nobody);
        self.stray = taken.is_some_and(|put| self.has_stray_bits(put));
        self.misplaced = taken.is_some_and(|put| !self.put(put));
        self.clock_outputs(strobe);
        // While the engine is at rest, a silent host calls no stop.
        let waits = self.rest == 2;
        if strobe {
            stop = self.end_tick(inputs, start_ready, stop, busy);
        }
        if strobe && self.supervisor.misses_the_host(&self.build.guard) && !waits {
            stop.call(Cause::Watchdog, 0, &self.build.guard);
        }
        if strobe && self.interlock {
            stop.call(Cause::Interlock, 0, &self.build.guard);
        }
        if inputs.stop || reset.ending {
            stop.call(Cause::Stop, 0, &self.build.guard);
            stop.frozen |= reset.ending;
        }
        if before.fault.is_some() {
            self.armed = None;
        }
        self.watch_interlock();
        self.clock_seek(inputs, strobe);
        self.latch.clock(&self.build.guard, inputs, strobe);
        self.clock_cut(inputs, strobe);
        self.supervisor.clock(&self.build.guard, inputs, strobe, idle);
        self.stop = stop;
        if strobe && before.clearing {
            self.stop = Stop::default();
            self.empty();
        }
        self.clock_reset(reset, inputs.reset);
        if strobe {
            let free = before.settled && !before.clearing && !busy;
            self.strobe_reset(reset, inputs.reset, free);
        }
        self.clock = (self.clock + 1) % self.build.timebase.clocks_per_tick();
    }

    fn strobe(&self) -> bool {
        self.clock + 1 == self.build.timebase.clocks_per_tick()
    }

    fn pins_busy(&self) -> bool {
        self.axis_models
            .iter()
            .any(|axis_model| axis_model.shaper.held_back.is_some() || axis_model.shaper.step)
    }

    /// Executes one clock of all shapers; returns the axes for which a second step arrived while
    /// one was held back, one bit each.
    fn shape(&mut self) -> u8 {
        let per_phase = self.build.timebase.clocks_per_phase();
        let (phase, sub) = (self.clock / per_phase, self.clock % per_phase);
        for (axis_model, pins) in self.axis_models.iter_mut().zip(&self.build.pins) {
            let request = axis_model
                .emitted
                .step
                .filter(|step| sub == 0 && step.phase == phase)
                .map(|step| step.backward);
            let input = shaper::ShaperInput {
                request,
                sign: axis_model.emitted.sign,
                frozen: self.stop.frozen,
            };
            axis_model.shaper = shaper::clock(
                shaper::ShaperState { overrun: false, ..axis_model.shaper },
                input,
                *pins,
            );
        }
        bits(&self.axis_models, |axis_model| axis_model.shaper.overrun)
    }

    /// True if a word for this axis is accepted in this clock. The axis accepts a word of a segment
    /// in its time slot if its queue has room, and one that `names` the slot of a cut at the end of
    /// its time slot unless a cut is examined. A word for an axis that does not exist is accepted
    /// at once (and is a protocol fault).
    fn takes(&self, axis: usize, names: bool) -> bool {
        self.axis_models.get(axis).is_none_or(|axis_model| {
            if names {
                self.is_at(LAST_BEAT, axis) && !self.cut.checks
            } else {
                self.is_at(PUT_BEAT, axis) && axis_model.room() > 0
            }
        })
    }

    /// The axes whose time slot it is, if this clock is the given beat of the time slot; else none.
    fn axes_at(&self, beat: u32) -> Range<usize> {
        self.time_slot().filter(|(_, now)| *now == beat).map_or(0..0, |(axes, _)| axes)
    }

    /// True if this clock is the given beat of the time slot of an axis.
    fn is_at(&self, beat: u32, axis: usize) -> bool {
        self.axes_at(beat).contains(&axis)
    }

    /// Takes a word. Returns false if it is not the next word of its axis' segment.
    fn put(&mut self, put: Put) -> bool {
        let axis_model = &mut self.axis_models[usize::from(put.axis)];
        if put.word & CUT_WORD != 0 {
            axis_model.named =
                self.build.cuts.then_some((put.data % axis_model.slots as u32) as u8);
            return true;
        }
        self.rest = 0;
        if put.word != axis_model.next_word {
            return false;
        }
        if put.word == COMMIT {
            axis_model.fresh = Some(Queued::of_words(axis_model.words, Commit::of_word(put.data)));
            axis_model.next_word = 0;
        } else {
            axis_model.words[usize::from(put.word)] = put.data;
            axis_model.next_word += 1;
        }
        true
    }

    /// True for a commit with a bit that the build has no use for.
    fn has_stray_bits(&self, put: Put) -> bool {
        let outputs = self.build.outputs;
        let bits = if put.axis == 0 { outputs.commit_bits() } else { Commit::LAST };
        outputs.is_any() && put.word == COMMIT && put.data & !bits != 0
    }

    fn tick(&self) -> Tick<'_> {
        Tick {
            guard: &self.build.guard,
            phase_bits: self.build.timebase.phase_bits(),
            halted: self.stop.halted,
            ramp: self.stop.ramp,
        }
    }
}

fn bits(axis_models: &[AxisModel], of: impl Fn(&AxisModel) -> bool) -> u8 {
    axis_models
        .iter()
        .enumerate()
        .fold(0, |bits, (axis, axis_model)| bits | u8::from(of(axis_model)) << axis)
}

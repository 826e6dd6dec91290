//! The limit inputs of the axes: when each is sampled, and what homing does when one is found. It
//! must stay equal to "The guard's inputs" and "Homing" in docs/clock-by-clock.md.

use super::Motion;
use super::axis_model::LimitSample;
use carrystep_core::engine::{EngineInputs, LimitWiring, TIME_SLOT_CLOCKS};

/// The beat of a time slot in which the limit pin is sampled.
pub(super) const SAMPLE_BEAT: u32 = 10;

impl Motion {
    /// Samples the limit pin of the axis whose time slot it is.
    pub(super) fn sample(&mut self, inputs: &EngineInputs) {
        let (axis, beat) =
            ((self.clock / TIME_SLOT_CLOCKS) as usize, self.clock % TIME_SLOT_CLOCKS);
        if axis < self.axis_models.len() && beat == SAMPLE_BEAT {
            self.pins[axis] = self.pin(inputs, axis, self.supervisor.tick_of_round);
        }
    }

    /// The limit input that an axis samples in this tick of the round; true is active.
    pub(super) fn pin(&self, inputs: &EngineInputs, axis: usize, tick_of_round: u32) -> bool {
        let guard = &self.build.guard;
        let pins = if tick_of_round == 1 { inputs.limit_max } else { inputs.limit_min };
        let bit = if guard.limits == LimitWiring::One { 0 } else { axis };
        (pins >> bit & 1 == 1) != guard.limits_low
    }

    /// The limit input that an axis evaluates in this tick, if it evaluates one.
    pub(super) fn sample_of(&self, axis: usize) -> Option<LimitSample> {
        let max =
            self.supervisor.tick_of_round == 1 && self.build.guard.limits == LimitWiring::Pair;
        let samples = self.time_slots && (self.supervisor.tick_of_round == 0 || max);
        samples.then_some(LimitSample { max, pin: self.pins[axis] })
    }

    /// In the last beat of its time slot, an axis that waits for its limit may find it active.
    pub(super) fn meet(&mut self) {
        let Some(axis) = self
            .time_slot_at(TIME_SLOT_CLOCKS - 1)
            .filter(|axis| self.axis_models[*axis].homing.waits)
        else {
            return;
        };
        if self
            .sample_of(axis)
            .is_some_and(|sample| self.axis_models[axis].hits(self.tick(), sample))
        {
            self.axis_models[axis].homing.waits = false;
            self.axis_models[axis].homing.meets = true;
        }
    }
}

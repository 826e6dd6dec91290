//! The switches: which of them are sampled in which tick of a round, their debounce, and the
//! interlock. It must stay equal to "Switches" in docs/clock-by-clock.md.
//!
//! ```text
//! tick of round   0           1           2          3          4 ...
//! sampled row     limit_min   limit_max   inputs_0   inputs_1   none
//! ```

use super::Motion;
use carrystep_core::engine::{
    EngineInputs, Guard, InputRow, LimitWiring, SWITCH_ROWS, TIME_SLOT_CLOCKS,
};

/// The beat of a time slot in which the pin of a switch is sampled.
pub(super) const SAMPLE_BEAT: u32 = 10;

/// The last beat of a time slot, after which the results of a sample take effect.
pub(super) const LAST_BEAT: u32 = TIME_SLOT_CLOCKS - 1;

/// The row of the interlock; it is the switch of axis 0 in it.
pub(super) const INTERLOCK_ROW: u8 = 3;

/// A switch: its debounced state, and the number of consecutive samples that differ from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Switch {
    pub(super) active: bool,
    pub(super) against: u32,
}

/// One sample of a switch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Sample {
    pub(super) row: u8,
    /// The sampled level; true is active.
    pub(super) pin: bool,
}

impl Switch {
    /// Takes one sample; returns true if the debounced state becomes active with it.
    pub(super) fn sample(&mut self, pin: bool, debounce: u32) -> bool {
        if pin == self.active {
            self.against = 0;
            return false;
        }
        self.against += 1;
        if self.against < debounce {
            return false;
        }
        *self = Self { active: pin, against: 0 };
        pin
    }

    /// The debounced state after a sample.
    pub(super) fn after(mut self, pin: bool, debounce: u32) -> bool {
        self.sample(pin, debounce);
        self.active
    }

    /// Takes the sample of a limit in a tick whose V has this sign; returns true if the limit is
    /// found.
    pub(super) fn finds_limit(&mut self, sample: Sample, guard: &Guard, sign: i8) -> bool {
        let became = self.sample(sample.pin, guard.debounce);
        match (guard.limits, sample.row) {
            (LimitWiring::Pair, 0) => self.active && sign < 0,
            (LimitWiring::Pair, 1) => self.active && sign > 0,
            (LimitWiring::Each | LimitWiring::One, 0) => became && sign != 0,
            _ => false,
        }
    }
}

impl Motion {
    /// True if the switches of this row are sampled.
    pub(super) fn is_sampled(&self, row: u8) -> bool {
        let Guard { limits, inputs, .. } = &self.build.guard;
        match row {
            0 => *limits != LimitWiring::None,
            1 => *limits == LimitWiring::Pair,
            2 => inputs[0].exist != 0,
            _ => inputs[1].exist != 0,
        }
    }

    /// The rows of switches that are sampled.
    pub(crate) fn rows(&self) -> impl Iterator<Item = u8> {
        (0..SWITCH_ROWS).filter(|row| self.is_sampled(*row))
    }

    /// The row that is sampled in this tick of a round, if one is.
    pub(super) fn row_in(&self, tick_of_round: u32) -> Option<u8> {
        self.rows().find(|row| u32::from(*row) == tick_of_round)
    }

    /// The row that is sampled in the present tick, if one is.
    pub(crate) fn row(&self) -> Option<u8> {
        self.row_in(self.supervisor.tick_of_round).filter(|_| self.time_slots)
    }

    /// The level at the pin of a switch; true is active.
    pub(crate) fn pin(&self, inputs: &EngineInputs, axis: usize, row: u8) -> bool {
        let guard = &self.build.guard;
        let limit = |pins: u8, bit: usize| (pins >> bit & 1 == 1) != guard.limits_low;
        let input = |pins: u8, InputRow { exist, low }| (pins ^ low) & exist & 1 << axis != 0;
        match row {
            0 if guard.limits == LimitWiring::One => limit(inputs.limit_min, 0),
            0 => limit(inputs.limit_min, axis),
            1 => limit(inputs.limit_max, axis),
            2 => input(inputs.inputs[0], guard.inputs[0]),
            _ => input(inputs.inputs[1], guard.inputs[1]),
        }
    }

    /// The debounced state of a switch before the sample of the present tick.
    pub(crate) fn switch_state(&self, axis: usize, row: u8) -> bool {
        self.axis_models[axis].switches[usize::from(row)].active
    }

    /// Samples the pins of the switches whose time slot it is.
    pub(super) fn sample(&mut self, inputs: &EngineInputs) {
        for axis in self.axes_at(SAMPLE_BEAT) {
            self.pins[axis] = self.row().is_some_and(|row| self.pin(inputs, axis, row));
        }
    }

    /// The sample that an axis evaluates in this tick, if it evaluates one.
    pub(super) fn sample_of(&self, axis: usize) -> Option<Sample> {
        self.row().map(|row| Sample { row, pin: self.pins[axis] })
    }

    /// Samples the state of the interlock in the last beat of its time slot.
    pub(super) fn watch_interlock(&mut self) {
        let guard = &self.build.guard;
        if self.is_at(LAST_BEAT, 0) && guard.has_interlock() && self.row() == Some(INTERLOCK_ROW) {
            let switch = self.axis_models[0].switches[usize::from(INTERLOCK_ROW)];
            self.interlock = switch.after(self.pins[0], guard.debounce);
        }
    }
}

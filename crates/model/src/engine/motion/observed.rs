//! What the readout observes of the motion. None of it is changed there.

use super::Motion;
use carrystep_core::engine::TIME_SLOT_CLOCKS;
use std::ops::Range;

/// The state of an axis after the last strobe.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct AxisState {
    /// P in 2^-64 step.
    pub p: u64,
    /// The ticks `left` of its segment if the axis runs.
    pub left: Option<u32>,
    /// The slot of the running segment, or of the last one that ran.
    pub slot: u8,
    /// Number of segments in the queue.
    pub waiting: u8,
}

/// What the strobe of this clock does beside adding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Ending {
    /// The axes whose state is captured for the hit of a seek in this tick, one bit each.
    pub hits: u8,
    /// The queues are emptied, by a clear or a reset.
    pub empties: bool,
    /// The number of discarded steps is set to 0, by a reset.
    pub forgets: bool,
}

impl Motion {
    /// The axes whose time slot it is, one of each adder, and the beat.
    pub(crate) fn time_slot(&self) -> Option<(Range<usize>, u32)> {
        let (slot, beat) =
            ((self.clock / TIME_SLOT_CLOCKS) as usize, self.clock % TIME_SLOT_CLOCKS);
        let first = slot * self.build.adders;
        (self.time_slots && first < self.axis_models.len())
            .then(|| (first..first + self.build.adders, beat))
    }

    /// The state of an axis, which must exist.
    pub(crate) fn axis_state(&self, axis: usize) -> AxisState {
        let axis_model = &self.axis_models[axis];
        AxisState {
            p: axis_model.p,
            left: axis_model.running.filter(|_| !self.stop.halted).map(|segment| segment.left),
            slot: axis_model.slot,
            waiting: axis_model.queue.len() as u8,
        }
    }

    /// What this clock ends if it is a strobe.
    pub(crate) fn ending(&self) -> Option<Ending> {
        let forgets = self.reset.forgets();
        self.strobe().then(|| Ending {
            hits: super::bits(&self.axis_models, |axis_model| {
                axis_model.seek.hits || self.seek.sweeps
            }),
            empties: self.stop.clearing || forgets,
            forgets,
        })
    }

    /// True if the words of state of this tick are latched.
    pub(crate) const fn latches(&self) -> bool {
        self.latch.latches()
    }

    /// The number of the record to which they belong.
    pub(crate) const fn record(&self) -> u8 {
        self.latch.record
    }

    /// True while the engine returns to its state at configuration.
    pub(crate) const fn is_resetting(&self) -> bool {
        self.reset.is_resetting()
    }

    /// The step of an axis in the tick before the last strobe: 1 forward, -1 backward, or 0.
    pub(crate) fn carry(&self, axis: usize) -> i32 {
        self.axis_models[axis].computed.step.map_or(0, |step| signed(step.backward))
    }

    /// Number of clocks before the next one that is this beat of the time slot of an axis; 0 if the
    /// present clock is.
    pub(crate) fn until(&self, axis: usize, beat: u32) -> u64 {
        let (at, per_tick) = (self.build.first_clock_of(axis) + beat, self.clocks_per_tick());
        u64::from((at + per_tick - self.clock_of_tick()) % per_tick)
    }

    /// The position of an axis with all steps that are between its accumulator and its pin. Unless
    /// steps are discarded, only a carry changes it.
    pub(crate) fn carried(&self, axis: usize) -> i32 {
        let axis_model = &self.axis_models[axis];
        let per_phase = self.build.timebase.clocks_per_phase();
        let emitted = axis_model.emitted.step.filter(|step| self.clock <= step.phase * per_phase);
        let held_back = axis_model.shaper.held_back.map_or(0, signed);
        let steps = held_back + emitted.map_or(0, |step| signed(step.backward)) + self.carry(axis);
        axis_model.shaper.position.wrapping_add(steps)
    }
}

const fn signed(backward: bool) -> i32 {
    if backward { -1 } else { 1 }
}

//! Reconstructs from edges the outputs of every cycle in which any of them changed.

use crate::listener::Listener;
use carrystep_core::PinTiming;
use carrystep_core::engine::{EngineOutputs, MAX_AXES};
use carrystep_core::ports::Outputs;
use carrystep_model::fast::{Change, Edge, Edges};

/// Time of a falling edge that is not scheduled.
const NEVER: u64 = u64::MAX;

/// Outputs that edges change.
pub trait ReplayedOutputs: Copy + PartialEq + Default {
    /// Levels of the STEP and DIR pins.
    fn pins(&mut self) -> (&mut u8, &mut u8);
    /// Counts a step of an axis, forward or backward.
    fn count(&mut self, axis: usize, backward: bool);
    /// Sets the levels of the outputs that programs switch, one bit each, if there are any.
    fn switch(&mut self, _levels: u8) {}
}

impl ReplayedOutputs for Outputs {
    fn pins(&mut self) -> (&mut u8, &mut u8) {
        (&mut self.step, &mut self.dir)
    }

    fn count(&mut self, axis: usize, backward: bool) {
        let position = &mut self.position[axis];
        *position = position.wrapping_add(if backward { -1 } else { 1 });
    }
}

impl ReplayedOutputs for EngineOutputs {
    fn pins(&mut self) -> (&mut u8, &mut u8) {
        (&mut self.step, &mut self.dir)
    }

    fn count(&mut self, _: usize, _: bool) {}

    fn switch(&mut self, levels: u8) {
        self.outputs = levels;
    }
}

/// Calls an observer for the cycles for which the clock-by-clock model would call it.
pub struct Replay<'a, O> {
    observer: &'a mut (dyn FnMut(u64, &O) + 'a),
    step_high: [u64; MAX_AXES],
    /// Cycle of the next falling edge of each STEP.
    falls: [u64; MAX_AXES],
    first_fall: u64,
    /// The cycle of `now`, which holds the outputs as far as they are known.
    at: u64,
    now: O,
    /// The outputs that were last reported.
    told: Option<O>,
}

impl<'a, O: ReplayedOutputs> Replay<'a, O> {
    /// A replay with all pins low and with these pulse widths.
    pub fn new(pins: &[PinTiming], observer: &'a mut (dyn FnMut(u64, &O) + '_)) -> Self {
        let mut step_high = [0; MAX_AXES];
        step_high
            .iter_mut()
            .zip(pins)
            .for_each(|(step_high, pins)| *step_high = pins.step_high.into());
        Self {
            observer,
            step_high,
            falls: [NEVER; MAX_AXES],
            first_fall: NEVER,
            at: 0,
            now: O::default(),
            told: None,
        }
    }

    /// Reports everything before this cycle, which is now known completely.
    pub fn reach(&mut self, cycle: u64) {
        while self.first_fall <= cycle {
            self.settle(self.first_fall);
            for (axis, fall) in
                self.falls.iter_mut().enumerate().filter(|(_, fall)| **fall == self.at)
            {
                *self.now.pins().0 &= !(1 << axis);
                *fall = NEVER;
            }
            self.first_fall = self.falls.into_iter().min().unwrap_or(NEVER);
        }
        self.settle(cycle);
    }

    fn settle(&mut self, cycle: u64) {
        if cycle > self.at {
            if self.told != Some(self.now) {
                (self.observer)(self.at, &self.now);
                self.told = Some(self.now);
            }
            self.at = cycle;
        }
    }
}

impl<O: ReplayedOutputs> Edges for Replay<'_, O> {
    fn levels(&mut self, clock: u64, levels: u8) {
        self.reach(clock);
        self.now.switch(levels);
    }

    fn edge(&mut self, edge: Edge) {
        self.reach(edge.clock);
        let axis = usize::from(edge.axis);
        match edge.change {
            Change::DirChange => *self.now.pins().1 ^= 1 << axis,
            Change::Rise => {
                *self.now.pins().0 |= 1 << axis;
                self.now.count(axis, edge.backward);
                self.falls[axis] = edge.clock + self.step_high[axis];
                self.first_fall = self.first_fall.min(self.falls[axis]);
            }
        }
    }
}

impl<O: ReplayedOutputs> Listener<O> for Replay<'_, O> {
    fn outputs(&mut self, cycle: u64, outputs: &O) {
        self.reach(cycle);
        self.now = *outputs;
    }
}

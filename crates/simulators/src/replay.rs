//! Reconstructs from edges the outputs of every cycle in which any of them changed.

use crate::listener::Listener;
use carrystep_core::PinTiming;
use carrystep_core::engine::{EngineOutputs, MAX_AXES, PWM_STEPS};
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
    /// The level of the PWM's pin; it is there to be changed only where there is one.
    fn pwm(&mut self) -> Option<&mut bool> {
        None
    }
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

    fn pwm(&mut self) -> Option<&mut bool> {
        Some(&mut self.pwm)
    }
}

/// The pin of a PWM, which follows from the duty.
#[derive(Debug, Clone, Copy)]
struct Pwm {
    /// Clocks of a period.
    period: u64,
    /// Clocks of each step of the duty.
    divider: u64,
    duty: u16,
    /// Cycle of the next change of the pin.
    next: u64,
}

impl Pwm {
    /// Finds the next change of a pin that has a level in this cycle. In the cycle after cycle c, it
    /// is high if c is in the first part of a period: as many steps as the duty.
    fn follow(&mut self, cycle: u64, level: bool) {
        let (place, high) = (cycle % self.period, u64::from(self.duty) * self.divider);
        self.next = match (level, place < high) {
            (true, false) | (false, true) => cycle + 1,
            (true, true) => cycle + 1 + high - place,
            (false, false) if high > 0 => cycle + 1 + self.period - place,
            (false, false) => NEVER,
        };
    }
}

/// Calls an observer for the cycles for which the clock-by-clock model would call it.
pub struct Replay<'a, O> {
    observer: &'a mut (dyn FnMut(u64, &O) + 'a),
    step_high: [u64; MAX_AXES],
    /// Cycle of the next falling edge of each STEP.
    falls: [u64; MAX_AXES],
    first_fall: u64,
    pwm: Option<Pwm>,
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
            pwm: None,
            at: 0,
            now: O::default(),
            told: None,
        }
    }

    /// The same with a PWM whose counter has begun in cycle 0; `divider` is the number of clocks of
    /// each step of its duty, 0 if there is none.
    #[must_use]
    pub fn with_pwm(self, divider: u32) -> Self {
        let pwm = Pwm {
            period: u64::from(PWM_STEPS) * u64::from(divider),
            divider: divider.into(),
            duty: 0,
            next: NEVER,
        };
        Self { pwm: (divider > 0).then_some(pwm), ..self }
    }

    /// Reports everything before this cycle, which is now known completely.
    pub fn reach(&mut self, cycle: u64) {
        loop {
            let turns = self.pwm.map_or(NEVER, |pwm| pwm.next);
            let next = self.first_fall.min(turns);
            if next > cycle || next == NEVER {
                break;
            }
            self.settle(next);
            if turns == next
                && let (Some(pwm), Some(level)) = (&mut self.pwm, self.now.pwm())
            {
                *level = !*level;
                pwm.follow(next, *level);
            }
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

    fn duty(&mut self, clock: u64, duty: u16, level: bool) {
        self.reach(clock);
        if let (Some(pwm), Some(now)) = (&mut self.pwm, self.now.pwm()) {
            (pwm.duty, *now) = (duty, level);
            pwm.follow(clock, level);
        }
    }

    fn pwm(&mut self, clock: u64, level: bool) {
        self.reach(clock);
        self.now.pwm().into_iter().for_each(|now| *now = level);
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

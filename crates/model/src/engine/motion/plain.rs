//! Access for the fast model: computes how many clocks of the engine can be skipped because every
//! axis only repeats its additions, and advances the counters that run during that time.
//!
//! All other events (an accepted word, a load, the call of a stop, a change of a debounced limit,
//! an axis that comes to rest) are executed by [`Motion::clock`]. Every condition here must be
//! conservative: a skipped clock must have no other effect.

use super::axis_model::{AxisModel, Limit};
use super::guard::Stop;
use super::limits::SAMPLE_BEAT;
use super::{Motion, bits};
use crate::parts::cubic::Cubic;
use crate::parts::moving::Moving;
use carrystep_core::engine::{EngineInputs, LimitWiring, PUT_BEAT, QUEUE, TIME_SLOT_CLOCKS};

impl Motion {
    /// Number of clocks in a tick.
    pub(crate) fn clocks_per_tick(&self) -> u32 {
        self.build.timebase.clocks_per_tick()
    }

    /// The build parameters.
    pub fn build(&self) -> &carrystep_core::EngineBuild {
        &self.build
    }

    /// Number of the clock in the tick, from 0.
    pub(crate) fn clock_of_tick(&self) -> u32 {
        self.clock
    }

    /// The number of cycles, at most `most`, in which these inputs change nothing and every strobe
    /// only adds.
    pub(crate) fn plain_clocks(&self, inputs: &EngineInputs, most: u64) -> u64 {
        if !self.is_steady(inputs) {
            return 0;
        }
        let per_tick = u64::from(self.clocks_per_tick());
        let to_strobe = per_tick - 1 - u64::from(self.clock);
        let mut strobes = self.plain_strobes(inputs);
        if self.axis_models.iter().any(|axis_model| axis_model.homing.waits) {
            // The engine finds the limit in the axis' time slot, which is before the strobe.
            let Some(before) = strobes.checked_sub(1) else { return 0 };
            strobes = before;
        }
        let to_event = strobes.saturating_mul(per_tick).saturating_add(to_strobe);
        most.min(to_event).min(self.clocks_to_put(inputs))
    }

    /// True if nothing happens before the next strobe except on the pins.
    fn is_steady(&self, inputs: &EngineInputs) -> bool {
        let (guard, stop, fault) = (&self.build.guard, &self.stop, self.stop.fault.is_some());
        let busy = self.pins_busy();
        let idle = self.rest == 2 && self.armed.is_none() && !busy;
        let nobody = inputs.put.is_some_and(|put| usize::from(put.axis) >= self.axis_models.len());
        self.time_slots
            && !(inputs.reset || self.reset.ending || self.misplaced)
            && (fault || !(inputs.stop || inputs.broken || nobody))
            && inputs.home.is_none()
            && !self.axis_models.iter().any(|axis_model| axis_model.homing.meets || axis_model.homing.slows)
            && !(fault && self.armed.is_some())
            // `idle` would become true at the end of the last pulse.
            && !(self.rest == 2 && busy)
            && self.supervisor.is_steady(guard, inputs, idle, stop)
            && self.axis_models.iter().all(|axis_model| !axis_model.shaper.overrun && (!stop.frozen || axis_model.is_still(true)))
    }

    /// Clocks before the clock in which the offered word is accepted.
    fn clocks_to_put(&self, inputs: &EngineInputs) -> u64 {
        let Some(put) = inputs.put.filter(|_| self.stop.fault.is_none()) else { return u64::MAX };
        if self.axis_models[usize::from(put.axis)].queue.len() >= QUEUE {
            return u64::MAX;
        }
        let (beat, per_tick) =
            (u32::from(put.axis) * TIME_SLOT_CLOCKS + PUT_BEAT, self.clocks_per_tick());
        ((beat + per_tick - self.clock) % per_tick).into()
    }

    /// Strobes before the first strobe that does more than add.
    fn plain_strobes(&self, inputs: &EngineInputs) -> u64 {
        let (guard, stop, fault) = (&self.build.guard, &self.stop, self.stop.fault.is_some());
        let running = bits(&self.axis_models, |axis_model| axis_model.running.is_some());
        let waiting = bits(&self.axis_models, |axis_model| !axis_model.queue.is_empty());
        let ran = running != 0 && !stop.halted;
        let halted = stop.frozen || (stop.ramp && !ran);
        let goes_on =
            Stop { ramp: fault, halted, settled: stop.halted, clearing: false, ..*stop } == *stop;
        let clears = inputs.clear && stop.settled && !self.supervisor.pressed();
        let starts = self.armed.is_some_and(|mask| mask & !waiting != 0 || mask & running == 0);
        let rests = if ran || waiting != 0 { 0 } else { 2 };
        if !goes_on || clears || starts || self.rest != rests {
            return 0;
        }
        let mut strobes = self.strobes_to_sample(inputs);
        if !fault && self.rest < 2 && !inputs.kick {
            strobes = strobes.min(self.supervisor.strobes_to_silence(guard));
        }
        if !fault
            && self.armed.is_none()
            && inputs.start.is_some()
            && inputs.enable
            && self.supervisor.enabled
        {
            strobes = strobes.min(self.supervisor.strobes_to_warmth(guard));
        }
        self.axis_models
            .iter()
            .map(|axis_model| axis_model.plain_strobes(stop.ramp))
            .fold(strobes, u64::min)
    }

    /// Strobes before the first sample of a limit that does more than count.
    fn strobes_to_sample(&self, inputs: &EngineInputs) -> u64 {
        let guard = &self.build.guard;
        let stopped = self.stop.fault.is_some() && !guard.limit_freezes;
        let mut strobes = u64::MAX;
        for (axis, axis_model) in self.axis_models.iter().enumerate() {
            let seen_now = self.pin(inputs, axis, self.supervisor.tick_of_round);
            if self.clock > sample_clock(axis) && self.pins[axis] != seen_now {
                return 0;
            }
            for end in self.samples() {
                let limit = axis_model.limits[end as usize];
                let first = self.supervisor.strobes_to_sample(guard, end);
                // An active limit stops an axis that moves toward it.
                let counts = !stopped || axis_model.homing.waits;
                let hits = guard.limits == LimitWiring::Pair
                    && limit.active
                    && axis_model.running.is_some()
                    && counts;
                let samples = if hits {
                    0
                } else {
                    limit.plain_samples(self.pin(inputs, axis, end), guard.debounce)
                };
                strobes =
                    strobes.min(samples.saturating_mul(guard.round.into()).saturating_add(first));
            }
        }
        strobes
    }

    /// The ticks of a round in which limits are sampled: 0 for `limit_min`, 1 for `limit_max`.
    fn samples(&self) -> std::ops::Range<u32> {
        0..if self.build.guard.limits == LimitWiring::Pair { 2 } else { 1 }
    }

    /// Advances everything but the axes by this many clocks.
    pub(crate) fn pass(&mut self, inputs: &EngineInputs, clocks: u64) {
        let per_tick = u64::from(self.clocks_per_tick());
        let (begin, round) = (u64::from(self.clock), u64::from(self.build.guard.round));
        let end = begin + clocks;
        let strobes = end / per_tick;
        for axis in 0..self.axis_models.len() {
            for sample in self.samples() {
                let first = self.supervisor.strobes_to_sample(&self.build.guard, sample);
                let samples = strobes.saturating_sub(first).div_ceil(round);
                let pin = self.pin(inputs, axis, sample);
                self.axis_models[axis].limits[sample as usize].pass(pin, samples);
            }
            let at = u64::from(sample_clock(axis));
            let seen = end.checked_sub(at + 1).map(|since| since / per_tick);
            if let Some(tick) = seen.filter(|tick| tick * per_tick + at >= begin) {
                let tick_of_round =
                    ((u64::from(self.supervisor.tick_of_round) + tick) % round) as u32;
                self.pins[axis] = self.pin(inputs, axis, tick_of_round);
            }
        }
        self.supervisor.pass(&self.build.guard, inputs.kick, strobes);
        self.clock = (end % per_tick) as u32;
    }

    /// True if no axis moves and no timer runs.
    pub(crate) fn is_still(&self) -> bool {
        self.axis_models.iter().all(|axis_model| axis_model.is_still(self.stop.frozen))
    }

    /// The parts of the axes that a window changes.
    pub(crate) fn moving(&self) -> impl Iterator<Item = Moving> {
        self.axis_models.iter().map(|axis_model| axis_model.moving(self.stop.ramp))
    }

    /// Writes back the axes as they are after a window with this many strobes.
    pub(crate) fn moved(&mut self, moved: &[Moving], strobes: u32) {
        let ramp = self.stop.ramp;
        self.axis_models
            .iter_mut()
            .zip(moved)
            .for_each(|(axis_model, moved)| axis_model.moved(moved, ramp, strobes));
    }
}

/// The clock of a tick in which an axis samples its limit.
const fn sample_clock(axis: usize) -> u32 {
    axis as u32 * TIME_SLOT_CLOCKS + SAMPLE_BEAT
}

impl AxisModel {
    /// Number of strobes that only add.
    fn plain_strobes(&self, ramp: bool) -> u64 {
        let stop = self.stop.unsigned_abs();
        match (self.running, self.ramp) {
            _ if self.unfit || self.fresh.is_some() => 0,
            (None, None) => u64::MAX,
            (Some(segment), _) if segment.v == i64::MIN => 0,
            (Some(segment), None) if !ramp => segment.left.into(),
            // The axis comes to rest in the tick in which V would change its sign.
            (Some(segment), Some(back)) if ramp => {
                (segment.v.unsigned_abs() - u64::from(back)) / stop
            }
            _ => 0,
        }
    }

    /// True if no clock and no strobe changes the axis.
    fn is_still(&self, frozen: bool) -> bool {
        self.running.is_none()
            && [self.computed, self.emitted].iter().all(|stage| stage.is_empty())
            && self.shaper.is_still(frozen)
    }

    fn moving(&self, ramp: bool) -> Moving {
        let cubic = self.running.map_or(Cubic::REST, |segment| match self.ramp {
            Some(back) if ramp => {
                Cubic { v: segment.v, a: if back { self.stop } else { -self.stop }, j: 0 }
            }
            _ => Cubic { v: segment.v, a: segment.a, j: segment.j },
        });
        Moving {
            p: self.p,
            cubic,
            computed: self.computed,
            emitted: self.emitted,
            shaper: self.shaper,
        }
    }

    fn moved(&mut self, moved: &Moving, ramp: bool, strobes: u32) {
        Moving {
            p: self.p,
            cubic: _,
            computed: self.computed,
            emitted: self.emitted,
            shaper: self.shaper,
        } = *moved;
        if let Some(segment) = &mut self.running {
            segment.v = moved.cubic.v;
            segment.left = segment.left.wrapping_sub(strobes);
            if !ramp {
                segment.a = moved.cubic.a;
            }
        }
    }
}

impl Limit {
    /// Samples of a constant level before the one that changes the debounced state.
    fn plain_samples(self, pin: bool, debounce: u32) -> u64 {
        if pin == self.active { u64::MAX } else { (debounce - 1 - self.against).into() }
    }

    /// Takes `samples` samples of the same level, at most [`Limit::plain_samples`].
    fn pass(&mut self, pin: bool, samples: u64) {
        // The number is at most the result of `plain_samples`, which fits.
        let samples = u32::try_from(samples).unwrap_or(u32::MAX);
        match (samples, pin == self.active) {
            (0, _) => {}
            (_, true) => self.against = 0,
            (_, false) => self.against += samples,
        }
    }
}

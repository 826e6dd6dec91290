//! Access for the fast model: computes how many clocks of the engine can be skipped because every
//! axis only repeats its additions, and advances the counters that run during that time.
//!
//! All other events (an accepted word, a load, the call of a stop, a change of a debounced switch,
//! the hit of a seek, an edge of a latch, an axis that comes to rest) are executed by
//! [`Motion::clock`]. Every condition here must be conservative: a skipped clock must have no other
//! effect.

use super::axis_model::AxisModel;
use super::guard::Stop;
use super::latch::arms_a_missing_one;
use super::seek::AxisSeek;
use super::switches::{INTERLOCK_ROW, SAMPLE_BEAT, Switch};
use super::{Motion, bits};
use crate::parts::cubic::Cubic;
use crate::parts::moving::Moving;
use carrystep_core::engine::{EngineInputs, LimitWiring, SWITCH_ROWS};

/// Strobes before the first event, and ticks before the first tick with an event that comes before
/// its strobe.
#[derive(Debug, Clone, Copy)]
struct Plain {
    strobes: u64,
    ticks: u64,
}

impl Plain {
    /// Nothing is plain.
    const NOT: Self = Self { strobes: 0, ticks: 0 };

    const fn and(self, other: Self) -> Self {
        Self {
            strobes: if self.strobes < other.strobes { self.strobes } else { other.strobes },
            ticks: if self.ticks < other.ticks { self.ticks } else { other.ticks },
        }
    }

    /// At the first event at a strobe, `strobes` others are before it.
    const fn to_strobe(strobes: u64) -> Self {
        Self { strobes, ticks: u64::MAX }
    }

    /// The event may come anywhere in its tick.
    const fn to_tick(ticks: u64) -> Self {
        Self { strobes: ticks, ticks }
    }
}

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

    /// Number of the tick in the round, from 0.
    pub(crate) const fn tick_of_round(&self) -> u32 {
        self.supervisor.tick_of_round
    }

    /// The number of cycles, at most `most`, in which these inputs change nothing and every strobe
    /// only adds, but for the words that are taken in them ([`Motion::taking`]).
    pub(crate) fn plain_clocks(&self, inputs: &EngineInputs, most: u64) -> u64 {
        if !self.is_steady(inputs) {
            return 0;
        }
        let per_tick = u64::from(self.clocks_per_tick());
        let to_strobe = per_tick - 1 - u64::from(self.clock);
        let Plain { strobes, ticks } = self.plain(inputs);
        let Some(whole) = ticks.checked_sub(1) else { return 0 };
        let to_tick = whole.saturating_mul(per_tick).saturating_add(to_strobe + 1);
        let to_event = strobes.saturating_mul(per_tick).saturating_add(to_strobe).min(to_tick);
        most.min(to_event)
    }

    /// True if nothing happens before the next strobe except on the pins.
    fn is_steady(&self, inputs: &EngineInputs) -> bool {
        let (guard, stop, fault) = (&self.build.guard, &self.stop, self.stop.fault.is_some());
        let busy = self.pins_busy();
        let idle = self.rest == 2 && self.armed.is_none() && !busy;
        let nobody = inputs.put.is_some_and(|put| usize::from(put.axis) >= self.axis_models.len());
        let breaks = inputs.broken || nobody || arms_a_missing_one(guard, inputs);
        self.time_slots
            && !(inputs.reset || self.reset.ending || self.misplaced || self.stray)
            && !(inputs.cut || self.cut.is_busy())
            && self.outputs_are_steady()
            && (fault || !(inputs.stop || breaks))
            && inputs.seek.is_none()
            && inputs.seek_source.is_none()
            && !self.seek.sweeps
            && self.axis_models.iter().all(|axis_model| axis_model.is_steady(self.seek.released))
            && self.latch.is_steady(guard, inputs)
            && !(fault && self.armed.is_some())
            // `idle` would become true at the end of the last pulse.
            && !(self.rest == 2 && busy)
            && self.supervisor.is_steady(guard, inputs, idle, stop)
            && self.axis_models.iter().all(|axis_model| !axis_model.shaper.overrun && (!stop.frozen || axis_model.is_still(true)))
    }

    /// How long nothing happens but that strobes add and samples count.
    fn plain(&self, inputs: &EngineInputs) -> Plain {
        let (guard, stop, fault) = (&self.build.guard, &self.stop, self.stop.fault.is_some());
        let running = bits(&self.axis_models, |axis_model| axis_model.running.is_some());
        let waiting = bits(&self.axis_models, |axis_model| !axis_model.queue.is_empty());
        let ramps = bits(&self.axis_models, |axis_model| axis_model.seek.ramps);
        let ran = running != 0 && !stop.halted;
        let halted = stop.frozen || (stop.ramp && !ran);
        let goes_on =
            Stop { ramp: fault, halted, settled: stop.halted, clearing: false, ..*stop } == *stop;
        let clears = inputs.clear && stop.settled && !self.supervisor.pressed() && !self.interlock;
        let opens = self.interlock && !fault;
        let starts = self
            .armed
            .is_some_and(|mask| mask & !waiting != 0 || mask & running == 0 || mask & ramps != 0);
        let rests = if ran || waiting != 0 { 0 } else { 2 };
        let is_due = !goes_on || clears || opens || starts || self.rest != rests;
        let mut strobes = if is_due { 0 } else { self.latch.plain_strobes(guard) };
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
            .map(|axis_model| axis_model.plain(stop.ramp))
            .fold(Plain::to_strobe(strobes).and(self.plain_samples(inputs)), Plain::and)
    }

    /// How long all samples of switches only count.
    fn plain_samples(&self, inputs: &EngineInputs) -> Plain {
        let now = self.row();
        let is_resampled = |axis| {
            self.clock > self.build.first_clock_of(axis) + SAMPLE_BEAT
                && now.is_some_and(|row| self.pins[axis] != self.pin(inputs, axis, row))
        };
        if (0..self.axis_models.len()).any(is_resampled) {
            return Plain::NOT;
        }
        let guard = &self.build.guard;
        let seeks = |axis_model: &AxisModel| axis_model.seek.waits || axis_model.seek.slows;
        let seeking = self.axis_models.iter().any(seeks);
        let mut plain = Plain::to_strobe(u64::MAX);
        for row in self.rows() {
            let first = self.supervisor.strobes_to_sample(guard, row.into());
            for axis in 0..self.axis_models.len() {
                let samples = self.plain_samples_of(inputs, axis, row);
                let ticks = samples.saturating_mul(guard.round.into()).saturating_add(first);
                let opens = guard.has_interlock() && row == INTERLOCK_ROW && axis == 0;
                let within = seeking || opens;
                plain =
                    plain.and(if within { Plain::to_tick(ticks) } else { Plain::to_strobe(ticks) });
            }
        }
        plain
    }

    /// Samples of a switch before the first one that does more than count.
    fn plain_samples_of(&self, inputs: &EngineInputs, axis: usize, row: u8) -> u64 {
        let (guard, axis_model) = (&self.build.guard, &self.axis_models[axis]);
        let switch = axis_model.switches[usize::from(row)];
        let seeks = axis_model.seek.waits || axis_model.seek.slows;
        let stopped = self.stop.fault.is_some() && !guard.limit_freezes;
        // An active limit stops an axis that moves toward it.
        let stops = guard.limits == LimitWiring::Pair
            && row < 2
            && switch.active
            && axis_model.running.is_some()
            && (!stopped || seeks);
        let hits = switch.active == self.seek.source.level && self.is_awaited(axis, row);
        if stops || hits {
            0
        } else {
            switch.plain_samples(self.pin(inputs, axis, row), guard.debounce)
        }
    }

    /// Advances everything but the axes by this many clocks.
    pub(crate) fn pass(&mut self, inputs: &EngineInputs, clocks: u64) {
        let per_tick = u64::from(self.clocks_per_tick());
        let (begin, round) = (u64::from(self.clock), u64::from(self.build.guard.round));
        let end = begin + clocks;
        let strobes = end / per_tick;
        for axis in 0..self.axis_models.len() {
            for row in 0..SWITCH_ROWS {
                if !self.is_sampled(row) {
                    continue;
                }
                let first = self.supervisor.strobes_to_sample(&self.build.guard, row.into());
                let samples = strobes.saturating_sub(first).div_ceil(round);
                let pin = self.pin(inputs, axis, row);
                self.axis_models[axis].switches[usize::from(row)].pass(pin, samples);
            }
            let at = u64::from(self.build.first_clock_of(axis) + SAMPLE_BEAT);
            let seen = end.checked_sub(at + 1).map(|since| since / per_tick);
            if let Some(tick) = seen.filter(|tick| tick * per_tick + at >= begin) {
                let tick_of_round =
                    ((u64::from(self.supervisor.tick_of_round) + tick) % round) as u32;
                let row = self.row_in(tick_of_round);
                self.pins[axis] = row.is_some_and(|row| self.pin(inputs, axis, row));
            }
        }
        self.supervisor.pass(&self.build.guard, inputs.kick, strobes);
        self.latch.pass(strobes);
        self.pass_outputs(clocks);
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

impl AxisModel {
    /// True if nothing that the seek of the axis does is due in this tick, but for hits.
    fn is_steady(&self, released: bool) -> bool {
        let AxisSeek { slows, ramps, hits, is_excused, .. } = self.seek;
        let ends = slows && self.running.is_none() && (released || !self.queue.is_empty());
        slows == ramps && !(hits || is_excused || ends)
    }

    /// How long strobes only add; `ramp` is that of all axes.
    fn plain(&self, ramp: bool) -> Plain {
        let strobes = self.plain_strobes(self.is_in_ramp(ramp));
        // The end of a ramp of its own can end the seek, before the strobe.
        if self.seek.ramps { Plain::to_tick(strobes) } else { Plain::to_strobe(strobes) }
    }

    /// Number of strobes that only add.
    fn plain_strobes(&self, ramp: bool) -> u64 {
        let stop = self.stop.unsigned_abs();
        match (self.running, self.ramp) {
            _ if self.unfit || self.fresh.is_some() || self.begun.is_some() => 0,
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
        let ramp = self.is_in_ramp(ramp);
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
        let ramp = self.is_in_ramp(ramp);
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

impl Switch {
    /// Samples of a constant level before the one that changes the debounced state.
    fn plain_samples(self, pin: bool, debounce: u32) -> u64 {
        if pin == self.active { u64::MAX } else { (debounce - 1 - self.against).into() }
    }

    /// Takes `samples` samples of the same level, at most [`Switch::plain_samples`].
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

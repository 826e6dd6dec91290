//! All moves of one axis in sequence, and the time at which each pulse is due.

use crate::profile::SharedProfile;
use carrystep_core::StartPhase;

/// The float reference of one axis over all moves.
#[derive(Debug, Clone)]
pub struct Timeline {
    tick_seconds: f64,
    legs: Vec<Leg>,
    /// The position at which each leg begins, steps.
    begins: Vec<i64>,
}

/// One move of one axis.
#[derive(Debug, Clone)]
pub struct Leg {
    /// The tick, counted from 0, at whose beginning the profile starts.
    pub start_tick: u64,
    /// Whether the axis travels backward.
    pub backward: bool,
    /// Number of whole steps travelled.
    pub steps: u64,
    /// The profile of the move, in the direction of travel.
    pub profile: SharedProfile,
    /// Tolerance of a fitted profile: how far an edge may be from the profile, seconds. It is 0 if
    /// the profile is followed exactly.
    pub fit_seconds: f64,
}

/// The moment at which a pulse is due.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// First tick of the leg, counted from 0.
    pub start_tick: u64,
    /// Seconds from the beginning of that tick.
    pub seconds: f64,
    /// Whether the pulse is a step backward.
    pub backward: bool,
    /// Speed at that moment, steps/s, 0 or more.
    pub speed: f64,
    /// Acceleration in the direction of travel, steps/s^2.
    pub acceleration: f64,
}

impl Leg {
    /// The moment at which pulse `k` (1..=steps) is due.
    pub fn crossing(&self, phase: StartPhase, k: u64) -> Crossing {
        let x = phase.pulse_half_steps(k, self.backward) as f64 / 2.0;
        let [seconds, speed, acceleration] = self.profile.passing(x);
        Crossing {
            start_tick: self.start_tick,
            seconds,
            backward: self.backward,
            speed,
            acceleration,
        }
    }

    fn sign(&self) -> f64 {
        if self.backward { -1.0 } else { 1.0 }
    }
}

impl Timeline {
    /// Puts legs in sequence. `tick_seconds` is the length of a tick in seconds. The legs are the
    /// moves in which the axis travels, in order; they must not overlap.
    pub fn new(tick_seconds: f64, legs: Vec<Leg>) -> Self {
        let mut position = 0_i64;
        let begin = |leg: &Leg| {
            let here = position;
            let steps = leg.steps.cast_signed();
            position = here.wrapping_add(if leg.backward { -steps } else { steps });
            here
        };
        let begins = legs.iter().map(begin).collect();
        Self { tick_seconds, legs, begins }
    }

    /// The moves in which the axis travels, in order.
    pub fn legs(&self) -> &[Leg] {
        &self.legs
    }

    /// All pulses in order.
    pub fn crossings(&self, phase: StartPhase) -> impl Iterator<Item = Crossing> + '_ {
        self.legs.iter().flat_map(move |leg| (1..=leg.steps).map(move |k| leg.crossing(phase, k)))
    }

    /// Goes through the moves in order of time.
    pub fn walk(&self) -> Walk<'_> {
        Walk { timeline: self, begun: 0 }
    }

    /// Signed speed in steps/s, `tick` ticks after the origin; 0 between moves.
    pub fn speed_at(&self, tick: f64) -> f64 {
        self.moving(tick).map_or(0.0, |(leg, t)| leg.sign() * leg.profile.speed(t))
    }

    /// Signed acceleration in steps/s^2, `tick` ticks after the origin; 0 between moves.
    pub fn acceleration_at(&self, tick: f64) -> f64 {
        self.moving(tick).map_or(0.0, |(leg, t)| leg.sign() * leg.profile.acceleration(t))
    }

    fn moving(&self, tick: f64) -> Option<(&Leg, f64)> {
        let after = self.legs.partition_point(|leg| leg.start_tick as f64 <= tick);
        let leg = self.legs.get(after.checked_sub(1)?)?;
        let t = self.local(leg, tick);
        (t < leg.profile.duration()).then_some((leg, t))
    }

    fn local(&self, leg: &Leg, tick: f64) -> f64 {
        ((tick - leg.start_tick as f64) * self.tick_seconds).min(leg.profile.duration())
    }
}

/// Goes through the moves of one axis in order of time.
#[derive(Debug, Clone)]
pub struct Walk<'a> {
    timeline: &'a Timeline,
    /// The number of legs that have begun.
    begun: usize,
}

impl Walk<'_> {
    /// Signed position in steps and signed speed in steps/s, `tick` ticks (not necessarily whole)
    /// after the origin. Between moves the speed is 0. Ticks must not decrease from call to call.
    pub fn at(&mut self, tick: f64) -> (f64, f64) {
        let Timeline { legs, begins, .. } = self.timeline;
        while legs.get(self.begun).is_some_and(|leg| leg.start_tick as f64 <= tick) {
            self.begun += 1;
        }
        let Some(last) = self.begun.checked_sub(1) else { return (0.0, 0.0) };
        let (leg, begin) = (&legs[last], begins[last]);
        let t = self.timeline.local(leg, tick);
        let position = begin as f64 + leg.sign() * leg.profile.position(t);
        let moves = t < leg.profile.duration();
        (position, if moves { leg.sign() * leg.profile.speed(t) } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Constant;
    use std::sync::Arc;

    /// Ten legs of 1 to 10 steps, each 100 ticks of 10 us long and 50 ticks behind the one before.
    fn legs() -> Vec<Leg> {
        let leg = |i: u64| Leg {
            start_tick: 150 * i,
            backward: i % 3 == 1,
            steps: i + 1,
            profile: Arc::new(Constant::new((i + 1) as f64, 1e-3)),
            fit_seconds: 0.0,
        };
        (0..10).map(leg).collect()
    }

    #[test]
    fn a_position_is_the_sum_of_what_all_legs_have_travelled() {
        let timeline = Timeline::new(1e-5, legs());
        let mut walk = timeline.walk();
        for tick in (-20..1700).map(|tick| f64::from(tick) + 0.25) {
            let travelled = |leg: &Leg| {
                let seconds = (tick - leg.start_tick as f64).clamp(0.0, 100.0) * 1e-5;
                leg.sign() * leg.profile.position(seconds)
            };
            let sum: f64 = legs().iter().map(travelled).sum();
            let (found, speed) = walk.at(tick);
            assert_eq!(speed, timeline.speed_at(tick), "tick {tick}");
            assert!((found - sum).abs() < 1e-9, "tick {tick}: {found} is not {sum}");
        }
        assert_eq!(Timeline::new(1e-5, Vec::new()).walk().at(7.0), (0.0, 0.0));
    }
}

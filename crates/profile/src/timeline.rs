//! All moves of one axis in sequence, and the time at which each pulse is due.
//!
//! The moves may still be planned while a timeline is read: its readers ask for as many of them as
//! they need.

use crate::growing::Reader;
use crate::profile::SharedProfile;
use carrystep_core::StartPhase;

/// The float reference of one axis over all moves in which it travels.
#[derive(Debug, Clone)]
pub struct Timeline {
    tick_seconds: f64,
    legs: Reader<Leg>,
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

/// What an axis does in all its moves together.
#[derive(Debug, Clone, Default)]
pub struct Travel {
    /// Number of pulses.
    pub pulses: u64,
    /// Steps forward minus steps backward.
    pub position: i64,
    /// The greatest tolerance of a fitted profile, seconds.
    pub fit_seconds: f64,
    /// The first move in which the axis travels.
    pub first: Option<Leg>,
}

impl Travel {
    /// Adds the next move in which the axis travels.
    pub fn add(&mut self, leg: &Leg) {
        self.pulses += leg.steps;
        self.position += leg.forward();
        self.fit_seconds = self.fit_seconds.max(leg.fit_seconds);
        if self.first.is_none() {
            self.first = Some(leg.clone());
        }
    }
}

impl FromIterator<Leg> for Travel {
    fn from_iter<I: IntoIterator<Item = Leg>>(legs: I) -> Self {
        let mut travel = Self::default();
        legs.into_iter().for_each(|leg| travel.add(&leg));
        travel
    }
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

    /// The steps forward; negative if the axis travels backward.
    pub fn forward(&self) -> i64 {
        let steps = self.steps.cast_signed();
        if self.backward { -steps } else { steps }
    }

    /// Signed speed in steps/s, `seconds` after the start of the leg.
    pub fn speed(&self, seconds: f64) -> f64 {
        self.sign() * self.profile.speed(seconds)
    }

    fn sign(&self) -> f64 {
        if self.backward { -1.0 } else { 1.0 }
    }
}

impl Timeline {
    /// Puts legs in sequence. `tick_seconds` is the length of a tick in seconds. The legs are the
    /// moves in which the axis travels, in order; they must not overlap.
    pub fn new(tick_seconds: f64, legs: impl Into<Reader<Leg>>) -> Self {
        Self { tick_seconds, legs: legs.into() }
    }

    /// The moves in which the axis travels, in order.
    pub fn legs(&self) -> Reader<Leg> {
        self.legs.clone()
    }

    /// All pulses in order.
    pub fn crossings(&self, phase: StartPhase) -> impl Iterator<Item = Crossing> + use<> {
        self.legs().flat_map(move |leg| (1..=leg.steps).map(move |k| leg.crossing(phase, k)))
    }

    /// Goes through the moves in order of time.
    pub fn walk(&self) -> Walk {
        Walk { tick_seconds: self.tick_seconds, legs: self.legs(), next: None, now: None, end: 0 }
    }
}

/// Goes through the moves of one axis in order of time.
#[derive(Debug, Clone)]
pub struct Walk {
    tick_seconds: f64,
    legs: Reader<Leg>,
    /// The first leg that has not begun, if it is known.
    next: Option<Leg>,
    /// The last leg that has begun, and the position at which it begins, steps.
    now: Option<(Leg, i64)>,
    /// The position at the end of that leg, steps.
    end: i64,
}

impl Walk {
    /// Signed position in steps and signed speed in steps/s, `tick` ticks (not necessarily whole)
    /// after the origin. Between moves the speed is 0. Ticks must not decrease from call to call.
    pub fn at(&mut self, tick: f64) -> (f64, f64) {
        self.go_to(tick);
        let Some((leg, begin)) = &self.now else { return (0.0, 0.0) };
        let duration = leg.profile.duration();
        let t = ((tick - leg.start_tick as f64) * self.tick_seconds).min(duration);
        let position = *begin as f64 + leg.sign() * leg.profile.position(t);
        (position, if t < duration { leg.speed(t) } else { 0.0 })
    }

    /// Goes on to the move of `tick`. Ticks must not decrease from call to call.
    pub fn go_to(&mut self, tick: f64) {
        loop {
            // The cast saturates: before the origin no leg has begun.
            self.next = self.next.take().or_else(|| self.legs.next_by(tick as u64));
            let Some(leg) = self.next.take_if(|leg| leg.start_tick as f64 <= tick) else { break };
            let begin = self.end;
            self.end = begin.wrapping_add(leg.forward());
            self.now = Some((leg, begin));
        }
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
            let speeds = legs().into_iter().map(|leg| {
                let local = (tick - leg.start_tick as f64) * 1e-5;
                let travels = (0.0..leg.profile.duration()).contains(&local);
                if travels { leg.speed(local) } else { 0.0 }
            });
            let (found, speed) = walk.at(tick);
            assert_eq!(speed, speeds.sum::<f64>(), "tick {tick}");
            assert!((found - sum).abs() < 1e-9, "tick {tick}: {found} is not {sum}");
        }
        assert_eq!(Timeline::new(1e-5, Vec::new()).walk().at(7.0), (0.0, 0.0));
    }
}

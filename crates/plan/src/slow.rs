//! Pulses so slow that the gateware's 32-bit bisection shows, and what the planner does about them.
//!
//! The bisection sees the top 32 bits of P and V (design section 1, "edge phase"). Each of its additions loses a part of
//! 2^-32 step, which takes 2^-32 step / v at a speed v: 0.2 ns at one step a second, 23 ns at a hundredth of it.
//! What is lost makes P smaller: forward, an edge then comes late; backward, it comes early.
//!
//! - Under [`LEAST`], each pulse is placed by a tick of its own (`placed.rs`).
//! - Backward and under a step a second, the axis is behind its profile by as much as may be lost.

use crate::demand::{Clock, float};
use crate::error::Broken;
use crate::run::MOST_SEGMENTS;
use carrystep_core::fixed::ONE_STEP;
use carrystep_core::{StartPhase, Timebase};
use carrystep_profile::{Profile, Real};

/// One unit of what the bisection sees, 2^-64 step.
pub(crate) const SEEN: i128 = 1 << 32;

/// Speed from which on the bisection may place a pulse, in [`SEEN`] times phases per tick: what it loses is then at
/// most 5/8 of a phase.
const LEAST: u32 = 8;

/// How early the bisection may place an edge, seconds: its part of 2 ns, of which A, J and V have 0.5 ns.
const EARLY: f64 = 1.2e-9;

/// The pulses of one axis in one move, as the bisection sees them.
#[derive(Debug)]
pub(crate) struct Pulses<'a, F> {
    pub profile: &'a dyn Profile<F>,
    pub clock: Clock<F>,
    pub phase: StartPhase,
    pub backward: bool,
    /// Pulses of the whole move.
    pub count: u64,
    /// Phases of a tick.
    pub phases: u32,
    /// Units that the rest before the motion has travelled already.
    pub borrowed: i128,
}

/// What a slow move needs; for an ordinary one, nothing.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Care<F> {
    /// Parts of the way, in steps, in which each pulse is placed by a tick of its own.
    pub by_pulse: Vec<[F; 2]>,
    /// Where the axis is behind its profile, in steps, and by how many units.
    pub behind: Option<([F; 2], i128)>,
}

/// Units of [`SEEN`] that the bisection loses at most: one of P, one of V, and up to one for each halving of V but the
/// first.
fn lost(phases: u32) -> u32 {
    phases.ilog2() + 1
}

/// Steps/s under which pulses are placed one by one.
pub(crate) fn least_speed(timebase: &Timebase) -> f64 {
    f64::from(LEAST * timebase.phases()) * 2_f64.powi(-32) / timebase.tick_seconds()
}

impl<F: Real> Pulses<'_, F> {
    /// What these pulses need.
    ///
    /// # Errors
    /// [`Broken::Segments`]: too many are slow.
    pub fn care(&self) -> Result<Care<F>, Broken> {
        let mut care = Care { by_pulse: Vec::new(), behind: None };
        // At phase zero the first or the last pulse is where the move starts or ends. There P is exact, and so is the edge.
        let (first, last) = match (self.phase, self.backward) {
            (StartPhase::Half, _) => (1, self.count),
            (StartPhase::Zero, false) => (1, self.count - 1),
            (StartPhase::Zero, true) => (2, self.count),
        };
        if self.phases == 1 || first > last {
            return Ok(care);
        }
        // The speed of a move rises, and then falls.
        let quarter = float::<F>(4).recip();
        let (begin, end) = (quarter, self.profile.distance() - quarter);
        let slow = |pulses: &mut dyn Iterator<Item = u64>| {
            let slow = pulses.take(MOST_SEGMENTS).take_while(|&k| self.speed(k) < self.least()).count();
            if slow < MOST_SEGMENTS { Ok(slow as u64) } else { Err(Broken::Segments) }
        };
        let lead = slow(&mut (first..=last))?;
        if lead > last - first {
            care.by_pulse.push([begin, end]);
            return Ok(care);
        }
        let trail = slow(&mut (first..=last).rev())?;
        let (next, before) = (first + lead, last - trail);
        let half = float::<F>(2).recip();
        let inner = [
            if lead == 0 { begin } else { self.place(next) - half },
            if trail == 0 { end } else { self.place(before) + half },
        ];
        if lead > 0 {
            care.by_pulse.push([begin, inner[0]]);
        }
        if trail > 0 {
            care.by_pulse.push([inner[1], end]);
        }
        let lost = lost(self.phases);
        let early = f64::from(lost) * 2_f64.powi(-32) * wide(self.clock.tick) / EARLY;
        if self.backward && [next, before].into_iter().any(|k| self.speed(k) < early) {
            care.behind = Some((inner, i128::from(lost) * SEEN));
        }
        Ok(care)
    }

    /// Pulses that are due in a part of the move, from where it begins, exclusive, to where it ends, 2^-64 step.
    pub fn due_between(&self, from: i128, to: i128) -> impl Iterator<Item = u64> + use<'_, F> {
        let first = u64::try_from(from / ONE_STEP).unwrap_or(0).max(1);
        (first..=self.count).skip_while(move |&k| self.due(k) <= from).take_while(move |&k| self.due(k) <= to)
    }

    /// How far the motion is from its start when a pulse is due: to carry, P has to reach a whole step, to borrow, to
    /// fall below it.
    pub fn due(&self, k: u64) -> i128 {
        i128::from(self.phase.pulse_half_steps(k, self.backward)) * (ONE_STEP / 2) + i128::from(self.backward)
            - self.borrowed
    }

    /// The phase, counted from the start of the move, in which a pulse is due, and the speed there, units per tick.
    pub fn phase_of(&self, k: u64) -> Option<(i128, i128)> {
        let t = self.profile.crossing(self.place(k)) / self.clock.tick;
        let phase = (t * float(self.phases.into())).floor().to_i128()?;
        Some((phase, (self.speed(k) * 2_f64.powi(64)) as i128))
    }

    /// Where a pulse is due, steps.
    fn place(&self, k: u64) -> F {
        F::from(self.phase.pulse_half_steps(k, self.backward) as f64 / 2.0).unwrap_or_else(F::nan)
    }

    /// [`LEAST`] in steps per tick.
    fn least(&self) -> f64 {
        f64::from(LEAST * self.phases) * 2_f64.powi(-32)
    }

    /// Steps per tick.
    fn speed(&self, k: u64) -> f64 {
        wide(self.profile.speed(self.profile.crossing(self.place(k))) * self.clock.tick)
    }
}

fn wide<F: Real>(x: F) -> f64 {
    x.to_f64().unwrap_or(f64::NAN)
}

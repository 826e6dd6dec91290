//! Pulses that are so slow that the gateware's 32-bit bisection becomes visible, and what the
//! planner does about them.
//!
//! The bisection uses the top 32 bits of P and V (docs/clock-by-clock.md, "axis"). Each of its
//! additions loses up to 2^-32 step. At a speed v this takes the time 2^-32 step / v: 0.2 ns at one
//! step a second, 23 ns at a hundredth of a step a second. The loss makes P smaller: a forward edge
//! comes late, and a backward edge comes early. Below [`LEAST`], the step of each pulse therefore
//! gets a tick of its own (`placed.rs`). Backward and below about one step a second, the axis is
//! kept behind its profile by as much as the bisection may lose. The constants follow from this.

use crate::demand::{Clock, float};
use crate::error::Broken;
use crate::limits::MOST_SEGMENTS;
use carrystep_core::fixed::ONE_STEP;
use carrystep_core::{StartPhase, Timebase};
use carrystep_profile::{Profile, Real};

/// The smallest difference that the bisection distinguishes, 2^-32 step, in units of 2^-64 step.
pub(crate) const SEEN: i128 = 1 << 32;

/// The least speed at which the bisection may place a pulse, in units of 2^-32 step times phases
/// per tick. At this speed the bisection loses at most 5/8 of a phase.
const LEAST: u32 = 8;

/// How early the bisection may place an edge, seconds: its share of the promised 2 ns, of which the
/// rounding of A, J and V has 0.5 ns.
const EARLY: f64 = 1.2e-9;

/// The pulses of one axis in one move, as the bisection places them.
#[derive(Debug)]
pub(crate) struct Pulses<'a, F> {
    pub profile: &'a dyn Profile<F>,
    pub clock: Clock<F>,
    pub phase: StartPhase,
    pub backward: bool,
    /// Number of pulses of the whole move.
    pub count: u64,
    /// Number of phases of a tick.
    pub phases: u32,
    /// Units that the rest before the motion has already travelled.
    pub borrowed: i128,
    /// Times at which the first and the last pulse are due, seconds.
    times: [F; 2],
}

/// The special treatment that a slow move needs; both fields are empty for an ordinary move.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Care<F> {
    /// Parts of the way, in steps, in which the step of each pulse gets a tick of its own.
    pub by_pulse: Vec<[F; 2]>,
    /// The part of the way, in steps, in which the axis is kept behind its profile, and by how many
    /// units.
    pub behind: Option<([F; 2], i128)>,
}

/// The greatest loss of a bisection in units of 2^-32 step: one for P, one for V, and up to one for
/// each halving of V except the first.
fn lost(phases: u32) -> u32 {
    phases.ilog2() + 1
}

/// The speed in steps/s below which pulses are placed one by one.
pub(crate) fn least_speed(timebase: &Timebase) -> f64 {
    f64::from(LEAST * timebase.phases()) * 2_f64.powi(-32) / timebase.tick_seconds()
}

impl<'a, F: Real> Pulses<'a, F> {
    /// The pulses of a move of `steps` steps, which are not 0.
    pub fn new(
        profile: &'a dyn Profile<F>,
        clock: &Clock<F>,
        steps: i64,
        (timebase, phase): (&Timebase, StartPhase),
        borrowed: i128,
    ) -> Self {
        let (backward, count) = (steps < 0, steps.unsigned_abs());
        let times = [1, count].map(|k| profile.crossing(place(phase, k, backward)));
        let phases = timebase.phases();
        Self { profile, clock: *clock, phase, backward, count, phases, borrowed, times }
    }

    /// The ticks in which the profile comes to the first and to the last pulse.
    pub fn ticks(&self) -> [u64; 2] {
        self.times.map(|time| (time / self.clock.tick).to_u64().unwrap_or(0))
    }

    /// Determines the special treatment that these pulses need.
    ///
    /// # Errors
    /// [`Broken::Segments`] if 2^17 or more pulses at one end of the move are too slow.
    pub fn care(&self) -> Result<Care<F>, Broken> {
        let mut care = Care { by_pulse: Vec::new(), behind: None };
        // At phase zero, the first or the last pulse is due exactly at the start or the end of the
        // move. P is exact there, and so is the edge.
        let (first, last) = match (self.phase, self.backward) {
            (StartPhase::Half, _) => (1, self.count),
            (StartPhase::Zero, false) => (1, self.count - 1),
            (StartPhase::Zero, true) => (2, self.count),
        };
        if self.phases == 1 || first > last {
            return Ok(care);
        }
        // The speed of a move first rises and then falls, so slow pulses are at its ends only.
        let quarter = float::<F>(4).recip();
        let (begin, end) = (quarter, self.profile.distance() - quarter);
        let slow = |pulses: &mut dyn Iterator<Item = u64>| {
            let slow =
                pulses.take(MOST_SEGMENTS).take_while(|&k| self.speed(k) < self.least()).count();
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

    /// The pulses that are due in a part of the move, after `from` and up to `to`, both in 2^-64
    /// step from the start of the move.
    pub fn due_between(&self, from: i128, to: i128) -> impl Iterator<Item = u64> + use<'_, 'a, F> {
        let first = u64::try_from(from / ONE_STEP).unwrap_or(0).max(1);
        (first..=self.count)
            .skip_while(move |&k| self.due(k) <= from)
            .take_while(move |&k| self.due(k) <= to)
    }

    /// The distance from the start of the motion at which pulse `k` is due, 2^-64 step. Forward, P
    /// has to reach a whole step to carry; backward, P has to fall below it to borrow, which is one
    /// unit more.
    pub fn due(&self, k: u64) -> i128 {
        i128::from(self.phase.pulse_half_steps(k, self.backward)) * (ONE_STEP / 2)
            + i128::from(self.backward)
            - self.borrowed
    }

    /// The phase in which pulse `k` is due, counted from the start of the move, and the speed there
    /// in units per tick. `None` if the phase is not finite.
    pub fn phase_of(&self, k: u64) -> Option<(i128, i128)> {
        let t = self.time(k) / self.clock.tick;
        let phase = (t * float(self.phases.into())).floor().to_i128()?;
        Some((phase, (self.speed(k) * 2_f64.powi(64)) as i128))
    }

    /// The position at which pulse `k` is due, steps.
    fn place(&self, k: u64) -> F {
        place(self.phase, k, self.backward)
    }

    /// The time at which pulse `k` is due, seconds.
    fn time(&self, k: u64) -> F {
        match k {
            1 => self.times[0],
            k if k == self.count => self.times[1],
            k => self.profile.crossing(self.place(k)),
        }
    }

    /// [`LEAST`] in steps per tick.
    fn least(&self) -> f64 {
        f64::from(LEAST * self.phases) * 2_f64.powi(-32)
    }

    /// Speed at pulse `k`, steps per tick.
    fn speed(&self, k: u64) -> f64 {
        wide(self.profile.speed(self.time(k)) * self.clock.tick)
    }
}

/// The position at which pulse `k` is due, steps.
fn place<F: Real>(phase: StartPhase, k: u64, backward: bool) -> F {
    F::from(phase.pulse_half_steps(k, backward) as f64 / 2.0).unwrap_or_else(F::nan)
}

fn wide<F: Real>(x: F) -> f64 {
    x.to_f64().unwrap_or(f64::NAN)
}

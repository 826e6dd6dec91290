//! The ramp of the seven-segment S-curve, with limits on speed, acceleration and jerk.
//!
//! Each ramp has three segments (jerk up, constant acceleration, jerk down); the cruise is the
//! seventh. The formulas are those of L. Biagiotti and C. Melchiorri, "Trajectory Planning for
//! Automatic Machines and Robots" (2008), section 3.4, extended by speed jumps at the ends.

use crate::bad_ramp::{BadRamp, in_range, wide};
use crate::curve::Curve;
use crate::profile::{Profile, Real, real};

/// One acceleration ramp of at most three segments.
///
/// ```text
/// acceleration   __________
///               /:        :\
///              / :        : \
///             <r>:<-hold->:<r>
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScurveRamp<F> {
    start: F,
    end: F,
    jerk: F,
    /// Acceleration between the two jerk segments, steps/s^2; below the limit if that is not
    /// reached.
    peak: F,
    rise: F,
    hold: F,
    duration: F,
    distance: F,
    breakpoints: [F; 2],
}

impl<F: Real> ScurveRamp<F> {
    /// A ramp from `start` to `end` steps/s with at most `acceleration` steps/s^2 and `jerk`
    /// steps/s^3.
    ///
    /// With an infinite jerk the ramp has constant acceleration.
    ///
    /// # Errors
    /// A [`BadRamp`] if a speed is negative or not finite, if a limit is not over 0, if both limits
    /// are infinite, or if `end` is below `start`.
    pub fn new(start: F, end: F, acceleration: F, jerk: F) -> Result<Self, BadRamp> {
        let speed = |name, v: F| {
            in_range(name, v, "finite and not negative", v >= F::zero() && v.is_finite())
        };
        let (start, end) = (speed("the start speed", start)?, speed("the top speed", end)?);
        let acceleration =
            in_range("the acceleration", acceleration, "over 0", acceleration > F::zero())?;
        let finite = jerk.is_finite() || acceleration.is_finite();
        let jerk = in_range(
            "the jerk",
            jerk,
            "over 0, and finite where the acceleration is not",
            jerk > F::zero() && finite,
        )?;
        if end < start {
            return Err(BadRamp::TopUnderStart { start: wide(start), end: wide(end) });
        }
        Ok(Self::steepest(start, end, acceleration, jerk))
    }

    pub(crate) fn steepest(start: F, end: F, acceleration: F, jerk: F) -> Self {
        let gain = end - start;
        let (peak, rise, hold) = if gain <= F::zero() {
            (F::zero(), F::zero(), F::zero())
        } else if gain * jerk >= acceleration * acceleration {
            let rise = acceleration / jerk;
            (acceleration, rise, (gain / acceleration - rise).max(F::zero()))
        } else {
            let rise = (gain / jerk).sqrt();
            (gain / rise, rise, F::zero())
        };
        let duration = rise + rise + hold;
        let distance = (start + gain / real(2.0)) * duration;
        Self {
            start,
            end,
            jerk,
            peak,
            rise,
            hold,
            duration,
            distance,
            breakpoints: [rise, rise + hold],
        }
    }

    /// Duration of each jerk segment, seconds.
    pub fn jerk_time(&self) -> F {
        self.rise
    }

    /// Duration of the constant acceleration, seconds; 0 where the acceleration limit is not
    /// reached.
    pub fn hold_time(&self) -> F {
        self.hold
    }

    /// Speed that a jerk segment adds, steps/s.
    fn bend(&self) -> F {
        self.peak * self.rise / real(2.0)
    }

    /// Distance of the first segment, steps.
    fn lower(&self) -> F {
        self.rise * (self.start + self.peak * self.rise / real(6.0))
    }

    /// Distance of the last segment, steps.
    fn upper(&self) -> F {
        self.rise * (self.end - self.peak * self.rise / real(6.0))
    }

    fn clamped(&self, t: F) -> F {
        t.max(F::zero()).min(self.duration)
    }
}

/// Solves v t + j t^3 / 6 = x for t over 0, with j over 0.
///
/// Newton's method starts above the root. The left side is convex, so that the iterates fall
/// towards the root and stay above it.
fn early_crossing<F: Real>(v: F, j: F, x: F) -> F {
    let (two, six) = (real::<F>(2.0), real::<F>(6.0));
    let by_jerk = (x / j * six).cbrt();
    let start = if v > F::zero() { by_jerk.min(x / v) } else { by_jerk };
    newton(start, |t| (t * (v + j * t * t / six) - x, v + j * t * t / two))
}

/// Finds the smallest t with v t - j t^3 / 6 = y, which counts back from the end of a ramp.
///
/// Newton's method starts below the root. The left side is concave up to the start of the segment,
/// so that the iterates rise towards the root and stay below it.
fn late_crossing<F: Real>(v: F, j: F, y: F) -> F {
    let (two, six) = (real::<F>(2.0), real::<F>(6.0));
    newton(y / v, |t| (t * (v - j * t * t / six) - y, v - j * t * t / two))
}

fn newton<F: Real>(start: F, value_and_slope: impl Fn(F) -> (F, F)) -> F {
    let mut t = start;
    for _ in 0..32 {
        let (value, slope) = value_and_slope(t);
        let next = t - value / slope;
        if (next - t).abs() <= F::epsilon() * t {
            return next;
        }
        t = next;
    }
    t
}

impl<F: Real> Profile<F> for ScurveRamp<F> {
    fn shape(&self) -> &'static str {
        "scurve"
    }

    fn duration(&self) -> F {
        self.duration
    }

    fn distance(&self) -> F {
        self.distance
    }

    fn position(&self, t: F) -> F {
        let (two, six) = (real::<F>(2.0), real::<F>(6.0));
        let t = self.clamped(t);
        let [held, released] = self.breakpoints;
        if t < held {
            t * (self.start + self.jerk * t * t / six)
        } else if t < released {
            let t = t - held;
            self.lower() + t * (self.start + self.bend() + self.peak * t / two)
        } else {
            let left = self.duration - t;
            let bent = if left.is_zero() { left } else { self.jerk * left * left / six };
            self.distance - left * (self.end - bent)
        }
    }

    fn speed(&self, t: F) -> F {
        let two = real::<F>(2.0);
        let t = self.clamped(t);
        let [held, released] = self.breakpoints;
        if t < held {
            self.start + self.jerk * t * t / two
        } else if t < released {
            self.start + self.bend() + self.peak * (t - held)
        } else {
            let left = self.duration - t;
            if left.is_zero() { self.end } else { self.end - self.jerk * left * left / two }
        }
    }

    fn acceleration(&self, t: F) -> F {
        let t = self.clamped(t);
        let [held, released] = self.breakpoints;
        if t < held {
            self.jerk * t
        } else if t < released || self.rise.is_zero() {
            self.peak
        } else {
            (self.jerk * (self.duration - t)).min(self.peak)
        }
    }

    fn jerk(&self, t: F) -> F {
        let t = self.clamped(t);
        let [held, released] = self.breakpoints;
        if t < held {
            self.jerk
        } else if t < released || self.rise.is_zero() {
            F::zero()
        } else {
            -self.jerk
        }
    }

    fn crossing(&self, x: F) -> F {
        let two = real::<F>(2.0);
        let left = self.distance - x;
        if x <= F::zero() {
            return F::zero();
        } else if left <= F::zero() {
            return self.duration;
        }
        let after = x - self.lower();
        if after <= F::zero() {
            early_crossing(self.start, self.jerk, x).min(self.rise)
        } else if left <= self.upper() {
            self.duration - late_crossing(self.end, self.jerk, left).min(self.rise)
        } else {
            let speed = self.start + self.bend();
            self.rise + two * after / (speed + (speed * speed + two * self.peak * after).sqrt())
        }
    }

    fn breakpoints(&self) -> &[F] {
        let [held, released] = self.breakpoints;
        // A jerk segment may be so short that it rounds to the end of a long ramp.
        let inside = |t: F| t > F::zero() && t < self.duration;
        match (inside(held), inside(released) && released > held) {
            (true, true) => &self.breakpoints,
            (true, false) => &self.breakpoints[..1],
            (false, _) => &[],
        }
    }
}

impl<F: Real> Curve<F> for ScurveRamp<F> {
    fn top_speed(&self) -> F {
        self.end
    }

    fn peak_acceleration(&self) -> F {
        self.peak
    }

    fn peak_jerk(&self) -> F {
        if self.rise > F::zero() { self.jerk } else { F::zero() }
    }

    /// 0, unless the jerk is not limited.
    fn acceleration_jump(&self) -> F {
        if self.rise > F::zero() { F::zero() } else { self.peak }
    }
}

//! The sinusoidal S-curve: the acceleration is (v / T) (1 - cos 2 pi u), with u = t / T.
//!
//! docs/profiles.md lists the errors of the published source that are corrected here.
//!
//! The golden numbers in `tests/golden/` fix the formulas; only their numerical form may change.

use crate::alone;
use crate::bad_ramp::{BadRamp, positive};
use crate::curve::Curve;
use crate::numeric::x_minus_sin;
use crate::own::{OwnRamp, Shape};
use crate::profile::{Profile, Real, real};
use crate::ramped::RampedMove;
use crate::refusal::{LimitRefusal, Limits};
use crate::timed;
use std::f64::consts::PI;

/// One acceleration ramp from rest to `top` steps/s in `duration` seconds. Acceleration and jerk
/// are continuous.
///
/// With y = pi u, the distance is s = v T / (2 pi^2) (y^2 - sin^2 y). The difference is computed as
/// (y - sin y) (y + sin y).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SineRamp<F> {
    top: F,
    duration: F,
}

impl<F: Real> SineRamp<F> {
    /// A ramp to `top` steps/s in `duration` seconds.
    ///
    /// # Errors
    /// A [`BadRamp`] if a parameter is not finite and over 0.
    pub fn new(top: F, duration: F) -> Result<Self, BadRamp> {
        Ok(Self {
            top: positive("the top speed", top)?,
            duration: positive("the ramp time", duration)?,
        })
    }

    /// A ramp to `top` steps/s with a peak acceleration of `acceleration` steps/s^2: T = 2 v / a.
    ///
    /// # Errors
    /// A [`BadRamp`] if a parameter is not finite and over 0.
    pub fn with_acceleration(top: F, acceleration: F) -> Result<Self, BadRamp> {
        Self::new(top, real::<F>(2.0) * top / positive("the acceleration", acceleration)?)
    }

    /// [`Self::new`] for parameters that have been checked.
    pub(crate) fn lasting(top: F, duration: F) -> Self {
        Self { top, duration }
    }

    /// The steepest ramp within `limits` that ends at `top` steps/s.
    pub(crate) fn within(limits: &Limits<F>, top: F) -> Self {
        if top <= F::zero() {
            return Self { top: F::zero(), duration: F::zero() };
        }
        let by_acceleration = real::<F>(2.0) * top / limits.acceleration;
        let by_jerk = (real::<F>(2.0 * PI) * top / limits.jerk).sqrt();
        Self { top, duration: by_acceleration.max(by_jerk) }
    }

    /// pi u, in 0..=pi.
    fn angle(&self, t: F) -> F {
        real::<F>(PI) * (t.max(F::zero()).min(self.duration) / self.duration)
    }
}

/// y^2 - sin^2 y.
fn path<F: Real>(y: F) -> F {
    x_minus_sin(y) * (y + y.sin())
}

/// Solves y^2 - sin^2 y = c for y in 0..=pi, with c in 0..=pi^2.
///
/// Newton's method: y^4/3 and y^2 are both above the left side, so that the greater of their roots
/// is below y. The left side is convex: the first step lands above y, and the others come down to
/// it.
fn angle_of_path<F: Real>(c: F) -> F {
    let mut y = (c * real(3.0)).sqrt().sqrt().max(c.sqrt());
    for _ in 0..32 {
        let next = y - (path(y) - c) / x_minus_sin(y + y);
        if (next - y).abs() <= F::epsilon() * y {
            return next;
        }
        y = next;
    }
    y
}

impl<F: Real> Profile<F> for SineRamp<F> {
    fn shape(&self) -> &'static str {
        "sine"
    }

    fn duration(&self) -> F {
        self.duration
    }

    fn distance(&self) -> F {
        self.top * self.duration / real(2.0)
    }

    fn position(&self, t: F) -> F {
        self.top * self.duration / real(2.0 * PI * PI) * path(self.angle(t))
    }

    fn speed(&self, t: F) -> F {
        let y = self.angle(t);
        (self.top / real(2.0 * PI) * x_minus_sin(y + y)).min(self.top)
    }

    fn acceleration(&self, t: F) -> F {
        // The sine of the float nearest to pi is not 0.
        if t >= self.duration {
            return F::zero();
        }
        let sine = self.angle(t).sin();
        self.peak_acceleration() * sine * sine
    }

    fn jerk(&self, t: F) -> F {
        if t >= self.duration {
            return F::zero();
        }
        let y = self.angle(t);
        self.peak_jerk() * (y + y).sin()
    }

    fn crossing(&self, x: F) -> F {
        if x <= F::zero() {
            return F::zero();
        } else if x >= self.distance() {
            return self.duration;
        }
        let c = real::<F>(PI * PI) * (x / self.distance());
        (self.duration * (angle_of_path(c) / real(PI))).min(self.duration)
    }

    fn breakpoints(&self) -> &[F] {
        &[]
    }

    /// With y from p to q, the difference is (q^2 - p^2) - (sin^2 q - sin^2 p) = d s - sin d sin s,
    /// where d = q - p and s = q + p.
    fn mean_speed(&self, from: F, to: F) -> F {
        let (p, q) = (self.angle(from), self.angle(to));
        let (d, s) = (q - p, q + p);
        if d <= F::zero() {
            return self.speed(from);
        }
        let fall = x_minus_sin(s);
        // From rest s equals d, and one series gives both.
        let rise = if p.is_zero() { fall } else { x_minus_sin(d) };
        self.top / real(2.0 * PI) * (rise / d * s + d.sin() / d * fall)
    }
}

impl<F: Real> Curve<F> for SineRamp<F> {
    fn own_ramp(&self) -> Option<OwnRamp> {
        OwnRamp::of(Shape::Sine, self.duration, self.distance())
    }

    fn top_speed(&self) -> F {
        self.top
    }

    /// The peak acceleration 2 v / T.
    fn peak_acceleration(&self) -> F {
        if self.duration.is_zero() { F::zero() } else { real::<F>(2.0) * self.top / self.duration }
    }

    /// The peak jerk 2 pi v / T^2.
    fn peak_jerk(&self) -> F {
        self.peak_acceleration()
            * (if self.duration.is_zero() { F::zero() } else { real::<F>(PI) / self.duration })
    }

    fn acceleration_jump(&self) -> F {
        F::zero()
    }
}

/// The sinusoidal move of `distance` steps (over 0) in `time` seconds, from rest to rest.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that fails and the least time.
pub fn sine<F: Real>(
    distance: F,
    time: F,
    limits: &Limits<F>,
) -> Result<RampedMove<F, SineRamp<F>>, LimitRefusal> {
    let fastest = timed::fastest(distance, limits, &ramps, F::nan());
    timed::in_time(distance, time, limits, &ramps, &fastest, F::nan())
}

/// Least time of [`sine`], seconds.
pub fn sine_least_time<F: Real>(distance: F, limits: &Limits<F>) -> F {
    timed::fastest(distance, limits, &ramps, F::nan()).time
}

/// The two ramps of [`sine`].
pub(crate) fn ramps<F: Real>(limits: &Limits<F>, top: F) -> (SineRamp<F>, SineRamp<F>) {
    let ramp = SineRamp::within(limits, top);
    (ramp, ramp)
}

/// The sinusoidal ramp from rest.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that `time` breaks and the least time.
pub fn sine_ramp<F: Real>(
    top: F,
    time: Option<F>,
    limits: &Limits<F>,
) -> Result<SineRamp<F>, LimitRefusal> {
    alone::in_time(
        time,
        limits,
        |limits| SineRamp::within(limits, top),
        |time| SineRamp::lasting(top, time),
    )
}

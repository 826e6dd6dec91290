//! Triangle and trapezoid: constant acceleration, perhaps a cruise, and the same deceleration.

use crate::curve::{Curve, is_time};
use crate::profile::{Profile, Real, real};

/// A symmetric speed ramp: start speed, top speed, and a cruise between the two ramps.
///
/// ```text
/// top    ........ /^^^^^^^^^^\
///                /            \
/// start  .......|              |
///               :<-r->:<-c->:<-r->
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ramp<F> {
    start: F,
    top: F,
    acceleration: F,
    ramp: F,
    ramp_distance: F,
    duration: F,
    distance: F,
    breakpoints: [F; 2],
    triangle: bool,
}

impl<F: Real> Ramp<F> {
    /// A move up and down without a cruise, in `duration` seconds; `acceleration` must be over 0.
    pub fn triangle(distance: F, duration: F, start: F, acceleration: F) -> Self {
        let half = duration / real(2.0);
        Self::build(
            distance,
            duration,
            start,
            start + acceleration * half,
            acceleration,
            half,
            true,
        )
    }

    /// A move that rises to `top` steps/s in `ramp` seconds (limited to half the duration), cruises
    /// and falls.
    pub fn trapezoid(distance: F, duration: F, start: F, top: F, acceleration: F, ramp: F) -> Self {
        Self::build(
            distance,
            duration,
            start,
            top,
            acceleration,
            ramp.min(duration / real(2.0)),
            false,
        )
    }

    fn build(
        distance: F,
        duration: F,
        start: F,
        top: F,
        acceleration: F,
        ramp: F,
        triangle: bool,
    ) -> Self {
        let ramp_distance = (start + acceleration * ramp / real(2.0)) * ramp;
        let breakpoints = [ramp, duration - ramp];
        Self {
            start,
            top,
            acceleration,
            ramp,
            ramp_distance,
            duration,
            distance,
            breakpoints,
            triangle,
        }
    }

    /// Speed at the start and at the end, steps/s.
    pub fn start_speed(&self) -> F {
        self.start
    }

    /// Greatest speed, steps/s.
    pub fn top_speed(&self) -> F {
        self.top
    }

    /// Acceleration of the first ramp, steps/s^2.
    pub fn ramp_acceleration(&self) -> F {
        self.acceleration
    }

    /// Duration of each ramp, seconds.
    pub fn ramp_time(&self) -> F {
        self.ramp
    }

    /// Distance after `t` seconds, for t in the first half, in steps. By symmetry it is also the
    /// distance that is left `t` seconds before the end.
    fn head(&self, t: F) -> F {
        if t <= self.ramp {
            (self.start + self.acceleration * t / real(2.0)) * t
        } else {
            self.ramp_distance + self.top * (t - self.ramp)
        }
    }

    /// The inverse of [`Self::head`], for x in the first half. The root of the quadratic is
    /// rationalised, so that near rest no difference of nearly equal numbers is taken.
    fn head_time(&self, x: F) -> F {
        if x <= F::zero() {
            return F::zero();
        }
        let (v, two) = (self.start, real::<F>(2.0));
        if x <= self.ramp_distance {
            two * x / (v + (v * v + two * self.acceleration * x).sqrt())
        } else {
            self.ramp + (x - self.ramp_distance) / self.top
        }
    }

    fn nearer_end(&self, t: F) -> F {
        t.min(self.duration - t).max(F::zero())
    }
}

impl<F: Real> Profile<F> for Ramp<F> {
    fn shape(&self) -> &'static str {
        if self.triangle { "triangle" } else { "trapezoid" }
    }

    fn duration(&self) -> F {
        self.duration
    }

    fn distance(&self) -> F {
        self.distance
    }

    fn position(&self, t: F) -> F {
        let near = self.nearer_end(t);
        if t + t <= self.duration { self.head(near) } else { self.distance - self.head(near) }
    }

    fn speed(&self, t: F) -> F {
        let near = self.nearer_end(t);
        if near < self.ramp {
            (self.start + self.acceleration * near).min(self.top)
        } else {
            self.top
        }
    }

    fn acceleration(&self, t: F) -> F {
        let [up, down] = self.breakpoints;
        if t < F::zero() || t >= self.duration {
            F::zero()
        } else if t < up {
            self.acceleration
        } else if t < down {
            F::zero()
        } else {
            -self.acceleration
        }
    }

    fn jerk(&self, _: F) -> F {
        F::zero()
    }

    fn crossing(&self, x: F) -> F {
        if x + x <= self.distance {
            self.head_time(x)
        } else {
            self.duration - self.head_time(self.distance - x)
        }
    }

    fn breakpoints(&self) -> &[F] {
        &self.breakpoints
    }
}

impl<F: Real> Curve<F> for Ramp<F> {
    fn top_speed(&self) -> F {
        self.top
    }

    fn peak_acceleration(&self) -> F {
        if self.ramp > F::zero() { self.acceleration } else { F::zero() }
    }

    fn peak_jerk(&self) -> F {
        F::zero()
    }

    /// Without a cruise, rounding aside, the two jumps at the top are one jump of twice the size.
    fn acceleration_jump(&self) -> F {
        let [up, down] = self.breakpoints;
        let peak = Curve::peak_acceleration(self);
        if is_time(down - up, self.duration) { peak } else { peak + peak }
    }
}

//! The profile of constant speed from start to end.

use crate::curve::Curve;
use crate::profile::{Profile, Real};
use crate::refusal::{Limit, LimitRefusal, Limits};

/// A move at the constant speed N / T. A distance of 0 is an axis at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constant<F> {
    distance: F,
    duration: F,
}

impl<F: Real> Constant<F> {
    /// A move of `distance` steps in `duration` seconds.
    pub fn new(distance: F, duration: F) -> Self {
        Self { distance, duration }
    }

    /// An axis at rest for `duration` seconds.
    pub fn rest(duration: F) -> Self {
        Self::new(F::zero(), duration)
    }
}

/// The constant-speed move of `distance` steps in `time` seconds.
///
/// # Errors
/// A [`LimitRefusal`] if the motor would have to jump to more than its start speed.
pub fn constant<F: Real>(
    distance: F,
    time: F,
    limits: &Limits<F>,
) -> Result<Constant<F>, LimitRefusal> {
    let least = constant_least_time(distance, limits)?;
    if limits.too_short(time, least) {
        return Err(LimitRefusal::new(
            Limit::StartSpeed,
            distance / time,
            limits.start_speed,
            least,
        ));
    }
    Ok(Constant::new(distance, time))
}

/// Least time at constant speed: N / v_s, seconds.
///
/// # Errors
/// A [`LimitRefusal`] if the start speed is 0, because no time would then be long enough.
pub fn constant_least_time<F: Real>(distance: F, limits: &Limits<F>) -> Result<F, LimitRefusal> {
    if limits.start_speed <= F::zero() {
        return Err(LimitRefusal::never(Limit::StartSpeed, limits.start_speed));
    }
    Ok(distance / limits.start_speed)
}

impl<F: Real> Profile<F> for Constant<F> {
    fn shape(&self) -> &'static str {
        if self.distance.is_zero() { "rest" } else { "constant" }
    }

    fn duration(&self) -> F {
        self.duration
    }

    fn distance(&self) -> F {
        self.distance
    }

    fn position(&self, t: F) -> F {
        self.distance * (t.max(F::zero()).min(self.duration) / self.duration)
    }

    fn speed(&self, _: F) -> F {
        self.distance / self.duration
    }

    fn acceleration(&self, _: F) -> F {
        F::zero()
    }

    fn jerk(&self, _: F) -> F {
        F::zero()
    }

    fn crossing(&self, x: F) -> F {
        if x >= self.distance {
            self.duration
        } else {
            self.duration * (x.max(F::zero()) / self.distance)
        }
    }

    fn breakpoints(&self) -> &[F] {
        &[]
    }

    fn mean_speed(&self, from: F, _: F) -> F {
        self.speed(from)
    }
}

impl<F: Real> Curve<F> for Constant<F> {
    fn top_speed(&self) -> F {
        self.distance / self.duration
    }

    fn peak_acceleration(&self) -> F {
        F::zero()
    }

    fn peak_jerk(&self) -> F {
        F::zero()
    }

    fn acceleration_jump(&self) -> F {
        F::zero()
    }
}

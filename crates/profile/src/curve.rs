//! What a user has to know before trusting a curve.

use crate::profile::{Profile, Real, real};

/// A profile that knows its extremes.
pub trait Curve<F: Real>: Profile<F> {
    /// Greatest speed, steps/s.
    fn top_speed(&self) -> F;

    /// Greatest absolute acceleration, steps/s^2.
    fn peak_acceleration(&self) -> F;

    /// Greatest absolute jerk inside the pieces, steps/s^3; where acceleration jumps, jerk has an impulse
    /// that is not counted here but in [`Figures::acceleration_jump`].
    fn peak_jerk(&self) -> F;

    /// Time from position `x` to `x + 1` (both in 0..=distance), seconds: the c_n of the literature.
    ///
    /// As the reciprocal of a mean speed, which is well conditioned where the difference of two late
    /// crossing times is not.
    fn delay(&self, x: F) -> F {
        self.mean_speed(self.crossing(x), self.crossing(x + F::one())).recip()
    }

    /// All extremes at once.
    fn figures(&self) -> Figures<F> {
        let (start, end) = (F::zero(), self.duration());
        Figures {
            steps: self.distance(),
            seconds: end,
            start_speed: self.speed(start),
            end_speed: self.speed(end),
            top_speed: self.top_speed(),
            peak_acceleration: self.peak_acceleration(),
            acceleration_jump: self.acceleration_jump(),
            peak_jerk: self.peak_jerk(),
        }
    }

    /// Greatest sudden change of acceleration, steps/s^2, the ends included; 0 where acceleration is continuous.
    fn acceleration_jump(&self) -> F;
}

/// Whether a part of a move takes time, or is nothing but the rounding of its whole.
pub(crate) fn is_time<F: Real>(part: F, whole: F) -> bool {
    part > real::<F>(64.0) * F::epsilon() * whole
}

/// The extremes of a ramp or a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures<F> {
    /// Length, steps.
    pub steps: F,
    /// Length, seconds.
    pub seconds: F,
    /// The jump from rest at the start, steps/s.
    pub start_speed: F,
    /// Speed at the end, steps/s: of a move, the jump back to rest.
    pub end_speed: F,
    /// Greatest speed, steps/s.
    pub top_speed: F,
    /// Greatest absolute acceleration, steps/s^2.
    pub peak_acceleration: F,
    /// Greatest sudden change of acceleration, steps/s^2; 0 where acceleration is continuous.
    pub acceleration_jump: F,
    /// Greatest absolute jerk between such changes, steps/s^3.
    pub peak_jerk: F,
}

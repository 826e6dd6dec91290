//! The figures of a curve that a user needs to judge it.

use crate::own::OwnRamp;
use crate::profile::{Profile, Real, real};

/// A profile that can give its extremes.
pub trait Curve<F: Real>: Profile<F> {
    /// Greatest speed, steps/s.
    fn top_speed(&self) -> F;

    /// Greatest absolute acceleration, steps/s^2.
    fn peak_acceleration(&self) -> F;

    /// Greatest absolute jerk inside the pieces, steps/s^3. Where the acceleration jumps, the jerk
    /// has an impulse; it is not counted here but in [`CurveFigures::acceleration_jump`].
    fn peak_jerk(&self) -> F;

    /// A ramp up by its shape, if only its units distinguish it from others of that shape.
    fn own_ramp(&self) -> Option<OwnRamp> {
        None
    }

    /// Time from position `x` to `x + 1` (both in 0..=distance), seconds: the delay c_n of the
    /// literature.
    ///
    /// It is the reciprocal of a mean speed. This is well conditioned, unlike the difference of two
    /// late crossing times.
    fn delay(&self, x: F) -> F {
        self.mean_speed(self.crossing(x), self.crossing(x + F::one())).recip()
    }

    /// Returns all extremes.
    fn figures(&self) -> CurveFigures<F> {
        let (start, end) = (F::zero(), self.duration());
        CurveFigures {
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

    /// Greatest sudden change of acceleration, steps/s^2, with the ends of the move; 0 where the
    /// acceleration is continuous.
    fn acceleration_jump(&self) -> F;
}

/// Whether a part of a move takes time, as opposed to being only the rounding of the whole, both in
/// seconds.
pub(crate) fn is_time<F: Real>(part: F, whole: F) -> bool {
    part > real::<F>(64.0) * F::epsilon() * whole
}

/// The extremes of a ramp or a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveFigures<F> {
    /// Distance, steps.
    pub steps: F,
    /// Duration, seconds.
    pub seconds: F,
    /// Speed at the start, to which the motor jumps from rest, steps/s.
    pub start_speed: F,
    /// Speed at the end, steps/s. At the end of a move the motor jumps from it to rest.
    pub end_speed: F,
    /// Greatest speed, steps/s.
    pub top_speed: F,
    /// Greatest absolute acceleration, steps/s^2.
    pub peak_acceleration: F,
    /// Greatest sudden change of acceleration, steps/s^2; 0 where the acceleration is continuous.
    pub acceleration_jump: F,
    /// Greatest absolute jerk between such changes, steps/s^3.
    pub peak_jerk: F,
}

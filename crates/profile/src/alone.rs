//! A single ramp up to a given speed: as steep as the limits allow, or in a given time. Those of
//! fitted curves are with their curves.
//!
//! The limits are those of a move, except for their speed, which is replaced by `top` (steps/s,
//! over 0). The start speed is the speed to which the motor may jump. The
//! trapezoid does not use it; Ranade's rule and the seven-segment curve do. `time` is in seconds;
//! `None` stands for the least time.

use crate::curve::Curve;
use crate::profile::{Real, real};
use crate::refusal::{Limit, LimitRefusal, Limits};
use crate::scurve::ScurveRamp;
use crate::solve::smallest;

/// The ramp of constant acceleration from rest.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that `time` breaks and the least time.
pub fn trapezoid_ramp<F: Real>(
    top: F,
    time: Option<F>,
    limits: &Limits<F>,
) -> Result<ScurveRamp<F>, LimitRefusal> {
    ranade_ramp(top, time, &Limits { start_speed: F::zero(), ..*limits })
}

/// The ramp of constant acceleration from the start speed, which must be below `top`.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that `time` breaks and the least time.
pub fn ranade_ramp<F: Real>(
    top: F,
    time: Option<F>,
    limits: &Limits<F>,
) -> Result<ScurveRamp<F>, LimitRefusal> {
    scurve_ramp(top, time, &Limits { jerk: F::infinity(), ..*limits })
}

/// The ramp of three segments from the start speed, which must be below `top`.
///
/// In a given time it has the jerk of the limits and the acceleration that results. Without a jerk
/// limit it is therefore a ramp of constant acceleration.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that `time` breaks and the least time.
pub fn scurve_ramp<F: Real>(
    top: F,
    time: Option<F>,
    limits: &Limits<F>,
) -> Result<ScurveRamp<F>, LimitRefusal> {
    let start = limits.start_speed;
    let ramp = |acceleration, jerk| ScurveRamp::steepest(start, top, acceleration, jerk);
    let lasting = |time: F| {
        let gain = top - start;
        if limits.jerk.is_infinite() {
            return ramp(gain / time, limits.jerk);
        }
        // With jerk segments of r seconds, gain = j r (T - r). This is the smaller root, in a form
        // without cancellation.
        let turn = gain / limits.jerk;
        let spare = (time * time - real::<F>(4.0) * turn).max(F::zero());
        ramp(limits.jerk * (turn + turn) / (time + spare.sqrt()), limits.jerk)
    };
    in_time(time, limits, |limits| ramp(limits.acceleration, limits.jerk), lasting)
}

/// The `steepest` ramp of the limits, or the ramp that lasts `time` seconds.
pub(crate) fn in_time<F: Real, R: Curve<F>>(
    time: Option<F>,
    limits: &Limits<F>,
    steepest: impl Fn(&Limits<F>) -> R,
    lasting: impl Fn(F) -> R,
) -> Result<R, LimitRefusal> {
    let Some(time) = time else { return Ok(steepest(limits)) };
    let duration = |limits: &Limits<F>| steepest(limits).duration();
    let least = duration(limits);
    if !limits.too_short(time, least) {
        return Ok(lasting(time));
    }
    let free = Limits { jerk: F::infinity(), ..*limits };
    if free.acceleration.is_finite() && duration(&free) > time {
        let does = |acceleration| duration(&Limits { acceleration, ..free }) <= time;
        return Err(LimitRefusal::new(
            Limit::Acceleration,
            smallest(free.acceleration, does),
            free.acceleration,
            least,
        ));
    }
    let does = |jerk| duration(&Limits { jerk, ..*limits }) <= time;
    Err(LimitRefusal::new(Limit::Jerk, smallest(limits.jerk, does), limits.jerk, least))
}

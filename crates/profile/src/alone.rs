//! A ramp by itself, up to a given speed: as steep as the limits allow, or in a given time.
//!
//! The limits are those of a move, their speed aside: `top` (over 0) stands for it. The start speed is a
//! permission to jump: the sine and the trapezoid do not use it, Ranade's rule and the seven segments do.

use crate::bad_ramp::BadRamp;
use crate::curve::Curve;
use crate::logistic::{self, LogisticRamp, SHORTFALL};
use crate::profile::{Profile, Real, real};
use crate::refusal::{Limit, Limits, Refusal};
use crate::scurve::ScurveRamp;
use crate::sine::SineRamp;
use crate::solve::smallest;

/// The ramp of one acceleration, from rest.
///
/// # Errors
/// [`Refusal`] names the limit that `time` breaks and the least time.
pub fn trapezoid_ramp<F: Real>(top: F, time: Option<F>, limits: &Limits<F>) -> Result<ScurveRamp<F>, Refusal> {
    ranade_ramp(top, time, &Limits { start_speed: F::zero(), ..*limits })
}

/// The ramp of one acceleration, from the start speed, which is under `top`.
///
/// # Errors
/// [`Refusal`] names the limit that `time` breaks and the least time.
pub fn ranade_ramp<F: Real>(top: F, time: Option<F>, limits: &Limits<F>) -> Result<ScurveRamp<F>, Refusal> {
    scurve_ramp(top, time, &Limits { jerk: F::infinity(), ..*limits })
}

/// The ramp of three segments, from the start speed, which is under `top`.
///
/// In a given time it has the jerk of the limits and the acceleration that this takes; so without a jerk
/// limit it is a ramp of one acceleration.
///
/// # Errors
/// [`Refusal`] names the limit that `time` breaks and the least time.
pub fn scurve_ramp<F: Real>(top: F, time: Option<F>, limits: &Limits<F>) -> Result<ScurveRamp<F>, Refusal> {
    let start = limits.start_speed;
    let ramp = |acceleration, jerk| ScurveRamp::steepest(start, top, acceleration, jerk);
    let lasting = |time: F| {
        let gain = top - start;
        if limits.jerk.is_infinite() {
            return ramp(gain / time, limits.jerk);
        }
        // Jerk segments of r: gain = j r (T - r), the smaller root, which does not cancel.
        let turn = gain / limits.jerk;
        let spare = (time * time - real::<F>(4.0) * turn).max(F::zero());
        ramp(limits.jerk * (turn + turn) / (time + spare.sqrt()), limits.jerk)
    };
    in_time(time, limits, |limits| ramp(limits.acceleration, limits.jerk), lasting)
}

/// The sinusoidal ramp, from rest.
///
/// # Errors
/// [`Refusal`] names the limit that `time` breaks and the least time.
pub fn sine_ramp<F: Real>(top: F, time: Option<F>, limits: &Limits<F>) -> Result<SineRamp<F>, Refusal> {
    in_time(time, limits, |limits| SineRamp::within(limits, top), |time| SineRamp::lasting(top, time))
}

/// The logistic ramp with the asymptote `top`, as its source has it: it ends at 99.5 %.
///
/// It starts at 0.5 %, or at the start speed where that is over 0 and less.
///
/// # Errors
/// [`Refusal`] names the limit that `time` breaks and the least time.
pub fn logistic_ramp<F: Real>(top: F, time: Option<F>, limits: &Limits<F>) -> Result<LogisticRamp<F>, Refusal> {
    let start = logistic::start_fraction(limits, top);
    let ramp = |steepness| LogisticRamp::between(top, steepness, start);
    // With a steepness of 1 a ramp takes k T seconds.
    let lasting = |time| ramp(ramp(F::one()).duration() / time);
    in_time(time, limits, |limits| ramp(logistic::steepest(limits, top)), lasting)
}

/// [`logistic_ramp`] as its source begins it: T_i seconds before it has half its speed.
///
/// # Errors
/// A centre so early that the ramp is over before it starts.
pub fn logistic_ramp_about<F: Real>(top: F, centre: F, limits: &Limits<F>) -> Result<LogisticRamp<F>, BadRamp> {
    let acceleration = logistic::steepest(limits, top) * (top / real(4.0));
    LogisticRamp::new(top, acceleration, centre, real(SHORTFALL))
}

/// `steepest` of the limits, or what lasts `time`.
fn in_time<F: Real, R: Curve<F>>(
    time: Option<F>,
    limits: &Limits<F>,
    steepest: impl Fn(&Limits<F>) -> R,
    lasting: impl Fn(F) -> R,
) -> Result<R, Refusal> {
    let Some(time) = time else { return Ok(steepest(limits)) };
    let duration = |limits: &Limits<F>| steepest(limits).duration();
    let least = duration(limits);
    if !limits.too_short(time, least) {
        return Ok(lasting(time));
    }
    let free = Limits { jerk: F::infinity(), ..*limits };
    if free.acceleration.is_finite() && duration(&free) > time {
        let does = |acceleration| duration(&Limits { acceleration, ..free }) <= time;
        return Err(Refusal::new(Limit::Acceleration, smallest(free.acceleration, does), free.acceleration, least));
    }
    let does = |jerk| duration(&Limits { jerk, ..*limits }) <= time;
    Err(Refusal::new(Limit::Jerk, smallest(limits.jerk, does), limits.jerk, least))
}

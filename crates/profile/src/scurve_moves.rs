//! Whole moves along the seven-segment S-curve.

use crate::profile::{Real, real};
use crate::ramped::RampedMove;
use crate::refusal::{LimitRefusal, Limits};
use crate::scurve::ScurveRamp;
use crate::timed::{self, Fastest};

/// The seven-segment move of `distance` steps (over 0) in `time` seconds. The motor jumps from rest
/// to the start speed and back.
///
/// In a time above the least time the ramps stay as steep and end at a lower top speed. If that is
/// below the start speed, the whole move has constant speed, as in Ranade's rule.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that fails and the least time.
pub fn scurve<F: Real>(
    distance: F,
    time: F,
    limits: &Limits<F>,
) -> Result<RampedMove<F, ScurveRamp<F>>, LimitRefusal> {
    scurve_to(distance, time, limits.start_speed, limits)
}

/// Least time of [`scurve`], seconds.
pub fn scurve_least_time<F: Real>(distance: F, limits: &Limits<F>) -> F {
    scurve_to_least_time(distance, limits.start_speed, limits)
}

/// [`scurve`] with another jump at the end: from at most `end_speed` steps/s to rest.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that fails and the least time.
pub fn scurve_to<F: Real>(
    distance: F,
    time: F,
    end_speed: F,
    limits: &Limits<F>,
) -> Result<RampedMove<F, ScurveRamp<F>>, LimitRefusal> {
    scurve_after(distance, time, end_speed, limits, &scurve_fastest(distance, end_speed, limits))
}

/// [`scurve_to`], where the fastest move is known.
pub(crate) fn scurve_after<F: Real>(
    distance: F,
    time: F,
    end_speed: F,
    limits: &Limits<F>,
    fastest: &Fastest<F>,
) -> Result<RampedMove<F, ScurveRamp<F>>, LimitRefusal> {
    let near = cruise_speed(distance, time, end_speed, limits);
    timed::in_time(distance, time, limits, &ramps(end_speed), fastest, near)
}

/// The fastest move of [`scurve_to`].
pub(crate) fn scurve_fastest<F: Real>(distance: F, end_speed: F, limits: &Limits<F>) -> Fastest<F> {
    timed::fastest(distance, limits, &ramps(end_speed), meeting_speed(distance, end_speed, limits))
}

/// The top speed of a move of two ramps of the same start speed in `time` seconds, up to rounding;
/// not a number where the start speeds differ.
///
/// A top speed of s + w over a distance N has the time T if T (s + w) - N is w (w / a + r), where
/// the ramps hold their acceleration and r = a / j is their rise, and otherwise 2 w sqrt(w / j).
/// Newton's method solves the latter from below: the difference of both sides is concave.
fn cruise_speed<F: Real>(distance: F, time: F, end_speed: F, limits: &Limits<F>) -> F {
    let Limits { start_speed: start, acceleration, jerk, .. } = *limits;
    if start != end_speed {
        return F::nan();
    }
    let (two, three, four) = (real::<F>(2.0), real::<F>(3.0), real::<F>(4.0));
    let left = distance - time * start;
    let late = time - acceleration / jerk;
    let held =
        two * left / (late + (late * late - four * left / acceleration).max(F::zero()).sqrt());
    if held * jerk >= acceleration * acceleration {
        return start + held;
    }
    let mut gain = left / time;
    for _ in 0..16 {
        let rise = (gain / jerk).sqrt();
        let next = (left - gain * rise) / (time - three * rise);
        if next - gain <= F::epsilon() * (start + next) || next.is_nan() {
            break;
        }
        gain = next;
    }
    start + gain
}

/// The top speed at which two ramps of the same start speed meet, up to rounding; not a number
/// where no closed form is known.
///
/// With the rise r = a / j of a ramp that holds its acceleration, the two ramps travel (s + v)
/// ((v - s) / a + r). From rest, two ramps without a hold travel 2 v sqrt(v / j).
fn meeting_speed<F: Real>(distance: F, end_speed: F, limits: &Limits<F>) -> F {
    let Limits { start_speed: start, acceleration, jerk, .. } = *limits;
    if start != end_speed {
        return F::nan();
    }
    let four = real::<F>(4.0);
    let slope = acceleration * (acceleration / jerk);
    let constant = start * (slope - start) - acceleration * distance;
    let held = (F::zero() - constant - constant)
        / (slope + (slope * slope - four * constant).max(F::zero()).sqrt());
    if (held - start) * jerk >= acceleration * acceleration {
        held
    } else if start.is_zero() {
        (distance * distance * (jerk / four)).cbrt()
    } else {
        F::nan()
    }
}

/// Least time of [`scurve_to`], seconds.
pub fn scurve_to_least_time<F: Real>(distance: F, end_speed: F, limits: &Limits<F>) -> F {
    scurve_fastest(distance, end_speed, limits).time
}

fn ramps<F: Real>(end_speed: F) -> impl Fn(&Limits<F>, F) -> (ScurveRamp<F>, ScurveRamp<F>) {
    move |limits, top| {
        let from = |jump: F| {
            ScurveRamp::steepest(
                jump.max(F::zero()).min(top),
                top,
                limits.acceleration,
                limits.jerk,
            )
        };
        let up = from(limits.start_speed);
        (up, if end_speed == limits.start_speed { up } else { from(end_speed) })
    }
}

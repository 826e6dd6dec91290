//! One rule for the move of every curve: its least time, and the move in a given time.
//!
//! A curve is a family of ramps, one for each top speed, each as steep as the limits allow. The
//! time of a move falls as its top speed rises, until the two ramps meet or the speed limit is
//! reached: this gives the least time. In a longer time the ramps stay as steep, and the top speed
//! is lower.
//!
//! A new curve only has to provide its ramps, as a [`Ramps`] function.

use crate::curve::Curve;
use crate::profile::Real;
use crate::ramped::{RampedMove, time_with_cruise};
use crate::refusal::{Limit, LimitRefusal, Limits};
use crate::solve::{largest_near, smallest};

/// The ramps of one curve: returns the ramps up and down for the limits and the common top speed in
/// steps/s.
pub(crate) trait Ramps<F: Real, R: Curve<F>>: Fn(&Limits<F>, F) -> (R, R) {}

impl<F: Real, R: Curve<F>, S: Fn(&Limits<F>, F) -> (R, R)> Ramps<F, R> for S {}

/// The fastest move of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fastest<F> {
    /// Its time, the least, in seconds.
    pub time: F,
    /// Its top speed in steps/s: the speed limit, or the speed at which the two ramps meet. It is
    /// not a number for a kind of profile whose rule does not need it.
    pub(crate) top: F,
}

impl<F: Real> Fastest<F> {
    /// The fastest move of a kind of profile whose rule needs its time only.
    pub(crate) fn taking(time: F) -> Self {
        Self { time, top: F::nan() }
    }
}

/// The fastest move. Its top speed is found soon if it is `near` a guess in steps/s; without one,
/// that is not a number.
pub(crate) fn fastest<F: Real, R: Curve<F>>(
    distance: F,
    limits: &Limits<F>,
    ramps: &impl Ramps<F, R>,
    near: F,
) -> Fastest<F> {
    let distance = distance.max(F::zero());
    let top = largest_near(near, (F::zero(), limits.speed), distance, |top| {
        let (up, down) = ramps(limits, top);
        up.distance() + down.distance()
    });
    let time = if distance.is_zero() { distance } else { time_at(distance, top, limits, ramps) };
    Fastest { time, top }
}

fn time_at<F: Real, R: Curve<F>>(
    distance: F,
    top: F,
    limits: &Limits<F>,
    ramps: &impl Ramps<F, R>,
) -> F {
    let (up, down) = ramps(limits, top);
    time_with_cruise(distance, top, &up, &down)
}

/// Returns the move that takes exactly `time` seconds. Its top speed is the greatest one at which
/// the move takes that long.
///
/// # Errors
/// A [`LimitRefusal`] if `time` is not a number or below the least time.
pub(crate) fn in_time<F: Real, R: Curve<F>>(
    distance: F,
    time: F,
    limits: &Limits<F>,
    ramps: &impl Ramps<F, R>,
    fastest: &Fastest<F>,
    near: F,
) -> Result<RampedMove<F, R>, LimitRefusal> {
    let distance = distance.max(F::zero());
    let &Fastest { time: least, top: fastest } = fastest;
    if time.is_nan() || limits.too_short(time, least) {
        return Err(refusal(distance, time, least, limits, ramps));
    }
    let mean = distance / time;
    // `mean` is at most `fastest`, rounding aside; where both are equal the move has constant
    // speed.
    let bracket = (mean.min(fastest), fastest);
    let top = largest_near(near, bracket, -time, |top| -time_at(distance, top, limits, ramps));
    let (up, down) = ramps(limits, top);
    Ok(RampedMove::new(distance, time, top, up, down))
}

/// Names the first limit that `time` breaks and the value that it would need. The limits are tested
/// one after the other, with the others removed.
fn refusal<F: Real, R: Curve<F>>(
    distance: F,
    time: F,
    least: F,
    limits: &Limits<F>,
    ramps: &impl Ramps<F, R>,
) -> LimitRefusal {
    let does = |limits: &Limits<F>| fastest(distance, limits, ramps, F::nan()).time <= time;
    let infinity = F::infinity();
    let free = Limits { speed: infinity, jerk: infinity, ..*limits };
    if !does(&free) {
        let wanted =
            smallest(limits.acceleration, |acceleration| does(&Limits { acceleration, ..free }));
        return LimitRefusal::new(Limit::Acceleration, wanted, limits.acceleration, least);
    }
    let free = Limits { jerk: limits.jerk, ..free };
    if !does(&free) {
        let wanted = smallest(limits.jerk, |jerk| does(&Limits { jerk, ..free }));
        return LimitRefusal::new(Limit::Jerk, wanted, limits.jerk, least);
    }
    let wanted = smallest(limits.speed, |speed| does(&Limits { speed, ..free }));
    LimitRefusal::new(Limit::Speed, wanted, limits.speed, least)
}

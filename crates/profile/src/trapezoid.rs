//! The trapezoid from rest to rest at the acceleration limit, in a given time.
//!
//! The golden numbers in `tests/golden/` fix the formulas; only their numerical form may change.

use crate::profile::{Real, real};
use crate::ramp::Ramp;
use crate::refusal::{Limit, LimitRefusal, Limits};

/// The trapezoid of `distance` steps (over 0) in `time` seconds.
///
/// Its top speed is the smaller root of v^2 - a T v + a N = 0; the larger root would need a cruise
/// of negative duration. The root (a T - sqrt((a T)^2 - 4 a N)) / 2 is computed as 2 N / (T + c)
/// with the cruise time c = sqrt(T^2 - 4 N / a), which avoids cancellation.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that fails and the least time.
pub fn trapezoid<F: Real>(
    distance: F,
    time: F,
    limits: &Limits<F>,
) -> Result<Ramp<F>, LimitRefusal> {
    let (two, four) = (real::<F>(2.0), real::<F>(4.0));
    let least = trapezoid_least_time(distance, limits);
    let shortest = two * (distance / limits.acceleration).sqrt();
    if limits.too_short(time, shortest) {
        let wanted = four * distance / (time * time);
        return Err(LimitRefusal::new(Limit::Acceleration, wanted, limits.acceleration, least));
    }
    let cruise = ((time - shortest).max(F::zero()) * (time + shortest)).sqrt();
    let top = two * distance / (time + cruise);
    if limits.too_short(time, least) {
        return Err(LimitRefusal::new(Limit::Speed, top, limits.speed, least));
    }
    let top = top.min(limits.speed);
    Ok(Ramp::trapezoid(
        distance,
        time,
        F::zero(),
        top,
        limits.acceleration,
        top / limits.acceleration,
    ))
}

/// Least time from rest to rest, seconds: v_l / a + N / v_l, or 2 sqrt(N / a) where the speed limit
/// is not reached.
pub fn trapezoid_least_time<F: Real>(distance: F, limits: &Limits<F>) -> F {
    let Limits { speed, acceleration, .. } = *limits;
    if distance * acceleration >= speed * speed {
        speed / acceleration + distance / speed
    } else {
        real::<F>(2.0) * (distance / acceleration).sqrt()
    }
}

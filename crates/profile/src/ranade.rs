//! Ranade's rule for a move in a given time: P. Ranade (2009), "Add-only speed-time accumulator".
//!
//! The move is a triangle whenever possible, otherwise a trapezoid at the speed limit, otherwise it
//! is refused. For an average speed below the start speed the article's formulas give a negative
//! acceleration: such a move has constant speed here.
//!
//! The golden numbers in `tests/golden/` fix the formulas; only their numerical form may change.

use crate::constant::Constant;
use crate::curve::Curve;
use crate::profile::{Real, real};
use crate::ramp::Ramp;
use crate::refusal::{Limit, LimitRefusal, Limits};
use std::sync::Arc;

/// The move of `distance` steps (over 0) in `time` seconds by Ranade's rule.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that fails and the least time.
pub fn ranade<F: Real>(
    distance: F,
    time: F,
    limits: &Limits<F>,
) -> Result<Arc<dyn Curve<F>>, LimitRefusal> {
    let Limits { start_speed, speed, acceleration: limit, .. } = *limits;
    let average = distance / time;
    if average <= start_speed {
        return Ok(Arc::new(Constant::new(distance, time)));
    }
    let least = ranade_least_time(distance, limits);
    let too_short = limits.too_short(time, least);
    // The least acceleration that is enough: 4 (N - v_s T) / T^2.
    let acceleration = real::<F>(4.0) * (average - start_speed) / time;
    let top = real::<F>(2.0) * average - start_speed;
    if top <= speed {
        if too_short {
            return Err(LimitRefusal::new(Limit::Acceleration, acceleration, limit, least));
        }
        return Ok(Arc::new(Ramp::triangle(distance, time, start_speed, acceleration.min(limit))));
    }
    // The move is limited by the speed: t_a = (v_l T - N) / (v_l - v_s).
    let spare = speed * time - distance;
    let rise = speed - start_speed;
    let acceleration = if spare > F::zero() { rise * rise / spare } else { F::infinity() };
    if too_short {
        return Err(if spare > F::zero() {
            LimitRefusal::new(Limit::Acceleration, acceleration, limit, least)
        } else {
            LimitRefusal::new(Limit::Speed, average, speed, least)
        });
    }
    let acceleration = acceleration.min(limit);
    Ok(Arc::new(Ramp::trapezoid(
        distance,
        time,
        start_speed,
        speed,
        acceleration,
        rise / acceleration,
    )))
}

/// Least time from the start speed back to it, seconds: 2 (v_l - v_s)/a + (N - (v_l^2 -
/// v_s^2)/a)/v_l, or 2 (sqrt(v_s^2 + a N) - v_s)/a where the speed limit is not reached.
pub fn ranade_least_time<F: Real>(distance: F, limits: &Limits<F>) -> F {
    let Limits { start_speed, speed, acceleration, .. } = *limits;
    let two = real::<F>(2.0);
    let rise = speed - start_speed;
    let ramps = rise * (speed + start_speed) / acceleration;
    if distance >= ramps {
        two * rise / acceleration + (distance - ramps) / speed
    } else {
        two * distance
            / (start_speed + (start_speed * start_speed + acceleration * distance).sqrt())
    }
}

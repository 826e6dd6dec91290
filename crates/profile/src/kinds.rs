//! The rules of every kind of profile, by its name.
//!
//! A new kind has one row in each function here; the planner and the command `profile` call nothing
//! else.

use crate::scurve_moves::{scurve_after, scurve_fastest};
pub use crate::timed::Fastest;
use crate::{Curve, LimitRefusal, Limits, Real, logistic, rule, sine, timed};
use carrystep_core::ProfileKind;
use std::sync::Arc;

/// A curve that the caller shares.
pub type SharedCurve<F = f64> = Arc<dyn Curve<F>>;

/// The fastest move of `distance` steps that keeps to the limits.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that no time can keep.
pub fn fastest<F: Real>(
    kind: ProfileKind,
    distance: F,
    limits: &Limits<F>,
) -> Result<Fastest<F>, LimitRefusal> {
    Ok(match kind {
        ProfileKind::Ranade => Fastest::taking(rule::ranade_least_time(distance, limits)),
        ProfileKind::Trapezoid => Fastest::taking(rule::trapezoid_least_time(distance, limits)),
        ProfileKind::Scurve => scurve_fastest(distance, limits.start_speed, limits),
        ProfileKind::Logistic => timed::fastest(distance, limits, &logistic::ramps, F::nan()),
        ProfileKind::Sine => timed::fastest(distance, limits, &sine::ramps, F::nan()),
        ProfileKind::Constant => Fastest::taking(rule::constant_least_time(distance, limits)?),
    })
}

/// The least time, in seconds, in which a move of `distance` steps keeps to the limits.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that no time can keep.
pub fn least_time<F: Real>(
    kind: ProfileKind,
    distance: F,
    limits: &Limits<F>,
) -> Result<F, LimitRefusal> {
    fastest(kind, distance, limits).map(|fastest| fastest.time)
}

/// A whole move of `distance` steps that takes `time` seconds.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that fails, and the least time.
pub fn whole<F: Real>(
    kind: ProfileKind,
    distance: F,
    time: F,
    limits: &Limits<F>,
) -> Result<SharedCurve<F>, LimitRefusal> {
    after(kind, distance, time, limits, &fastest(kind, distance, limits)?)
}

/// [`whole`], where the [`fastest`] move of the same kind, distance and limits is known, so that it
/// is not sought again.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that fails, and the least time.
pub fn after<F: Real>(
    kind: ProfileKind,
    distance: F,
    time: F,
    limits: &Limits<F>,
    fastest: &Fastest<F>,
) -> Result<SharedCurve<F>, LimitRefusal> {
    match kind {
        ProfileKind::Ranade => rule::ranade(distance, time, limits),
        ProfileKind::Trapezoid => rule::trapezoid(distance, time, limits).map(shared),
        ProfileKind::Scurve => {
            scurve_after(distance, time, limits.start_speed, limits, fastest).map(shared)
        }
        ProfileKind::Logistic => {
            timed::in_time(distance, time, limits, &logistic::ramps, fastest, F::nan()).map(shared)
        }
        ProfileKind::Sine => {
            timed::in_time(distance, time, limits, &sine::ramps, fastest, F::nan()).map(shared)
        }
        ProfileKind::Constant => rule::constant(distance, time, limits).map(shared),
    }
}

/// A ramp from rest, or from the start speed, to the speed `top` in steps/s, in `time` seconds or
/// as fast as the limits allow. A constant speed has no ramp.
pub(crate) fn ramp(
    kind: ProfileKind,
    top: f64,
    time: Option<f64>,
    limits: &Limits<f64>,
) -> Option<Result<SharedCurve, LimitRefusal>> {
    Some(match kind {
        ProfileKind::Ranade => rule::ranade_ramp(top, time, limits).map(shared),
        ProfileKind::Trapezoid => rule::trapezoid_ramp(top, time, limits).map(shared),
        ProfileKind::Scurve => rule::scurve_ramp(top, time, limits).map(shared),
        ProfileKind::Logistic => rule::logistic_ramp(top, time, limits).map(shared),
        ProfileKind::Sine => rule::sine_ramp(top, time, limits).map(shared),
        ProfileKind::Constant => return None,
    })
}

fn shared<F: Real, C: Curve<F> + 'static>(curve: C) -> SharedCurve<F> {
    Arc::new(curve)
}

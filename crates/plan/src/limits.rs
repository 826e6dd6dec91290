//! The limits of an axis, exactly in the gateware's units and as floats for the profiles.
//!
//! The machine file's limits are rounded down, so that a checked plan does not exceed them.

use crate::units;
use carrystep_files::{Axis, AxisLimit};
use carrystep_profile::{Limits, Real};

/// The greatest number of segments of one axis in one move. A move that needs more is refused.
pub(crate) const MOST_SEGMENTS: usize = 1 << 17;

/// Limits in 2^-64 step per tick, per tick^2 and per tick^3, rounded down from the file's decimals.
#[derive(Debug, Clone, Copy)]
pub struct ExactLimits {
    /// Start speed, 2^-64 step per tick.
    pub start_speed: i128,
    /// Speed, 2^-64 step per tick.
    pub speed: i128,
    /// Acceleration, 2^-64 step per tick^2.
    pub acceleration: i128,
    /// Jerk, 2^-64 step per tick^3; `None` if the axis has no jerk limit.
    pub jerk: Option<i128>,
    /// By how much a speed may exceed its limit because floats are rounded, 2^-64 step per tick:
    /// 10^-9 of the speed limit in f64, 64 epsilon of it in f32, plus one unit.
    pub tolerance: i128,
}

impl ExactLimits {
    /// The limits of an axis, for profiles computed in floats of type `F`.
    pub fn new<F: Real>(axis: &Axis) -> Self {
        let speed = axis.speed_limit.units;
        let relative = F::epsilon().to_f64().map_or(1e-9, |epsilon| (epsilon * 64.0).max(1e-9));
        Self {
            start_speed: axis.start_speed.units,
            speed,
            acceleration: axis.accel_limit.units,
            // A jerk limit beyond an i128 limits nothing.
            jerk: axis.jerk_limit.as_ref().map(|jerk| jerk.units).filter(|&j| j < i128::MAX),
            tolerance: (units::float(speed) * relative) as i128 + 1,
        }
    }

    /// The greatest V that a segment may be planned with, 2^-64 step per tick: the speed limit and
    /// half the tolerance. The other half is left for the landing, which may add a unit.
    pub fn fastest(&self) -> i128 {
        self.speed + self.tolerance / 2
    }
}

/// The same limits in steps and seconds, as floats. A missing jerk limit is infinite.
pub(crate) fn float_limits<F: Real>(axis: &Axis) -> Limits<F> {
    let float = |limit: &AxisLimit| F::from(limit.float).unwrap_or_else(F::nan);
    Limits {
        start_speed: float(&axis.start_speed),
        speed: float(&axis.speed_limit),
        acceleration: float(&axis.accel_limit),
        jerk: axis.jerk_limit.as_ref().map_or_else(F::infinity, float),
    }
}

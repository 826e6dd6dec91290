//! The limits of a motor, and the error for a move that exceeds them.
//!
//! The texts of [`Limit`] are the keys of the machine file and may not change.

use crate::profile::{Real, real};
use std::fmt;
use strum::Display;
use thiserror::Error;

/// The limits of one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits<F> {
    /// Greatest speed to which the motor may jump from rest, steps/s; in 0..=speed.
    pub start_speed: F,
    /// Greatest speed, steps/s; over 0.
    pub speed: F,
    /// Greatest acceleration, steps/s^2; over 0.
    pub acceleration: F,
    /// Greatest jerk, steps/s^3; over 0, infinite if there is no limit.
    pub jerk: F,
}

impl<F: Real> Limits<F> {
    /// Whether `time` is below `least`, except for rounding. Both are in seconds.
    ///
    /// Times are compared and not speeds or accelerations. Near a limit these come from differences
    /// of nearly equal numbers, so that the rounding of the time would refuse a valid move.
    pub(crate) fn too_short(&self, time: F, least: F) -> bool {
        time < least * (F::one() - real::<F>(16.0) * F::epsilon())
    }
}

/// A limit of an axis, named by its key in the machine file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Display)]
pub enum Limit {
    /// `start_speed`, steps/s.
    #[strum(to_string = "start_speed")]
    StartSpeed,
    /// `speed_limit`, steps/s.
    #[strum(to_string = "speed_limit")]
    Speed,
    /// `accel_limit`, steps/s^2.
    #[strum(to_string = "accel_limit")]
    Acceleration,
    /// `jerk_limit`, steps/s^3.
    #[strum(to_string = "jerk_limit")]
    Jerk,
}

impl Limit {
    /// The exponent of the second in the limit's unit: 1 for a speed, 2 for an acceleration, 3 for
    /// a jerk.
    pub const fn seconds(self) -> u32 {
        match self {
            Self::StartSpeed | Self::Speed => 1,
            Self::Acceleration => 2,
            Self::Jerk => 3,
        }
    }

    /// The unit of the limit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::StartSpeed | Self::Speed => "steps/s",
            Self::Acceleration => "steps/s^2",
            Self::Jerk => "steps/s^3",
        }
    }
}

/// Why the limits do not allow a move, and the least time in which they would.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub struct LimitRefusal {
    /// The limit that fails.
    pub limit: Limit,
    /// The value that the move needs, in the limit's unit; infinite where no finite value is
    /// enough.
    pub wanted: f64,
    /// The value that the axis has, in the same unit.
    pub available: f64,
    /// Least time that is long enough, seconds; `None` if no time is.
    pub least_time: Option<f64>,
}

impl LimitRefusal {
    pub(crate) fn new<F: Real>(limit: Limit, wanted: F, available: F, least: F) -> Self {
        let float = |x: F| x.to_f64().unwrap_or(f64::NAN);
        Self {
            limit,
            wanted: float(wanted),
            available: float(available),
            least_time: Some(float(least)),
        }
    }

    pub(crate) fn never<F: Real>(limit: Limit, available: F) -> Self {
        let available = available.to_f64().unwrap_or(f64::NAN);
        Self { limit, wanted: f64::INFINITY, available, least_time: None }
    }
}

impl fmt::Display for LimitRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { limit, wanted, available, least_time } = self;
        let unit = limit.unit();
        match least_time {
            Some(least) => {
                write!(
                    f,
                    "needs {wanted:.6} {unit}, over {limit} {available}; at least {least:.9} s would do"
                )
            }
            None => write!(f, "needs a {limit} over {available} {unit}; no time would do without"),
        }
    }
}

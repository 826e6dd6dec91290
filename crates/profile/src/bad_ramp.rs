//! Parameters of a single ramp that contradict each other.

use crate::profile::Real;
use thiserror::Error;

/// Why there is no such ramp, and the nearest values for which there is one.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum BadRamp {
    /// A parameter is not a number, or out of its range.
    #[error("{name} is {value}; it must be {must}")]
    OutOfRange {
        /// Which one, in words.
        name: &'static str,
        /// What it was.
        value: f64,
        /// What it must be, in words.
        must: &'static str,
    },
    /// A logistic ramp whose centre comes so early that it starts above the speed at which it would end.
    #[error(
        "with its centre at {centre} s the logistic ramp has no time: it is past its end when it starts; a centre over {least} s would do"
    )]
    NoRampTime {
        /// The centre asked for, seconds.
        centre: f64,
        /// A centre over this would do, seconds.
        least: f64,
    },
    /// A ramp up that would end slower than it starts.
    #[error("a ramp up from {start} to {end} steps/s; its top speed must be {start} steps/s or more")]
    TopUnderStart {
        /// Speed at the start, steps/s.
        start: f64,
        /// Speed at the end, steps/s.
        end: f64,
    },
}

/// `value`, if it is finite and over 0.
pub(crate) fn positive<F: Real>(name: &'static str, value: F) -> Result<F, BadRamp> {
    in_range(name, value, "finite and over 0", value > F::zero() && value.is_finite())
}

/// `value`, if `holds`.
pub(crate) fn in_range<F: Real>(name: &'static str, value: F, must: &'static str, holds: bool) -> Result<F, BadRamp> {
    if holds { Ok(value) } else { Err(BadRamp::OutOfRange { name, value: wide(value), must }) }
}

pub(crate) fn wide<F: Real>(value: F) -> f64 {
    value.to_f64().unwrap_or(f64::NAN)
}

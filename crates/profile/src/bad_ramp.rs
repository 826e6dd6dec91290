//! The error of contradictory parameters of a single ramp.

use crate::profile::Real;
use thiserror::Error;

/// Why there is no such ramp, and the nearest values for which there is one.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum BadRamp {
    /// A parameter is not a number or out of its range.
    #[error("{name} is {value}; it must be {must}")]
    OutOfRange {
        /// The name of the parameter, in words.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The permitted range, in words.
        must: &'static str,
    },
    /// The centre of a logistic ramp is so early that the ramp starts above its end speed.
    #[error(
        "with its centre at {centre} s the logistic ramp has no time: it is past its end when it starts; a centre over {least} s would do"
    )]
    NoRampTime {
        /// The requested centre, seconds.
        centre: f64,
        /// The centre must be later than this, seconds.
        least: f64,
    },
    /// The end speed of a ramp up is below its start speed.
    #[error(
        "a ramp up from {start} to {end} steps/s; its top speed must be {start} steps/s or more"
    )]
    TopUnderStart {
        /// Speed at the start, steps/s.
        start: f64,
        /// Speed at the end, steps/s.
        end: f64,
    },
}

/// Returns `value` if it is finite and over 0.
pub(crate) fn positive<F: Real>(name: &'static str, value: F) -> Result<F, BadRamp> {
    in_range(name, value, "finite and over 0", value > F::zero() && value.is_finite())
}

/// Returns `value` if `holds`; otherwise the error names the parameter and its range.
pub(crate) fn in_range<F: Real>(
    name: &'static str,
    value: F,
    must: &'static str,
    holds: bool,
) -> Result<F, BadRamp> {
    if holds { Ok(value) } else { Err(BadRamp::OutOfRange { name, value: wide(value), must }) }
}

pub(crate) fn wide<F: Real>(value: F) -> f64 {
    value.to_f64().unwrap_or(f64::NAN)
}

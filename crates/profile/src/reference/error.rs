//! The errors of this crate: why a profile does not exist, and the nearest one that does.
//!
//! The messages are part of the command's interface: transcripts in tests/ quote them.

use crate::reference::row::MOST_ROWS;
use crate::{BadRamp, Limit};
use carrystep_core::ProfileKind;
use thiserror::Error;

/// Why there is no such profile. Every message names a value that works.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ReferenceError {
    /// A number is out of its range.
    #[error("{what} is {value}: it must be {must}")]
    OutOfRange {
        /// The name of the number, in words.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The permitted range, in words.
        must: &'static str,
    },
    /// A length is in millimetres, but the drive has no travel per turn.
    #[error(
        "millimetres need the travel per revolution of the motor; degrees, rpm and steps do without"
    )]
    NoTravel,
    /// A kind lacks a value that it needs.
    #[error("{kind} needs {what}")]
    Missing {
        /// The kind.
        kind: ProfileKind,
        /// The missing value and, if there is one, a suggestion.
        what: String,
    },
    /// A ramp of constant speed was requested.
    #[error("constant has no ramp: it is for whole moves; give it a distance")]
    NoRamp,
    /// The top speed is not above the start speed.
    #[error(
        "the top speed of {top} steps/s is not over the start speed of {start}: a top speed over {start} \
         or a start speed under {top} steps/s would do"
    )]
    TopUnderStart {
        /// Start speed, steps/s.
        start: f64,
        /// Top speed, steps/s.
        top: f64,
    },
    /// A distance ends between two steps.
    #[error("{distance} {unit} is no whole number of steps: {below} or {above} {unit} would do")]
    NotWhole {
        /// The distance as it was given.
        distance: f64,
        /// The unit of the distance.
        unit: String,
        /// The greatest whole number of steps below it, in the same unit.
        below: f64,
        /// The least whole number of steps above it, in the same unit.
        above: f64,
    },
    /// The centre T_i already fixes the start of a logistic ramp, and a second value contradicts
    /// it.
    #[error(
        "the centre T_i fixes a ramp together with its acceleration: {what} besides contradicts it; leave one out"
    )]
    CentreAnd {
        /// The value that contradicts it.
        what: &'static str,
    },
    /// A centre is given where no single logistic ramp is requested.
    #[error("the centre T_i is of a logistic ramp: {what}; leave it out")]
    CentreOf {
        /// What is requested instead.
        what: &'static str,
    },
    /// A limit does not allow the profile, or not in the given time.
    #[error("{kind} cannot be done with {limit} of {available} {unit}: {}", advice(limit, *wanted, unit, *least_time))]
    Refused {
        /// The kind.
        kind: ProfileKind,
        /// The limit that fails, in words.
        limit: &'static str,
        /// The value of the limit, in `unit`.
        available: f64,
        /// The value that the profile needs, in `unit`; infinite where no finite value is enough.
        wanted: f64,
        /// The unit of both values.
        unit: String,
        /// Least time that is long enough, seconds; `None` if no time is.
        least_time: Option<f64>,
    },
    /// The parameters of a ramp contradict each other.
    #[error("{kind} cannot be done: {bad}")]
    Bad {
        /// The kind.
        kind: ProfileKind,
        /// The contradiction.
        bad: BadRamp,
    },
    /// The profile has too many steps to be listed.
    #[error(
        "{kind} has {steps} steps: a list holds at most {MOST_ROWS}; its figures and its plot can be had"
    )]
    TooLong {
        /// The kind.
        kind: ProfileKind,
        /// Its number of steps.
        steps: f64,
    },
}

fn advice(limit: &str, wanted: f64, unit: &str, least_time: Option<f64>) -> String {
    match (wanted.is_finite().then_some(wanted), least_time) {
        (Some(wanted), Some(least)) => {
            format!("it needs at least {wanted} {unit}, or a time of {least} s")
        }
        (None, Some(least)) => format!("it needs a time of {least} s"),
        (Some(wanted), None) => format!("it needs at least {wanted} {unit}"),
        (None, None) => {
            format!(
                "no time would do without a greater {}",
                limit.trim_start_matches("a ").trim_start_matches("an ")
            )
        }
    }
}

/// Rounds a bound up to nine digits, so that a user who enters the printed value is not refused
/// again.
pub(crate) fn up(value: f64) -> f64 {
    rounded(value, 9, f64::ceil)
}

/// Rounds a value to a number of significant digits, with the given rounding function.
pub(crate) fn rounded(value: f64, digits: i32, how: fn(f64) -> f64) -> f64 {
    let unit = digits - 1 - value.abs().log10().floor() as i32;
    let scaled = |unit: i32| {
        if unit < 0 {
            how(value / 10_f64.powi(-unit)) * 10_f64.powi(-unit)
        } else {
            how(value * 10_f64.powi(unit)) / 10_f64.powi(unit)
        }
    };
    if value.is_normal() && unit.abs() < 300 { scaled(unit) } else { value }
}

/// The name of a limit in words and the power of seconds in its unit. The command line does not use
/// the keys of the machine file.
pub(crate) const fn in_words(limit: Limit) -> (&'static str, u32) {
    match limit {
        Limit::StartSpeed => ("a start speed", 1),
        Limit::Speed => ("a speed limit", 1),
        Limit::Acceleration => ("an acceleration limit", 2),
        Limit::Jerk => ("a jerk limit", 3),
    }
}

//! Why there is no such profile, and the nearest that there is.

use crate::reference::kind::Kind;
use crate::reference::row::MOST_ROWS;
use crate::{BadRamp, Limit};
use thiserror::Error;

/// Why there is no such profile. Every message says what would do.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ReferenceError {
    /// A number that means nothing where it stands.
    #[error("{what} is {value}: it must be {must}")]
    OutOfRange {
        /// Which one, in words.
        what: &'static str,
        /// What it is.
        value: f64,
        /// What it must be, in words.
        must: &'static str,
    },
    /// A length in millimetres, of a motor alone.
    #[error("millimetres need the travel per revolution of the motor; degrees, rpm and steps do without")]
    NoTravel,
    /// Something that a kind cannot do without.
    #[error("{kind} needs {what}")]
    Missing {
        /// The kind.
        kind: Kind,
        /// What it needs, and what would do.
        what: String,
    },
    /// A ramp at one speed.
    #[error("constant has no ramp: it is for whole moves; give it a distance")]
    NoRamp,
    /// No rise.
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
    /// A distance that ends between two steps.
    #[error("{distance} {unit} is no whole number of steps: {below} or {above} {unit} would do")]
    NotWhole {
        /// As it was given.
        distance: f64,
        /// The unit.
        unit: String,
        /// The greatest below that is whole.
        below: f64,
        /// The least above that is whole.
        above: f64,
    },
    /// The centre T_i fixes where a logistic ramp begins, and something else would too.
    #[error("the centre T_i fixes a ramp together with its acceleration: {what} besides contradicts it; leave one out")]
    CentreAnd {
        /// What else would.
        what: &'static str,
    },
    /// A centre where no single logistic ramp is asked for.
    #[error("the centre T_i is of a logistic ramp: {what}; leave it out")]
    CentreOf {
        /// What is asked instead.
        what: &'static str,
    },
    /// A limit that does not let a profile be done, or not in the time.
    #[error("{kind} cannot be done with {limit} of {available} {unit}: {}", advice(limit, *wanted, unit, *least_time))]
    Refused {
        /// The kind.
        kind: Kind,
        /// The limit that fails, in words.
        limit: &'static str,
        /// What it is.
        available: f64,
        /// What would do; infinite where no finite value would.
        wanted: f64,
        /// The unit of both.
        unit: String,
        /// Least time that would do, seconds; `None` where no time would.
        least_time: Option<f64>,
    },
    /// A ramp that contradicts itself.
    #[error("{kind} cannot be done: {bad}")]
    Bad {
        /// The kind.
        kind: Kind,
        /// Why.
        bad: BadRamp,
    },
    /// Too much to list.
    #[error("{kind} has {steps} steps: a list holds at most {MOST_ROWS}; its figures and its plot can be had")]
    TooLong {
        /// The kind.
        kind: Kind,
        /// Its steps.
        steps: f64,
    },
}

fn advice(limit: &str, wanted: f64, unit: &str, least_time: Option<f64>) -> String {
    match (wanted.is_finite().then_some(wanted), least_time) {
        (Some(wanted), Some(least)) => format!("it needs at least {wanted} {unit}, or a time of {least} s"),
        (None, Some(least)) => format!("it needs a time of {least} s"),
        (Some(wanted), None) => format!("it needs at least {wanted} {unit}"),
        (None, None) => {
            format!("no time would do without a greater {}", limit.trim_start_matches("a ").trim_start_matches("an "))
        }
    }
}

/// Nine digits of a bound, rounded up: who takes them at their word is not refused again.
pub(crate) fn up(value: f64) -> f64 {
    rounded(value, 9, f64::ceil)
}

/// So many digits of a value.
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

/// A limit in words; the command line has no keys of a machine file.
pub(crate) const fn in_words(limit: Limit) -> (&'static str, u32) {
    match limit {
        Limit::StartSpeed => ("a start speed", 1),
        Limit::Speed => ("a speed limit", 1),
        Limit::Acceleration => ("an acceleration limit", 2),
        Limit::Jerk => ("a jerk limit", 3),
    }
}

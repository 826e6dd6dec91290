//! Why there is no such profile, and the nearest that there is.

use crate::kind::Kind;
use crate::row::MOST_ROWS;
use carrystep_profile::{BadRamp, Limit, Refusal};
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
    #[error("{distance} are {steps} steps: {below} ({below_steps} steps) or {above} ({above_steps} steps) would do")]
    NotWhole {
        /// As it was given.
        distance: String,
        /// In steps.
        steps: f64,
        /// The greatest below that is whole.
        below: String,
        /// The same in steps.
        below_steps: f64,
        /// The least above that is whole.
        above: String,
        /// The same in steps.
        above_steps: f64,
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
    /// A limit that does not let a profile be done in the time.
    #[error("{kind} cannot be done: {}", told(refusal))]
    Refused {
        /// The kind.
        kind: Kind,
        /// Limit and least time.
        refusal: Refusal,
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

/// A refusal in words; the command line has no keys of a machine file.
fn told(refusal: &Refusal) -> String {
    let Refusal { limit, wanted, available, least_time } = *refusal;
    let (name, unit) = (in_words(limit), limit.unit());
    match least_time {
        Some(least) => format!(
            "it needs {wanted:.6} {unit}, over the {name} of {available} {unit}; that {name}, or a time of at least {least:.9} s, would do"
        ),
        None => format!("it needs a {name} over {available} {unit}; no time would do without"),
    }
}

const fn in_words(limit: Limit) -> &'static str {
    match limit {
        Limit::StartSpeed => "start speed",
        Limit::Speed => "speed limit",
        Limit::Acceleration => "acceleration limit",
        Limit::Jerk => "jerk limit",
    }
}

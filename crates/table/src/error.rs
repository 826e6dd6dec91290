//! Why a table cannot be, and the nearest that can.

use thiserror::Error;

/// Why a table cannot be made as asked. Every message says what would do.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TableError {
    /// A number that means nothing here.
    #[error("{parameter} is {value}: {needed} is needed")]
    Unusable {
        /// Its name.
        parameter: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        needed: &'static str,
    },
    /// A number outside its range, limits not included below, included above.
    #[error("{parameter} is {value}: over 0 and at most {most} is needed")]
    NotPositive {
        /// Its name.
        parameter: &'static str,
        /// What it is.
        value: f64,
        /// The greatest that can be.
        most: f64,
    },
    /// A count outside its range.
    #[error("{parameter} is {value}: {least} to {most} is needed; the nearest is {}", nearest(*value, *least, *most))]
    Count {
        /// Its name.
        parameter: &'static str,
        /// What it is.
        value: u32,
        /// The least that can be.
        least: u32,
        /// The greatest that can be.
        most: u32,
    },
    /// Nothing to rise to.
    #[error(
        "a top speed of {top} steps/s is not over the start frequency of {start} steps/s: \
         a top speed over {start} steps/s ({start_rpm} rpm) or a start frequency under {top} steps/s would do"
    )]
    TopUnderStart {
        /// Start frequency, steps/s.
        start: f64,
        /// Top speed, steps/s.
        top: f64,
        /// The start frequency in rpm.
        start_rpm: f64,
    },
    /// The timer has no such prescaler.
    #[error("the timer has no prescaler {prescaler}: it has {}", list(available))]
    Prescaler {
        /// What was asked.
        prescaler: u32,
        /// What there is.
        available: Vec<u32>,
    },
    /// A delay is longer than the timer can wait.
    #[error(
        "the slowest entry waits {counts:.0} counts, the {bits}-bit timer at most {most}: {}",
        slow_advice(*prescaler, *start)
    )]
    TooSlow {
        /// The longest delay, counts.
        counts: f64,
        /// What the timer can wait, counts.
        most: u32,
        /// Width of the timer.
        bits: u32,
        /// The smallest prescaler with which the whole table fits.
        prescaler: Option<u32>,
        /// The least start frequency that surely does with the best prescaler there is, steps/s; none
        /// where the top speed itself is too slow.
        start: Option<f64>,
    },
    /// A delay is shorter than the timer or the interrupt allows.
    #[error(
        "the top speed waits {counts:.2} counts, at least {least} are needed: {}",
        fast_advice(*prescaler, *speed)
    )]
    TooFast {
        /// The shortest delay, counts.
        counts: f64,
        /// What the timer and the interrupt need, counts.
        least: u32,
        /// The smallest prescaler with which the whole table fits.
        prescaler: Option<u32>,
        /// The greatest top speed that surely does with the smallest prescaler, steps/s.
        speed: f64,
    },
    /// The entries or steps do not divide into the groups.
    #[error("{length} {what} do not divide into groups of {unit}: {} would do", nearest_multiples(*length, *unit))]
    Groups {
        /// "entries" or "ramp steps".
        what: &'static str,
        /// How many there are.
        length: u32,
        /// What they must be a multiple of.
        unit: u32,
    },
    /// More entries than the player can count.
    #[error("the table would have {entries} entries, at most {most} can be: more pulses per entry would do")]
    TooLong {
        /// Entries.
        entries: usize,
        /// The greatest number that can be.
        most: u32,
    },
    /// The ramp has more pulses than the player can count.
    #[error("the ramp would have {pulses} pulses, at most {} can be: fewer pulses per entry would do", u32::MAX - 1)]
    TooManyPulses {
        /// Pulses.
        pulses: u64,
    },
    /// An entry lasts more pulses than the player can count.
    #[error("an entry would last {pulses} pulses, at most 65535 can be: a time of at most {seconds:.6} s would do")]
    TooManyPerEntry {
        /// Pulses.
        pulses: u32,
        /// The longest time that surely does, seconds.
        seconds: f64,
    },
    /// The inverse table tells times from rest.
    #[error("the inverse table is for ramps from rest: start_frequency is {start}, 0 or no inverse table would do")]
    InverseFromRest {
        /// Start frequency, steps/s.
        start: f64,
    },
    /// A name that C does not take.
    #[error("{name:?} is no name for a table: a letter, then up to 47 letters, digits or underscores")]
    Name {
        /// What was asked.
        name: String,
    },
}

/// Whether `value` is over 0 and at most `most`.
pub(crate) fn positive(parameter: &'static str, value: f64, most: f64) -> Result<(), TableError> {
    if value > 0.0 && value <= most { Ok(()) } else { Err(TableError::NotPositive { parameter, value, most }) }
}

fn nearest(value: u32, least: u32, most: u32) -> u32 {
    value.clamp(least, most)
}

fn list(values: &[u32]) -> String {
    let words: Vec<String> = values.iter().map(u32::to_string).collect();
    if words.is_empty() { "none".to_owned() } else { words.join(", ") }
}

fn slow_advice(prescaler: Option<u32>, start: Option<f64>) -> String {
    match (prescaler, start) {
        (Some(prescaler), _) => format!("prescaler {prescaler} would do"),
        (None, Some(start)) => {
            format!(
                "no prescaler spans the whole ramp; a start frequency of {start:.3} steps/s would do, with the greatest prescaler that the top speed allows"
            )
        }
        (None, None) => {
            "no prescaler would do, not even for the top speed; a faster one or a slower clock would".to_owned()
        }
    }
}

fn fast_advice(prescaler: Option<u32>, speed: f64) -> String {
    match prescaler {
        Some(prescaler) => format!("prescaler {prescaler} would do"),
        None => format!(
            "no prescaler would do; a top speed of {speed:.3} steps/s or less would, with the smallest prescaler"
        ),
    }
}

fn nearest_multiples(length: u32, unit: u32) -> String {
    let under = length / unit.max(1) * unit;
    let over = u64::from(under) + u64::from(unit);
    if under == 0 { format!("{over}") } else { format!("{under} or {over}") }
}

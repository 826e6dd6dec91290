//! The errors of this crate: why a table is not possible, and the nearest one that is.
//!
//! The messages are part of the command's interface: transcripts in tests/ quote them.

use thiserror::Error;

/// Why a table is not possible as requested. Every message names a value that works.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TableError {
    /// A number is outside the range that makes sense for it.
    #[error("{parameter} is {value}: {needed} is needed")]
    Unusable {
        /// The name of the parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
        /// The permitted range, in words.
        needed: &'static str,
    },
    /// A number is outside its range, which excludes 0 and includes `most`.
    #[error("{parameter} is {value}: over 0 and at most {most} is needed")]
    NotPositive {
        /// The name of the parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
        /// The greatest permitted value.
        most: f64,
    },
    /// A count is outside its range.
    #[error("{parameter} is {value}: {least} to {most} is needed; the nearest is {}", nearest(*value, *least, *most))]
    Count {
        /// The name of the parameter.
        parameter: &'static str,
        /// Its value.
        value: u32,
        /// The least permitted value.
        least: u32,
        /// The greatest permitted value.
        most: u32,
    },
    /// The top speed is not above the start frequency.
    #[error(
        "a top speed of {top} steps/s is not over the start frequency of {start} steps/s: \
         a top speed over {start} steps/s ({start_rpm} rpm) or a start frequency under {top} steps/s would do"
    )]
    TopUnderStart {
        /// Start frequency, steps/s.
        start: f64,
        /// Top speed, steps/s.
        top: f64,
        /// Start frequency, rpm.
        start_rpm: f64,
    },
    /// The timer does not have the requested prescaler.
    #[error("the timer has no prescaler {prescaler}: it has {}", list(available))]
    Prescaler {
        /// The requested prescaler.
        prescaler: u32,
        /// The prescalers of the timer.
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
        /// The longest wait of the timer, counts.
        most: u32,
        /// Width of the timer, bits.
        bits: u32,
        /// The smallest prescaler with which the whole table fits, if there is one.
        prescaler: Option<u32>,
        /// A start frequency that works with the best prescaler of the timer, steps/s; `None` if
        /// the top speed itself is too slow.
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
        /// The shortest delay that the timer and the interrupt allow, counts.
        least: u32,
        /// The smallest prescaler with which the whole table fits, if there is one.
        prescaler: Option<u32>,
        /// The greatest top speed that works with the smallest prescaler, steps/s.
        speed: f64,
    },
    /// The number of entries or steps is not a multiple of the size of the groups.
    #[error("{length} {what} do not divide into groups of {unit}: {} would do", nearest_multiples(*length, *unit))]
    Groups {
        /// Either "entries" or "ramp steps".
        what: &'static str,
        /// The number of entries or steps.
        length: u32,
        /// The number that it must be a multiple of.
        unit: u32,
    },
    /// The table has more entries than the player can count.
    #[error(
        "the table would have {entries} entries, at most {most} can be: more pulses per entry would do"
    )]
    TooLong {
        /// Number of entries.
        entries: usize,
        /// The greatest possible number of entries.
        most: u32,
    },
    /// The ramp has more pulses than the player can count.
    #[error("the ramp would have {pulses} pulses, at most {} can be: fewer pulses per entry would do", u32::MAX - 1)]
    TooManyPulses {
        /// Number of pulses.
        pulses: u64,
    },
    /// An entry lasts more pulses than the player can count.
    #[error(
        "an entry would last {pulses} pulses, at most 65535 can be: a time of at most {seconds:.6} s would do"
    )]
    TooManyPerEntry {
        /// Number of pulses.
        pulses: u32,
        /// The longest time per entry that works, seconds.
        seconds: f64,
    },
    /// An inverse table is requested for a ramp that does not start from rest.
    #[error(
        "the inverse table is for ramps from rest: start_frequency is {start}, 0 or no inverse table would do"
    )]
    InverseFromRest {
        /// Start frequency, steps/s.
        start: f64,
    },
    /// The name is not a valid C identifier, or too long.
    #[error(
        "{name:?} is no name for a table: a letter, then up to 47 letters, digits or underscores"
    )]
    Name {
        /// The requested name.
        name: String,
    },
}

/// Checks that `value` is over 0 and at most `most`.
pub(crate) fn positive(parameter: &'static str, value: f64, most: f64) -> Result<(), TableError> {
    if value > 0.0 && value <= most {
        Ok(())
    } else {
        Err(TableError::NotPositive { parameter, value, most })
    }
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

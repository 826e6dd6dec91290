//! What can go wrong with a capture or with what is written about it.

use std::io;
use thiserror::Error;

/// A capture cannot be read, or an output cannot be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TraceError {
    /// A VCD cannot be used.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A file cannot be written.
    #[error("cannot write {what}: {source}")]
    Write {
        /// VCD, CSV, ...
        what: &'static str,
        /// Why.
        source: io::Error,
    },
    /// A picture cannot be drawn.
    #[error("cannot draw the plot: {0}")]
    Plot(String),
    /// A save file cannot be made from its template.
    #[error("cannot make the GTKWave save file: {0}")]
    Template(#[from] minijinja::Error),
}

impl TraceError {
    pub(crate) fn csv(source: csv::Error) -> Self {
        Self::Write { what: "the CSV", source: source.into() }
    }
}

/// Why a VCD cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file itself cannot be read.
    #[error("cannot read the capture: {0}")]
    Io(#[source] io::Error),
    /// It is not VCD.
    #[error("line {line} of the capture: {message}")]
    Syntax {
        /// Line, from 1.
        line: u64,
        /// What is wrong.
        message: String,
    },
    /// It ends too early.
    #[error("the capture is cut off at line {line}: {missing}")]
    Truncated {
        /// Line, from 1.
        line: u64,
        /// What should have come.
        missing: &'static str,
    },
    /// There is no `$timescale`.
    #[error("the capture has no $timescale: its unit of time is unknown")]
    NoTimescale,
    /// A unit of time that VCD does not have.
    #[error("line {line} of the capture: a $timescale of {quantity}; VCD has 1, 10 and 100")]
    Timescale {
        /// Line, from 1.
        line: u64,
        /// So many ps, ns, ...
        quantity: u32,
    },
    /// A signal that is no pin, or a vector that is not one pin an axis.
    #[error("the signal {signal} of the capture has {bits} bits, {wanted}; name a bit of it with --map")]
    Width {
        /// Its path.
        signal: String,
        /// As the capture declares it.
        bits: u32,
        /// What it should have.
        wanted: String,
    },
    /// A time before the one that came last.
    #[error("line {line} of the capture: time goes back from {from} to {to}")]
    TimeBackwards {
        /// Line, from 1.
        line: u64,
        /// The time that was reached, in the file's unit.
        from: u64,
        /// The time that follows it.
        to: u64,
    },
    /// A time that does not fit into 64 bits of ps.
    #[error("line {line} of the capture: time {time} is more than half a year")]
    TimeRange {
        /// Line, from 1.
        line: u64,
        /// The time, in the file's unit.
        time: u64,
    },
    /// A signal that was asked for is not there.
    #[error("the capture has no signal {wanted}; {}", candidates(.found))]
    NoSignal {
        /// What was looked for.
        wanted: String,
        /// Some of what is there.
        found: Vec<String>,
    },
    /// Several signals fit.
    #[error("several signals of the capture could be {wanted}: {}; name one", .found.join(", "))]
    Ambiguous {
        /// What was looked for.
        wanted: String,
        /// What fits.
        found: Vec<String>,
    },
    /// A `$scope` that never ends, or one too deep to be real.
    #[error("line {line} of the capture: scopes nested deeper than {limit}")]
    Depth {
        /// Line, from 1.
        line: u64,
        /// The greatest depth.
        limit: usize,
    },
    /// A line of an explicit map of signals that cannot be understood.
    #[error("signal map '{entry}': {message}")]
    Map {
        /// The line.
        entry: String,
        /// What is wrong with it.
        message: String,
    },
}

fn candidates(found: &[String]) -> String {
    if found.is_empty() { "it has no signals at all".to_owned() } else { format!("it has {}", found.join(", ")) }
}

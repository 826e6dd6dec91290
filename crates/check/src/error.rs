//! The errors of reading captures and of writing outputs.
//!
//! The messages are part of the command's interface: transcripts in tests/ quote them.

use carrystep_files::InputFailure;
use std::io;
use thiserror::Error;

/// A capture cannot be read, or an output cannot be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TraceError {
    /// A VCD cannot be used.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A capture cannot be opened.
    #[error(transparent)]
    Open(#[from] InputFailure),
    /// A slice was not cut from this capture.
    #[error("slice {number} is of another capture, or the capture was changed since")]
    OtherCapture {
        /// Number of the slice.
        number: u64,
    },
    /// A slice does not begin where the one before it ends.
    #[error("slice {number} does not begin where the one before it ends: check all slices again")]
    NotInOrder {
        /// Number of the slice.
        number: u64,
    },
    /// A slice begins at an earlier time than that at which the one before it ends.
    #[error("time goes back from {from} ps to {to} ps where slice {number} begins")]
    TimeBackwards {
        /// Number of the slice.
        number: u64,
        /// The last time before, ps.
        from: u64,
        /// The time that follows it, ps.
        to: u64,
    },
    /// A file cannot be written.
    #[error("cannot write {what}: {source}")]
    Write {
        /// The kind of file: VCD, CSV and so on.
        what: &'static str,
        /// The error of the system.
        source: io::Error,
    },
    /// A picture cannot be drawn.
    #[error("cannot draw the plot: {0}")]
    Plot(String),
    /// A save file cannot be rendered from its template.
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
    /// The file is not a VCD.
    #[error("line {line} of the capture: {message}")]
    Syntax {
        /// Line, counted from 1.
        line: u64,
        /// What is wrong, in words.
        message: String,
    },
    /// The file ends too early.
    #[error("the capture is cut off at line {line}: {missing}")]
    Truncated {
        /// Line, counted from 1.
        line: u64,
        /// The part that is missing, in words.
        missing: &'static str,
    },
    /// The file is a waveform of carrystep that does not show the whole run.
    #[error(
        "it shows only a part of a run (--from, --to or --axes of simulate); a check needs all pulses"
    )]
    Part,
    /// The file has no `$timescale`.
    #[error("the capture has no $timescale: its unit of time is unknown")]
    NoTimescale,
    /// The `$timescale` has a number that VCD does not allow.
    #[error("line {line} of the capture: a $timescale of {quantity}; VCD has 1, 10 and 100")]
    Timescale {
        /// Line, counted from 1.
        line: u64,
        /// The number in front of the unit.
        quantity: u32,
    },
    /// A signal is too wide for a pin, or a vector does not have one pin per axis.
    #[error(
        "the signal {signal} of the capture has {bits} bits, {wanted}; name a bit of it with --map"
    )]
    Width {
        /// The path of the signal.
        signal: String,
        /// Its width in the capture, bits.
        bits: u32,
        /// The required width, in words.
        wanted: String,
    },
    /// A time is before the previous one.
    #[error("line {line} of the capture: time goes back from {from} to {to}")]
    TimeBackwards {
        /// Line, counted from 1.
        line: u64,
        /// The previous time, in the file's unit.
        from: u64,
        /// The time that follows it, in the file's unit.
        to: u64,
    },
    /// A time does not fit into 64 bits of ps.
    #[error("line {line} of the capture: time {time} is more than half a year")]
    TimeRange {
        /// Line, counted from 1.
        line: u64,
        /// The time, in the file's unit.
        time: u64,
    },
    /// A required signal is missing.
    #[error("the capture has no signal {wanted}; {}", candidates(.found))]
    NoSignal {
        /// The signal that is missing.
        wanted: String,
        /// Some of the signals in the capture.
        found: Vec<String>,
    },
    /// Several signals match.
    #[error("several signals of the capture could be {wanted}: {}; name one", .found.join(", "))]
    Ambiguous {
        /// The signal that was searched.
        wanted: String,
        /// The signals that match.
        found: Vec<String>,
    },
    /// Scopes are nested too deeply; a `$scope` may lack its end.
    #[error("line {line} of the capture: scopes nested deeper than {limit}")]
    Depth {
        /// Line, counted from 1.
        line: u64,
        /// The greatest permitted depth.
        limit: usize,
    },
    /// An entry of the signal map cannot be understood.
    #[error("signal map '{entry}': {message}")]
    Map {
        /// The entry.
        entry: String,
        /// What is wrong with it, in words.
        message: String,
    },
}

impl ReadError {
    /// The error with so many lines added to its line.
    #[must_use]
    pub(crate) fn later(mut self, lines: u64) -> Self {
        match &mut self {
            Self::Syntax { line, .. }
            | Self::Truncated { line, .. }
            | Self::Timescale { line, .. }
            | Self::TimeBackwards { line, .. }
            | Self::TimeRange { line, .. }
            | Self::Depth { line, .. } => *line += lines,
            _ => {}
        }
        self
    }
}

fn candidates(found: &[String]) -> String {
    if found.is_empty() {
        "it has no signals at all".to_owned()
    } else {
        format!("it has {}", found.join(", "))
    }
}

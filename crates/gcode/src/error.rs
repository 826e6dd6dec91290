//! What can be wrong with a program: the mistake ([`kind`]), its file, line and column, and what to
//! do about it ([`help`]).

mod help;
mod kind;

pub use kind::ErrorKind;
pub(crate) use kind::short;

use std::fmt;
use std::sync::Arc;
use thiserror::Error;

/// A program that cannot be run.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct GcodeError {
    /// Name of the file, as the caller gave it.
    pub file: Arc<str>,
    /// Line in the file, from 1; 0 if the mistake belongs to the whole file.
    pub line: u64,
    /// Column in characters, from 1; 0 if the mistake belongs to the whole line.
    pub column: u32,
    /// The mistake.
    pub kind: ErrorKind,
}

impl fmt::Display for GcodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        for number in [self.line, self.column.into()].into_iter().take_while(|&number| number > 0) {
            write!(f, ":{number}")?;
        }
        write!(f, ": {}\n  help: {}", self.kind, self.kind.help())
    }
}

/// A mistake in a line, before the file and the line are known.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fault {
    /// Column in characters, from 1; 0 for the whole line.
    pub(crate) column: u32,
    pub(crate) kind: ErrorKind,
    /// File and line, if they are not those that are being executed.
    pub(crate) elsewhere: Option<Box<(Arc<str>, u64)>>,
}

impl Fault {
    pub(crate) fn new(column: u32, kind: ErrorKind) -> Self {
        Self { column, kind, elsewhere: None }
    }
}

impl From<GcodeError> for Fault {
    fn from(error: GcodeError) -> Self {
        let elsewhere = Some(Box::new((error.file, error.line)));
        Self { column: error.column, kind: error.kind, elsewhere }
    }
}

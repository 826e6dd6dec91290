//! Profiles as CSV: one line a step.

use crate::reference::curve::Reference;
use crate::reference::error::ReferenceError;
use crate::reference::row::Listing;
use std::io::{self, Write};
use thiserror::Error;

/// Why a CSV cannot be written.
#[derive(Debug, Error)]
pub enum CsvError {
    /// There is no such list.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// It cannot be written.
    #[error("cannot write the CSV: {0}")]
    Write(#[from] io::Error),
}

impl From<csv::Error> for CsvError {
    fn from(error: csv::Error) -> Self {
        Self::Write(error.into())
    }
}

/// Writes all steps of all profiles, one after the other; with a clock delays in its counts too.
///
/// The numbers are the shortest that read back as the same double.
///
/// # Errors
/// A profile too long to list, a clock that is none, a writer that fails.
pub fn write_csv(out: impl Write, references: &[Reference], listing: &Listing) -> Result<(), CsvError> {
    // Before the first byte: whether all can be listed.
    references.iter().try_for_each(|reference| reference.rows(listing).map(|_| ()))?;
    let mut out = csv::Writer::from_writer(out);
    let counted = listing.clock_hz.map(|_| "delay_counts");
    let head = ["kind", "step", "time_s", "speed_steps_per_s", "delay_s"];
    out.write_record(head.into_iter().chain(counted))?;
    for reference in references {
        for row in reference.rows(listing)? {
            let text = |value: Option<String>| value.unwrap_or_default();
            let fields = [
                reference.kind().to_string(),
                row.step.to_string(),
                row.time_s.to_string(),
                row.speed_steps_per_s.to_string(),
                text(row.delay_s.map(|delay| delay.to_string())),
            ];
            let counts = counted.map(|_| text(row.delay_counts.map(|counts| counts.to_string())));
            out.write_record(fields.into_iter().chain(counts))?;
        }
    }
    Ok(out.flush()?)
}

//! Writes profiles as CSV, one line per step.
//!
//! The names of the columns are part of the command's interface.

use crate::reference::curve::Reference;
use crate::reference::error::ReferenceError;
use crate::reference::row::Listing;
use std::io::{self, Write};
use thiserror::Error;

/// Why a CSV cannot be written.
#[derive(Debug, Error)]
pub enum CsvError {
    /// A profile cannot be listed.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// The writer fails.
    #[error("cannot write the CSV: {0}")]
    Write(#[from] io::Error),
}

impl From<csv::Error> for CsvError {
    fn from(error: csv::Error) -> Self {
        Self::Write(error.into())
    }
}

/// Writes all steps of all profiles, one profile after the other. If the listing has a clock, each
/// line also has the delay in counts of that clock.
///
/// Each number is the shortest decimal that reads back as the same double.
///
/// # Errors
/// [`CsvError::Reference`] if a profile has too many steps or the clock is out of range; nothing is
/// written in that case. [`CsvError::Write`] if the writer fails.
pub fn write_csv(
    out: impl Write,
    references: &[Reference],
    listing: &Listing,
) -> Result<(), CsvError> {
    // All profiles are checked before the first byte is written.
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

//! Reads and writes the user's files safely.
//!
//! - An input must be a regular file ([`read_text`], [`open`]), because a device or a pipe could
//!   block or never end.
//! - An output ([`NewFile`]) appears under its name when it is complete, and otherwise not at all.
//! - No output replaces a file that the same process reads, and no two outputs are the same file.
//!   Files are compared by device and inode and not by name. This crate registers every input and
//!   every output when it is opened, so that no command can omit the comparison.

mod input;
mod names;
mod output;
mod place;
mod registry;

pub use input::{InputFailure, MAX_TEXT_BYTES, open, read_text};
pub use names::{did_you_mean, nearest};
pub use output::{Claim, NewFile, OutputFailure};

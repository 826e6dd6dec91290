//! Files of the user: machine and move files with their units, ranges and errors, and outputs.
//!
//! A machine file is read into a [`Machine`], a move file into a [`MoveFile`]. What is wrong in one
//! is an [`InputError`] with the line and column where it stands.
//!
//! - An input is a regular file ([`read_text`], [`open`]): a device or a pipe could block or never end.
//! - An output ([`NewFile`]) appears under its name when it is whole, and not at all otherwise.
//! - No output replaces a file that the same process reads, and no two outputs are one file. Both are
//!   found by what the file is (device and inode), not by its name. Every input and every output of the
//!   process is registered when it is opened here, so no command can forget to compare them.

pub mod decimal;
pub mod driver;
pub mod error;
mod input;
pub mod machine;
pub mod move_file;
mod names;
mod number;
mod output;
mod place;
mod registry;
pub mod unit;

pub use bigdecimal::BigDecimal;
pub use error::{InputError, Source};
pub use input::{InputFailure, MAX_TEXT_BYTES, open, read_text};
pub use machine::{Axis, Machine, TooManyAxes};
pub use move_file::{Move, MoveFile, PathKind, ProfileKind};
pub use names::{did_you_mean, nearest};
pub use output::{Claim, NewFile, OutputFailure};
pub use unit::Unit;

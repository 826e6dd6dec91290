//! Reads and writes the user's files safely: machine and move files, and outputs.
//!
//! A machine file is read into a [`Machine`], a move file into a [`MoveFile`], or, if it may be
//! long, into a [`MoveSource`]. What is wrong in one
//! is an [`InputError`] with the line and column where it stands.
//!
//! - An input must be a regular file ([`read_text`], [`open`]), because a device or a pipe could
//!   block or never end.
//! - An output ([`NewFile`]) appears under its name when it is complete, and otherwise not at all.
//! - A [`StateFile`] is replaced again and again, and always holds a whole state.
//! - No output replaces a file that the same process reads, and no two outputs are the same file.
//!   Files are compared by device and inode and not by name. This crate registers every input and
//!   every output when it is opened, so that no command can omit the comparison.

mod cache;
pub mod decimal;
pub mod driver;
pub mod error;
mod input;
mod long_file;
pub mod machine;
mod made_folders;
pub mod move_file;
mod moves;
mod names;
mod number;
mod output;
mod place;
mod registry;
pub mod sealed;
mod state_file;
mod toml_lines;
pub mod unit;
mod unnamed;

pub use bigdecimal::BigDecimal;
pub use cache::{CacheFailure, cache_folder, cache_folder_of, cache_holds};
pub use error::{InputError, SourceText};
pub use input::{InputFailure, MAX_TEXT_BYTES, open, read_text};
pub use machine::{Axis, AxisLimit, Machine, TooManyAxes};
pub use move_file::{Move, MoveFile, MovePlace, PathKind};
pub use moves::{MoveSource, Moves};
pub use names::{did_you_mean, nearest};
pub use output::{NewFile, OutputClaim, OutputFailure};
pub use state_file::{StateFailure, StateFile};
pub use unit::Unit;

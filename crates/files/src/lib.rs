//! Files of the user, read and written with care.
//!
//! - An input is a regular file ([`read_text`], [`open`]): a device or a pipe could block or never end.
//! - An output ([`NewFile`]) appears under its name when it is whole, and not at all otherwise.
//! - No output replaces a file that the same process reads, and no two outputs are one file. Both are
//!   found by what the file is (device and inode), not by its name. Every input and every output of the
//!   process is registered when it is opened here, so no command can forget to compare them.

mod cache;
mod input;
mod names;
mod output;
mod place;
mod registry;

pub use cache::{CacheFailure, cache_folder, cache_folder_of, cache_holds};
pub use input::{InputFailure, MAX_TEXT_BYTES, open, read_text};
pub use names::{did_you_mean, nearest};
pub use output::{Claim, NewFile, OutputFailure};

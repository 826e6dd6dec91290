//! Sweeps: one move file with blanks, many ways to fill them in, and the worst that comes of it.
//!
//! A case is its number: case i of a sweep is the same on every machine and in every shard, so that shards
//! can run anywhere, and their reports add up.

mod file;
mod report;
mod run;
mod shard;

pub use file::{Case, SweepError, SweepFile, Values};
pub use report::{Failed, Report, Verdict, Worst};
pub use run::run;
pub use shard::Shard;

//! Sweeps: one move file with placeholders, many ways to fill them, and the worst figures that
//! result.
//!
//! A case is identified by its number: case i of a sweep is the same on every machine and in every
//! shard. Shards can therefore run anywhere, and their reports can be merged.

mod file;
mod report;
mod run;
mod shard;

pub use file::{Case, SweepError, SweepFile, Values};
pub use report::{CaseVerdict, FailedCase, SweepReport, Worst};
pub use run::run;
pub use shard::Shard;

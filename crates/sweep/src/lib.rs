//! Sweeps: one move file with placeholders, many ways to fill them, and the worst figures that
//! result.
//!
//! A case is identified by its number: case i of a sweep is the same on every machine and in every
//! shard. Shards can therefore run anywhere, and their reports can be merged. A shard that keeps
//! its progress in a file can be killed and started again. [`Cluster`] writes the files with which
//! other programs start the shards of a sweep on many machines.

mod cluster;
mod difference;
mod error;
mod file;
mod kept;
mod merge;
mod progress;
mod report;
mod run;
mod shard;

pub use cluster::{Cluster, ClusterFile};
pub use difference::Difference;
pub use error::{PartFault, SweepError, Unfinished};
pub use file::{Case, SweepFile, Values};
pub use kept::KeptShard;
pub use merge::Part;
pub use progress::Progress;
pub use report::{CaseVerdict, FailedCase, JudgedBy, SweepReport, Worst};
pub use run::run;
pub use shard::Shard;

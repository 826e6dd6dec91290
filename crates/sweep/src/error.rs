//! Why a sweep cannot run, or why its parts cannot be merged.

use crate::difference::Difference;
use crate::shard::Shard;
use carrystep_files::{InputError, InputFailure, StateFailure};
use std::fmt;
use thiserror::Error;

/// Why a sweep cannot run, or why its parts cannot be merged.
#[derive(Debug, Error)]
pub enum SweepError {
    /// The file cannot be read.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The file is not a sweep file.
    #[error("{path}: {message}")]
    Format {
        /// The path of the file.
        path: String,
        /// What is wrong with it, in words.
        message: String,
    },
    /// The sample has no cases.
    #[error("--sample 0 tries nothing: give at least 1")]
    NothingToTry,
    /// A report, or the file in which a shard keeps its progress, cannot be used.
    #[error("{path}: {fault}")]
    Part {
        /// The path of the file.
        path: String,
        /// What is wrong with it.
        fault: PartFault,
    },
    /// A report cannot be read.
    #[error(transparent)]
    Report(#[from] InputFailure),
    /// The file in which a shard keeps its progress cannot be read or written.
    #[error(transparent)]
    State(#[from] StateFailure),
    /// A machine file was changed between two cases of a sweep.
    #[error(
        "the machine file {0} is not the one with which other cases of this sweep ran\n  help: restore it; or delete the reports and the kept progress of all shards, and start them again"
    )]
    MachineChanged(String),
    /// The reports do not belong together.
    #[error(
        "{one} and {other} are not one sweep: {} is {} in one and {} in the other",
        difference.what, difference.one, difference.other
    )]
    NotOneSweep {
        /// The first file.
        one: String,
        /// The file that does not belong to it.
        other: String,
        /// What differs.
        difference: Difference,
    },
    /// A shard occurs twice.
    #[error(
        "shard {shard} occurs twice: in {one} and in {other}\n  help: each shard is needed once"
    )]
    Twice {
        /// The shard.
        shard: Shard,
        /// The first file.
        one: String,
        /// The second file.
        other: String,
    },
    /// Shards are missing or not finished.
    #[error("each shard is needed once, with all its cases; {0}")]
    Unfinished(Unfinished),
    /// There is nothing to merge.
    #[error("no report to merge")]
    NoReport,
    /// A file of this sweep cannot be made.
    #[error("{0}")]
    NotMade(String),
}

/// What is wrong with a report, or with the file in which a shard keeps its progress.
#[derive(Debug, Error)]
pub enum PartFault {
    /// It is neither.
    #[error("no report of a sweep: {0}")]
    NoReport(String),
    /// It is a report of an older carrystep.
    #[error(
        "a report of an older carrystep, which does not state its version\n  help: run the shard again"
    )]
    Old,
    /// It is not a file in which a shard keeps its progress.
    #[error(
        "this file does not keep the progress of a shard\n  help: it is not replaced; name another file for --keep"
    )]
    NotKept,
    /// The file has another version.
    #[error(
        "the kept progress has version {0}, and this carrystep reads version 1\n  help: use the carrystep that wrote it; or delete the file, and the shard starts again from its first case"
    )]
    Version(String),
    /// The file was changed or cut off.
    #[error(
        "the kept progress is damaged or cut off\n  help: delete the file, and the shard starts again from its first case"
    )]
    Damaged,
    /// The numbers of a report do not fit together.
    #[error("the report contradicts itself: {0}\n  help: run the shard again")]
    Contradiction(String),
    /// The file belongs to another run.
    #[error(
        "it keeps the progress of another run, in which {} was {} and not {}\n  help: use the arguments and the carrystep of that run; or delete the file, and the shard starts again from its first case",
        .0.what, .0.one, .0.other
    )]
    OtherRun(Difference),
}

/// The shards without which nothing is merged.
#[derive(Debug, Default)]
pub struct Unfinished {
    /// The first missing shards.
    pub missing: Vec<Shard>,
    /// The first incomplete shards: the shard, its file, the cases that it has, and those that it
    /// needs.
    pub incomplete: Vec<(Shard, String, u64, u64)>,
    /// Whether there are more of them.
    pub more: bool,
}

impl fmt::Display for Unfinished {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let missing: Vec<String> = self.missing.iter().map(Shard::to_string).collect();
        let incomplete = self
            .incomplete
            .iter()
            .map(|(shard, path, done, all)| format!("{shard} has {done} of {all} cases in {path}"));
        let mut all: Vec<String> = incomplete.collect();
        if !missing.is_empty() {
            all.insert(0, format!("missing: {}", missing.join(", ")));
        }
        f.write_str(&all.join("; "))?;
        f.write_str(if self.more { ", and more" } else { "" })?;
        f.write_str("\n  help: start these shards again, with the same command as before")
    }
}

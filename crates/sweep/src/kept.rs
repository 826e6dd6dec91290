//! The file in which a shard keeps its progress, so that it can be killed and started again.
//!
//! It is a sealed file of JSON: the judged cases and their report. It is always replaced as a whole,
//! so a killed process leaves a whole file.

use crate::difference::Difference;
use crate::error::{PartFault, SweepError};
use crate::progress::Progress;
use crate::report::SweepReport;
use carrystep_files::StateFile;
use carrystep_files::sealed::{SealFault, seal, unseal};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The beginning of each such file.
const NAME: &str = "carrystep-sweep-shard";

/// The version of the format.
const VERSION: &str = "1";

/// The shortest time between two writes.
const PAUSE: Duration = Duration::from_millis(250);

/// A write is followed by a pause of at least so many times its own duration. Writing therefore
/// takes at most a twentieth of the time, also on a slow network disk.
const RATIO: u32 = 19;

/// The rest of the file.
#[derive(Serialize, Deserialize)]
struct Body<R> {
    /// The places in the shard, counted from 0, of the cases that have been judged: ranges from the
    /// first to before the second number.
    done: Vec<(u64, u64)>,
    report: R,
}

/// The file in which a shard keeps its progress.
#[derive(Debug)]
pub struct KeptShard {
    path: PathBuf,
    file: StateFile,
    /// The end of the last write, and its duration.
    written: Instant,
    took: Duration,
}

impl KeptShard {
    /// Claims the file and reads the progress that it keeps. `fresh` is the progress of a shard
    /// that begins; the result is that, or the progress from the file. Unless the file keeps a
    /// complete shard, it is written, so that a folder that cannot be written is detected before
    /// the work.
    ///
    /// # Errors
    /// The file cannot be read or written, keeps no progress, is damaged, or is of another run.
    pub fn open(path: &Path, fresh: Progress) -> Result<(Self, Progress), SweepError> {
        let failed = |fault| SweepError::Part { path: path.display().to_string(), fault };
        let (file, left) = StateFile::open(path)?;
        let is_new = left.is_none();
        let progress = match left {
            None => fresh,
            Some(bytes) => {
                let kept = parse(&bytes).unwrap_or(Err(PartFault::NotKept)).map_err(failed)?;
                let (one, other) = (kept.shard().to_string(), fresh.shard().to_string());
                let difference = kept.report.difference(&fresh.report).or_else(|| {
                    (one != other).then_some(Difference { what: "the shard", one, other })
                });
                match difference {
                    None => kept,
                    Some(difference) => return Err(failed(PartFault::OtherRun(difference))),
                }
            }
        };
        let path = path.to_owned();
        let mut kept = Self { path, file, written: Instant::now(), took: Duration::ZERO };
        if is_new || !progress.is_complete() {
            kept.save(&progress)?;
        }
        Ok((kept, progress))
    }

    /// The path of the file, as the user gave it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Replaces the kept progress by this one.
    ///
    /// # Errors
    /// The file cannot be written; the progress that was kept before is still there.
    pub fn save(&mut self, progress: &Progress) -> Result<(), SweepError> {
        let begun = Instant::now();
        self.file.replace(&text(progress)?)?;
        self.written = Instant::now();
        self.took = self.written - begun;
        Ok(())
    }

    /// As [`KeptShard::save`], but only if the last write is some time ago.
    ///
    /// # Errors
    /// As [`KeptShard::save`].
    pub fn save_from_time_to_time(&mut self, progress: &Progress) -> Result<(), SweepError> {
        let pause = PAUSE.max(self.took.saturating_mul(RATIO));
        if self.written.elapsed() < pause { Ok(()) } else { self.save(progress) }
    }
}

fn text(progress: &Progress) -> Result<Vec<u8>, SweepError> {
    let body = Body { done: progress.ranges(), report: &progress.report };
    let body = serde_json::to_string_pretty(&body)
        .map_err(|error| SweepError::NotMade(format!("no JSON: {error}")))?;
    Ok(seal(NAME, VERSION, &body).into_bytes())
}

/// The progress in these bytes; `None` if they are not such a file at all.
pub(crate) fn parse(bytes: &[u8]) -> Option<Result<Progress, PartFault>> {
    Some(unseal(NAME, VERSION, bytes)?.map_err(PartFault::from).and_then(progress))
}

fn progress(body: &[u8]) -> Result<Progress, PartFault> {
    let Body { done, report }: Body<SweepReport> =
        serde_json::from_slice(body).map_err(|_| PartFault::Damaged)?;
    Progress::checked(report, &done)
}

impl From<SealFault> for PartFault {
    fn from(fault: SealFault) -> Self {
        match fault {
            SealFault::Damaged => Self::Damaged,
            SealFault::Version(version) => Self::Version(version),
        }
    }
}

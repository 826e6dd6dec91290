//! The file in which a shard keeps its progress, so that it can be killed and started again.
//!
//! The first line has the name of the format, its version and the SHA-256 of the rest. The rest is
//! JSON: the judged cases and their report. The file is always replaced as a whole, so a killed
//! process leaves a whole file. A file that was changed or cut off in another way does not have its
//! SHA-256 and is refused.

use crate::difference::Difference;
use crate::error::{PartFault, SweepError};
use crate::progress::Progress;
use crate::report::SweepReport;
use carrystep_files::StateFile;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The beginning of each such file.
const NAME: &str = "carrystep-sweep-shard ";

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

fn sum(body: &[u8]) -> String {
    Sha256::digest(body).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn text(progress: &Progress) -> Result<Vec<u8>, SweepError> {
    let body = Body { done: progress.ranges(), report: &progress.report };
    let body = serde_json::to_vec_pretty(&body)
        .map_err(|error| SweepError::NotMade(format!("no JSON: {error}")))?;
    let mut text = format!("{NAME}{VERSION} {}\n", sum(&body)).into_bytes();
    text.extend(body);
    Ok(text)
}

/// The progress in these bytes; `None` if they are not such a file at all.
pub(crate) fn parse(bytes: &[u8]) -> Option<Result<Progress, PartFault>> {
    let rest = bytes.strip_prefix(NAME.as_bytes())?;
    let line = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
    let (head, body) = rest.split_at(line);
    Some(parse_rest(&String::from_utf8_lossy(head), body.get(1..).unwrap_or_default()))
}

fn parse_rest(head: &str, body: &[u8]) -> Result<Progress, PartFault> {
    let (version, hash) = head.split_once(' ').ok_or(PartFault::Damaged)?;
    if version != VERSION {
        return Err(PartFault::Version(version.to_owned()));
    }
    if hash != sum(body) {
        return Err(PartFault::Damaged);
    }
    let Body { done, report }: Body<SweepReport> =
        serde_json::from_slice(body).map_err(|_| PartFault::Damaged)?;
    Progress::checked(report, &done)
}

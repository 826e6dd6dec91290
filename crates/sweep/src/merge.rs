//! Merges the shards of a sweep into one report, or refuses to.

use crate::difference::Difference;
use crate::error::{PartFault, SweepError, Unfinished};
use crate::kept;
use crate::progress::Progress;
use crate::report::SweepReport;
use crate::shard::Shard;
use std::collections::BTreeMap;
use std::path::Path;

/// So many missing and so many incomplete shards are named.
const NAMED: usize = 10;

/// One shard with the file from which it was read.
#[derive(Debug)]
pub struct Part {
    path: String,
    progress: Progress,
}

impl Part {
    /// Reads a report that `--json` printed, or the file in which a shard keeps its progress.
    ///
    /// # Errors
    /// The file cannot be read, or it is neither of them, or its numbers contradict each other.
    pub fn read(path: &Path) -> Result<Self, SweepError> {
        let bytes = carrystep_files::read_text(path)?;
        let path = path.display().to_string();
        let progress = kept::parse(&bytes).unwrap_or_else(|| report(&bytes));
        match progress {
            Ok(progress) => Ok(Self { path, progress }),
            Err(fault) => Err(SweepError::Part { path, fault }),
        }
    }
}

/// The report that `--json` printed.
fn report(bytes: &[u8]) -> Result<Progress, PartFault> {
    let no_report = |error: serde_json::Error| PartFault::NoReport(error.to_string());
    let document: serde_json::Value = serde_json::from_slice(bytes).map_err(no_report)?;
    let is_report = document.get("cases_passed").is_some();
    if is_report && document.get("carrystep").is_none() {
        return Err(PartFault::Old);
    }
    Progress::complete(serde_json::from_value(document).map_err(no_report)?)
}

impl SweepReport {
    /// Merges all shards of a sweep into the report that a single run gives.
    ///
    /// # Errors
    /// The parts belong to different sweeps; or a shard is missing, is incomplete or occurs twice.
    pub fn merge(parts: Vec<Part>) -> Result<Self, SweepError> {
        let mut shards: BTreeMap<Shard, Part> = BTreeMap::new();
        for part in parts {
            if let Some((_, first)) = shards.first_key_value() {
                let found = difference(first, &part);
                if let Some(difference) = found {
                    let (one, other) = (first.path.clone(), part.path);
                    return Err(SweepError::NotOneSweep { one, other, difference });
                }
            }
            let shard = part.progress.shard();
            if let Some(one) = shards.get(&shard) {
                let (one, other) = (one.path.clone(), part.path);
                return Err(SweepError::Twice { shard, one, other });
            }
            shards.insert(shard, part);
        }
        let (first, _) = shards.first_key_value().ok_or(SweepError::NoReport)?;
        if let Some(unfinished) = unfinished(&shards, first.count) {
            return Err(SweepError::Unfinished(unfinished));
        }
        let mut reports = shards.into_values().map(|part| part.progress.into_report());
        let first = reports.next().ok_or(SweepError::NoReport)?;
        let mut whole = reports.try_fold(first, Self::with)?;
        whole.shards = vec![Shard::WHOLE];
        Ok(whole)
    }
}

/// How the second part is of another sweep, or of another number of shards.
fn difference(first: &Part, part: &Part) -> Option<Difference> {
    let (one, other) = (first.progress.shard().count, part.progress.shard().count);
    first.progress.report.difference(&part.progress.report).or_else(|| {
        let (what, is_other) = ("the number of shards", one != other);
        is_other.then(|| Difference { what, one: one.to_string(), other: other.to_string() })
    })
}

/// The missing and the incomplete ones of `count` shards, if there are any.
fn unfinished(shards: &BTreeMap<Shard, Part>, count: u64) -> Option<Unfinished> {
    let here = shards.len() as u64;
    let all = || (1..=count).map(|number| Shard { number, count });
    // The loop over all shards ends early, because a damaged report can state any count.
    let missing: Vec<Shard> = all()
        .filter(|shard| !shards.contains_key(shard))
        .take(NAMED.min(here.abs_diff(count) as usize))
        .collect();
    let open = || shards.iter().filter(|(_, part)| !part.progress.is_complete());
    let incomplete = open().take(NAMED).map(|(&shard, Part { path, progress })| {
        (shard, path.clone(), progress.cases_done(), progress.cases())
    });
    let incomplete: Vec<_> = incomplete.collect();
    let more = here + (missing.len() as u64) < count || open().count() > incomplete.len();
    let finished = missing.is_empty() && incomplete.is_empty();
    (!finished).then_some(Unfinished { missing, incomplete, more })
}

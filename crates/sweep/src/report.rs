//! The report of a sweep, in a form in which parts can be merged.
//!
//! The names of the fields are part of `--json` and may not change.

use crate::difference::Difference;
use crate::error::SweepError;
use crate::file::{Case, SweepFile, Values};
use crate::shard::Shard;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// The number of failed cases in a report that get a message. The others are only counted.
pub(crate) const SPELLED_OUT: usize = 20;

/// What judges the cases. Reports can be merged only if all of this is the same.
#[derive(Debug, Clone, Copy)]
pub struct JudgedBy<'a> {
    /// The gateware: engine or parallel.
    pub core: &'a str,
    /// The version of carrystep.
    pub carrystep: &'a str,
    /// The build of carrystep: a hash of its executable.
    pub build: &'a str,
}

/// The result of a case.
#[derive(Debug, Clone)]
pub enum CaseVerdict {
    /// All checks hold. The figures are given by name; the greatest value of each is its worst.
    Passed(BTreeMap<&'static str, f64>),
    /// The planner refuses the move, with this message.
    Refused(String),
    /// A check does not hold, with this message.
    Failed(String),
}

/// The worst value of one figure, and the case in which it occurred.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Worst {
    /// The value of the figure.
    pub value: f64,
    /// The number of the case.
    pub case: u64,
    /// The values of its placeholders.
    pub values: Values,
}

/// A case that failed.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct FailedCase {
    /// The number of the case.
    pub case: u64,
    /// The values of its placeholders.
    pub values: Values,
    /// The check that does not hold, as a message.
    pub message: String,
}

impl FailedCase {
    /// The text `name = value` of each placeholder, separated by commas.
    pub fn filled(&self) -> String {
        filled(&self.values)
    }
}

/// The report of a sweep or of some of its shards.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct SweepReport {
    /// Whether all cases passed or were refused by the planner; `None` if no case ran. An empty
    /// shard proves nothing, and neither do moves that the planner refuses.
    pub passed: Option<bool>,
    /// The same in all shards of a sweep on one core.
    pub sweep: String,
    /// The gateware: engine or parallel.
    pub core: String,
    /// The version of carrystep.
    pub carrystep: String,
    /// The build of carrystep: the first 16 hexadecimal digits of the SHA-256 of its executable.
    pub build: String,
    /// The number of random cases; null for the grid.
    pub sample: Option<u64>,
    /// The seed of the random cases.
    pub seed: u64,
    /// Number of cases of the whole sweep.
    pub cases: u64,
    /// The machine files that the cases name: the path from the folder of the sweep file, and the
    /// first 16 hexadecimal digits of a hash of the text.
    pub machine_files: BTreeMap<String, String>,
    /// Which shards are in here.
    pub shards: Vec<Shard>,
    /// Number of cases that ran and passed.
    pub cases_passed: u64,
    /// Number of cases that the planner refused because the move is impossible.
    pub cases_refused: u64,
    /// Number of cases that failed.
    pub cases_failed: u64,
    /// The worst value of each figure, by name.
    pub worst: BTreeMap<String, Worst>,
    /// The first cases that failed.
    pub failures: Vec<FailedCase>,
}

impl SweepReport {
    /// A report of no case yet.
    pub fn new(sweep: &SweepFile, shard: Shard, by: JudgedBy<'_>) -> Self {
        Self {
            passed: None,
            sweep: sweep.fingerprint(by.core),
            core: by.core.to_owned(),
            carrystep: by.carrystep.to_owned(),
            build: by.build.to_owned(),
            sample: sweep.sample(),
            seed: sweep.seed(),
            cases: sweep.cases(),
            machine_files: BTreeMap::new(),
            shards: vec![shard],
            cases_passed: 0,
            cases_refused: 0,
            cases_failed: 0,
            worst: BTreeMap::new(),
            failures: Vec::new(),
        }
    }

    /// Adds the result of one case. The order in which cases are added has no effect.
    ///
    /// # Errors
    /// The case names a machine file that was a different one for an earlier case.
    pub(crate) fn add(&mut self, case: &Case, verdict: CaseVerdict) -> Result<(), SweepError> {
        if let Some((path, hash)) = &case.machine_file {
            self.name(path, hash)?;
        }
        let infinite =
            |(name, value): (&&str, &f64)| (!value.is_finite()).then(|| name.to_string());
        match verdict {
            CaseVerdict::Refused(_) => self.cases_refused += 1,
            CaseVerdict::Failed(message) => self.fail(case, message),
            CaseVerdict::Passed(figures) => match figures.iter().find_map(infinite) {
                Some(name) => self.fail(case, format!("the figure '{name}' is not a number")),
                None => {
                    self.cases_passed += 1;
                    for (name, value) in figures {
                        let values = case.values.clone();
                        self.compare(name, Worst { value, case: case.number, values });
                    }
                }
            },
        }
        self.judge();
        Ok(())
    }

    fn fail(&mut self, case: &Case, message: String) {
        self.cases_failed += 1;
        let place = self.failures.partition_point(|failed| failed.case < case.number);
        if place < SPELLED_OUT {
            let values = case.values.clone();
            self.failures.insert(place, FailedCase { case: case.number, values, message });
            self.failures.truncate(SPELLED_OUT);
        }
    }

    /// Notes a machine file.
    fn name(&mut self, path: &str, hash: &str) -> Result<(), SweepError> {
        match self.machine_files.get(path) {
            Some(known) if known == hash => Ok(()),
            Some(_) => Err(SweepError::MachineChanged(path.to_owned())),
            None => {
                self.machine_files.insert(path.to_owned(), hash.to_owned());
                Ok(())
            }
        }
    }

    fn judge(&mut self) {
        let tried = self.cases_passed + self.cases_failed;
        self.passed = (tried > 0).then_some(self.cases_failed == 0);
    }

    /// Keeps the worse of two values, or the one of the earlier case if they are equal, so that the
    /// order of merging has no effect.
    fn compare(&mut self, name: &str, new: Worst) {
        match self.worst.get_mut(name) {
            Some(old) if (old.value, new.case) < (new.value, old.case) => *old = new,
            Some(_) => {}
            None => {
                self.worst.insert(name.to_owned(), new);
            }
        }
    }

    /// Merges this report with another part; the order has no effect. The caller has checked that
    /// both have different cases of one sweep, so the sums are at most its number of cases.
    ///
    /// # Errors
    /// Cases of both parts name a machine file that was not the same.
    pub(crate) fn with(mut self, other: Self) -> Result<Self, SweepError> {
        for (path, hash) in &other.machine_files {
            self.name(path, hash)?;
        }
        self.cases_passed += other.cases_passed;
        self.cases_refused += other.cases_refused;
        self.cases_failed += other.cases_failed;
        for (name, worst) in other.worst {
            self.compare(&name, worst);
        }
        self.failures.extend(other.failures);
        self.failures.sort_by_key(|failed| failed.case);
        self.failures.truncate(SPELLED_OUT);
        self.judge();
        Ok(self)
    }

    /// The first property in which this report is of another sweep than `other`.
    pub(crate) fn difference(&self, other: &Self) -> Option<Difference> {
        let sample = |sample: Option<u64>| sample.map_or("none".to_owned(), |n| n.to_string());
        let properties = |report: &Self| {
            [
                ("the version of carrystep", report.carrystep.clone()),
                ("the build of carrystep", report.build.clone()),
                ("the core", report.core.clone()),
                ("--sample", sample(report.sample)),
                ("--seed", report.seed.to_string()),
                ("the hash of the sweep file and these options", report.sweep.clone()),
                ("the number of cases", report.cases.to_string()),
            ]
        };
        let mut pairs = properties(self).into_iter().zip(properties(other));
        let ((what, one), (_, other)) = pairs.find(|(one, other)| one != other)?;
        Some(Difference { what, one, other })
    }
}

/// The text `name = value` of each placeholder, separated by commas.
fn filled(values: &Values) -> String {
    let parts: Vec<String> =
        values.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    parts.join(", ")
}

impl fmt::Display for crate::file::Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integer(number) => number.fmt(f),
            Self::Float(number) => number.fmt(f),
            Self::Text(text) => text.fmt(f),
        }
    }
}

impl fmt::Display for SweepReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shards: Vec<String> = self.shards.iter().map(Shard::to_string).collect();
        let (passed, refused, failed) = (self.cases_passed, self.cases_refused, self.cases_failed);
        writeln!(
            f,
            "sweep {} on {}, shard {}: {passed} passed, {refused} refused, {failed} failed",
            self.sweep,
            self.core,
            shards.join(" ")
        )?;
        for (name, Worst { value, case, values }) in &self.worst {
            writeln!(f, "  worst {name:<16} {value:>10.3}  case {case}: {}", filled(values))?;
        }
        for FailedCase { case, values, message } in &self.failures {
            writeln!(f, "  FAILED case {case}: {}\n    {message}", filled(values))?;
        }
        f.write_str(match self.passed {
            Some(true) => "ALL HOLDS\n",
            Some(false) => "FAILED\n",
            None => "NOTHING TRIED: no case ran\n",
        })
    }
}

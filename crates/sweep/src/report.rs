//! The report of a sweep, in a form in which parts can be merged.
//!
//! The names of the fields are part of `--json` and may not change.

use crate::file::{SweepError, SweepFile, Values};
use crate::shard::Shard;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// The number of failed cases in a shard that get a message. The others are only counted.
const SPELLED_OUT: usize = 20;

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
    pub fn new(sweep: &SweepFile, shard: Shard, core: &str) -> Self {
        Self {
            passed: None,
            sweep: sweep.fingerprint(core),
            core: core.to_owned(),
            shards: vec![shard],
            cases_passed: 0,
            cases_refused: 0,
            cases_failed: 0,
            worst: BTreeMap::new(),
            failures: Vec::new(),
        }
    }

    /// Adds the result of one case.
    pub(crate) fn add(&mut self, case: u64, values: &Values, verdict: CaseVerdict) {
        match verdict {
            CaseVerdict::Refused(_) => self.cases_refused += 1,
            CaseVerdict::Failed(message) => {
                self.cases_failed += 1;
                self.failures.push(FailedCase { case, values: values.clone(), message });
            }
            CaseVerdict::Passed(figures) => {
                self.cases_passed += 1;
                for (name, value) in figures {
                    self.compare(name, Worst { value, case, values: values.clone() });
                }
            }
        }
        self.judge();
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

    /// Merges this report with another part; the order has no effect.
    #[must_use]
    pub(crate) fn with(mut self, other: Self) -> Self {
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
        self
    }

    /// Merges all shards of a sweep into one report.
    ///
    /// # Errors
    /// [`SweepError::Merge`] if the reports belong to different sweeps, or if a shard is missing or
    /// occurs twice.
    pub fn merge(reports: impl IntoIterator<Item = Self>) -> Result<Self, SweepError> {
        let mut reports = reports.into_iter();
        let mut whole =
            reports.next().ok_or_else(|| SweepError::Merge("no report to merge".to_owned()))?;
        for report in reports {
            if report.sweep != whole.sweep {
                return Err(SweepError::Merge(format!(
                    "{} and {} are not one sweep",
                    whole.sweep, report.sweep
                )));
            }
            whole.shards.extend(&report.shards);
            whole = whole.with(report);
        }
        whole.shards.sort_unstable();
        let count = whole.shards.first().map_or(0, |shard| shard.count);
        let wanted: Vec<Shard> = (1..=count).map(|number| Shard { number, count }).collect();
        if whole.shards != wanted {
            let there: Vec<String> = whole.shards.iter().map(Shard::to_string).collect();
            return Err(SweepError::Merge(format!(
                "each shard is needed once; here are {}",
                there.join(", ")
            )));
        }
        whole.shards = vec![Shard::WHOLE];
        Ok(whole)
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

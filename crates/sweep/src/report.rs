//! What cases came to, in such a form that parts add up to a whole.

use crate::file::{SweepError, SweepFile, Values};
use crate::shard::Shard;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// Failed cases that are spelled out in a shard; the rest is counted.
const SPELLED_OUT: usize = 20;

/// What a case came to.
#[derive(Debug, Clone)]
pub enum Verdict {
    /// Everything holds; figures by name, the greatest is the worst.
    Passed(BTreeMap<&'static str, f64>),
    /// The planner refuses the move, and says why.
    Refused(String),
    /// Something does not hold.
    Failed(String),
}

/// The worst of one figure, and the case that has it.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Worst {
    /// The figure.
    pub value: f64,
    /// The case's number.
    pub case: u64,
    /// What it was filled in with.
    pub values: Values,
}

/// A case that failed.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Failed {
    /// The case's number.
    pub case: u64,
    /// What it was filled in with.
    pub values: Values,
    /// What does not hold.
    pub message: String,
}

impl Failed {
    /// `name = value` of each blank.
    pub fn filled(&self) -> String {
        filled(&self.values)
    }
}

/// A sweep, or some shards of it.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Report {
    /// Whether all cases of all shards that are in here passed or were refused; `None` where no case ran: an empty shard
    /// shows nothing, and neither do moves that the planner refuses.
    pub passed: Option<bool>,
    /// The same in all shards of a sweep on one core.
    pub sweep: String,
    /// The gateware: engine or parallel.
    pub core: String,
    /// Which shards are in here.
    pub shards: Vec<Shard>,
    /// Cases that ran and passed.
    pub cases_passed: u64,
    /// Cases that the planner refused: impossible moves.
    pub cases_refused: u64,
    /// Cases that failed.
    pub cases_failed: u64,
    /// By figure.
    pub worst: BTreeMap<String, Worst>,
    /// The first that failed.
    pub failures: Vec<Failed>,
}

impl Report {
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

    /// One case more.
    pub(crate) fn add(&mut self, case: u64, values: &Values, verdict: Verdict) {
        match verdict {
            Verdict::Refused(_) => self.cases_refused += 1,
            Verdict::Failed(message) => {
                self.cases_failed += 1;
                self.failures.push(Failed { case, values: values.clone(), message });
            }
            Verdict::Passed(figures) => {
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

    /// The worse of two stays; of two alike the earlier, so that the order of merging is all the same.
    fn compare(&mut self, name: &str, new: Worst) {
        match self.worst.get_mut(name) {
            Some(old) if (old.value, new.case) < (new.value, old.case) => *old = new,
            Some(_) => {}
            None => {
                self.worst.insert(name.to_owned(), new);
            }
        }
    }

    /// The same with another part, in any order.
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

    /// All shards of a sweep as one report.
    ///
    /// # Errors
    /// [`SweepError::Merge`]: they are not of one sweep, or one is missing or there twice.
    pub fn merge(reports: impl IntoIterator<Item = Self>) -> Result<Self, SweepError> {
        let mut reports = reports.into_iter();
        let mut whole = reports.next().ok_or_else(|| SweepError::Merge("no report to merge".to_owned()))?;
        for report in reports {
            if report.sweep != whole.sweep {
                return Err(SweepError::Merge(format!("{} and {} are not one sweep", whole.sweep, report.sweep)));
            }
            whole.shards.extend(&report.shards);
            whole = whole.with(report);
        }
        whole.shards.sort_unstable();
        let count = whole.shards.first().map_or(0, |shard| shard.count);
        let wanted: Vec<Shard> = (1..=count).map(|number| Shard { number, count }).collect();
        if whole.shards != wanted {
            let there: Vec<String> = whole.shards.iter().map(Shard::to_string).collect();
            return Err(SweepError::Merge(format!("each shard is needed once; here are {}", there.join(", "))));
        }
        whole.shards = vec![Shard::WHOLE];
        Ok(whole)
    }
}

/// `name = value` of each blank.
fn filled(values: &Values) -> String {
    let parts: Vec<String> = values.iter().map(|(name, value)| format!("{name} = {value}")).collect();
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

impl fmt::Display for Report {
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
        for Failed { case, values, message } in &self.failures {
            writeln!(f, "  FAILED case {case}: {}\n    {message}", filled(values))?;
        }
        f.write_str(match self.passed {
            Some(true) => "ALL HOLDS\n",
            Some(false) => "FAILED\n",
            None => "NOTHING TRIED: no case ran\n",
        })
    }
}

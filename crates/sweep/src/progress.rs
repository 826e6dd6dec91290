//! How far a shard is: its report so far, and which of its cases are in it.

use crate::error::{PartFault, SweepError};
use crate::file::{Case, SweepFile};
use crate::report::{CaseVerdict, JudgedBy, SPELLED_OUT, SweepReport};
use crate::shard::Shard;
use rangemap::RangeSet;
use std::ops::Range;

/// A report of one shard and the cases that it contains. The order in which cases were added has no
/// effect on a complete report.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    pub(crate) report: SweepReport,
    /// The places of the judged cases in the shard, counted from 0.
    done: RangeSet<u64>,
    shard: Shard,
}

impl Progress {
    /// The progress of a shard in which no case has been judged.
    pub fn new(sweep: &SweepFile, shard: Shard, by: JudgedBy<'_>) -> Self {
        Self { report: SweepReport::new(sweep, shard, by), done: RangeSet::new(), shard }
    }

    /// A report with the ranges of its cases, from a file. Nothing in it is trusted.
    pub(crate) fn checked(report: SweepReport, ranges: &[(u64, u64)]) -> Result<Self, PartFault> {
        let contradiction = |text: String| Err(PartFault::Contradiction(text));
        let shard = match report.shards.as_slice() {
            [shard] if shard.is_valid() => *shard,
            _ => return contradiction("it is not of one shard".to_owned()),
        };
        let mut done = RangeSet::new();
        for &(from, to) in ranges {
            if from >= to || to > shard.length(report.cases) || done.overlaps(&(from..to)) {
                return contradiction(format!("{from} to {to} is no range of its cases"));
            }
            done.insert(from..to);
        }
        let progress = Self { report, done, shard };
        let SweepReport { cases_passed, cases_refused, cases_failed, .. } = progress.report;
        let results =
            cases_passed.checked_add(cases_refused).and_then(|sum| sum.checked_add(cases_failed));
        if results != Some(progress.cases_done()) {
            return contradiction(format!(
                "{cases_passed} passed, {cases_refused} refused and {cases_failed} failed are not {} cases",
                progress.cases_done()
            ));
        }
        let is_done =
            |case: u64| shard.place(case).is_some_and(|place| progress.done.contains(&place));
        let SweepReport { worst, failures, passed, .. } = &progress.report;
        let mut named = worst.values().map(|worst| worst.case);
        if let Some(case) = named.find(|&case| !is_done(case)) {
            return contradiction(format!("case {case} is not one of its cases"));
        }
        let in_order = failures.is_sorted_by(|one, other| one.case < other.case);
        let listed = cases_failed.min(SPELLED_OUT as u64) == failures.len() as u64;
        if !in_order || !listed || failures.iter().any(|failed| !is_done(failed.case)) {
            return contradiction("the failed cases are not those that it counts".to_owned());
        }
        let tried = cases_passed + cases_failed > 0;
        if *passed != tried.then_some(cases_failed == 0) {
            return contradiction("`passed` is not that of its cases".to_owned());
        }
        Ok(progress)
    }

    /// A complete report, from a file.
    pub(crate) fn complete(report: SweepReport) -> Result<Self, PartFault> {
        let all = match report.shards.as_slice() {
            [shard] if shard.is_valid() => shard.length(report.cases),
            _ => 0,
        };
        let ranges = [(0, all)];
        Self::checked(report, if all == 0 { &[] } else { &ranges })
    }

    /// The shard.
    pub fn shard(&self) -> Shard {
        self.shard
    }

    /// Number of cases of the shard.
    pub fn cases(&self) -> u64 {
        self.shard.length(self.report.cases)
    }

    /// Number of cases that have been judged.
    pub fn cases_done(&self) -> u64 {
        self.done.iter().map(|range| range.end - range.start).sum()
    }

    /// Whether all cases have been judged.
    pub fn is_complete(&self) -> bool {
        self.cases_done() == self.cases()
    }

    /// The report, which is that of the shard only if all cases have been judged.
    pub fn into_report(self) -> SweepReport {
        self.report
    }

    /// The places that have not been judged.
    pub(crate) fn remaining(&self) -> Vec<Range<u64>> {
        match self.cases() {
            0 => Vec::new(),
            all => self.done.gaps(&(0..all)).collect(),
        }
    }

    /// The places that have been judged.
    pub(crate) fn ranges(&self) -> Vec<(u64, u64)> {
        self.done.iter().map(|range| (range.start, range.end)).collect()
    }

    /// Adds the result of the case at this place, which has not been judged before.
    pub(crate) fn add(
        &mut self,
        place: u64,
        case: &Case,
        verdict: CaseVerdict,
    ) -> Result<(), SweepError> {
        self.report.add(case, verdict)?;
        self.done.insert(place..place + 1);
        Ok(())
    }
}

//! Compares the time of each change of an output with the plan of a job.
//!
//! All outputs are inactive where the plan begins. A row that gives an output another level makes a
//! change due where the row begins. `pwm_check.rs` checks the PWM.

use crate::due_times::{DueTimes, Judged};
use carrystep_core::OutputChange;
use schemars::JsonSchema;
use serde::Serialize;

/// Most changes that wait until the first pulse tells where the plan begins.
const EARLY: usize = 1 << 18;

/// The times of the changes of one output against the plan.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct OutputTimesReport {
    /// The number of the output.
    pub output: u8,
    /// Number of changes that the plan makes.
    pub changes_expected: u64,
    /// Number of changes in the capture.
    pub changes_found: u64,
    /// Least error e = change - due time, ns; negative is early.
    pub error_min_ns: Option<f64>,
    /// Greatest error e, ns.
    pub error_max_ns: Option<f64>,
    /// The bound of |e|, ns: 2 ns + slack, and one phase h/Q more if the origin was found from the
    /// pulses.
    pub error_bound_ns: f64,
    /// What is wrong.
    pub failures: Vec<String>,
}

/// Compares the changes of outputs with a plan.
#[derive(Debug, Default)]
pub(crate) struct OutputTimes {
    /// Each output that is compared, with its number.
    outputs: Vec<(u8, DueTimes)>,
    /// The levels that the plan has reached, and those of the capture.
    planned: u8,
    found: u8,
    /// Changes before the start of the plan was known: the outputs, and the time.
    early: Vec<(u8, u64)>,
}

impl OutputTimes {
    /// Compares the outputs of this mask.
    pub fn new(mask: u8) -> Self {
        let exist = (0..8).filter(|number| mask >> number & 1 == 1);
        let outputs = exist.map(|number| (number, DueTimes::default())).collect();
        Self { outputs, ..Self::default() }
    }

    /// A row of the plan begins with this change, ps from the start of the plan.
    pub fn plan(&mut self, change: OutputChange, ps: i64) {
        let now = (self.planned & !change.mask) | (change.levels & change.mask);
        let changed = std::mem::replace(&mut self.planned, now) ^ now;
        for (number, times) in &mut self.outputs {
            if changed >> *number & 1 == 1 {
                times.due(ps);
            }
        }
    }

    /// The outputs have these levels from `ps` of the capture on. The plan starts at `base`, if
    /// that is known.
    pub fn levels(&mut self, ps: u64, levels: u8, base: Option<i64>) {
        let changed = std::mem::replace(&mut self.found, levels) ^ levels;
        match base {
            Some(base) => self.come(ps, changed, base),
            // What is beyond this is missing from the counts.
            None if self.early.len() < EARLY => self.early.push((changed, ps)),
            None => {}
        }
    }

    fn come(&mut self, ps: u64, changed: u8, base: i64) {
        for (number, times) in &mut self.outputs {
            if changed >> *number & 1 == 1 {
                times.comes(ps, base);
            }
        }
    }

    /// The plan starts at `base` of the capture.
    pub fn begin(&mut self, base: i64) {
        for (changed, ps) in std::mem::take(&mut self.early) {
            self.come(ps, changed, base);
        }
    }

    /// Where the plan starts by the first change, ps of the capture, if no pulse tells it.
    pub fn base(&self) -> Option<i64> {
        let due = self.outputs.iter().filter_map(|(_, times)| times.first()).min();
        let &(_, first) = self.early.first()?;
        Some(i64::try_from(first).unwrap_or(i64::MAX) - due.unwrap_or(0))
    }

    /// The errors of all outputs, ps.
    pub fn errors(&self) -> impl Iterator<Item = [i64; 2]> {
        self.outputs.iter().filter_map(|(_, times)| times.errors())
    }

    /// The report of each output.
    pub fn finish(self, judged: Judged) -> Vec<OutputTimesReport> {
        let report = |(output, times): (u8, DueTimes)| {
            let errors = times.errors();
            let ns = |at: usize| errors.map(|errors| (errors[at] - judged.shift) as f64 / 1e3);
            OutputTimesReport {
                output,
                changes_expected: times.expected,
                changes_found: times.found,
                error_min_ns: ns(0),
                error_max_ns: ns(1),
                error_bound_ns: judged.bound / 1e3,
                failures: times.failures(&format!("output {output}"), "change", judged),
            }
        };
        self.outputs.into_iter().map(report).collect()
    }
}

//! Compares the output pins of a run with the changes that its plan wants.
//!
//! ```text
//! plan     row            | row: output 2 on  | row              each change is due where its row
//! pins     _____________________/^^^^^^^^^^^^^^^^^^^^^^          begins, plus the latency of a step
//! ```

use crate::edge::{PinChange, PinSink};
use crate::error::TraceError;
use carrystep_core::OutputChange;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// The check of the output pins. `pwm_check.rs` checks the PWM.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct OutputReport {
    /// True if every change was due, and came in its clock.
    pub passed: bool,
    /// Changes of one output or more that came in their clock.
    pub changes: u64,
    /// Changes that did not come in their clock, and those that were not due.
    pub wrong: u64,
    /// The first of them.
    pub first_wrong: Option<String>,
}

impl fmt::Display for OutputReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { changes, wrong, first_wrong, .. } = self;
        writeln!(f, "changes of outputs in their clocks: {changes}; wrong: {wrong}")?;
        first_wrong.iter().try_for_each(|first| writeln!(f, "  {first}"))
    }
}

/// A change of outputs that a plan wants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DueChange {
    /// When it is due, ps of the capture.
    pub ps: u64,
    /// What changes.
    pub change: OutputChange,
}

/// Takes the levels of the output pins. `due` gives the changes that the plan wants, in order: all
/// that are due up to the time of the pins.
pub struct OutputCheck<F> {
    due: F,
    /// The next change.
    next: Option<DueChange>,
    /// The levels that the plan wants, and those of the pins.
    wanted: u8,
    found: u8,
    report: OutputReport,
}

impl<F> fmt::Debug for OutputCheck<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OutputCheck").field("report", &self.report).finish_non_exhaustive()
    }
}

impl<F: FnMut() -> Option<DueChange>> OutputCheck<F> {
    /// A check that begins with all outputs inactive.
    pub const fn new(due: F) -> Self {
        let report = OutputReport { passed: true, changes: 0, wrong: 0, first_wrong: None };
        Self { due, next: None, wanted: 0, found: 0, report }
    }

    /// The result.
    pub fn finish(self) -> OutputReport {
        self.report
    }

    /// Counts what is wrong at `ps` with the outputs of this mask.
    fn wrong(&mut self, ps: u64, mask: u8, what: &str) {
        let first = || {
            let number = mask.trailing_zeros();
            let level = if self.wanted >> number & 1 == 1 { "on" } else { "off" };
            format!("at {:.9} s output {number} {what}: it is due to be {level}", ps as f64 / 1e12)
        };
        self.report.first_wrong.get_or_insert_with(first);
        self.report.wrong += 1;
        self.report.passed = false;
    }

    /// Applies the next change that is due at `ps` or before. Returns its time, and whether a pin
    /// must change.
    fn apply(&mut self, ps: u64) -> Option<(u64, bool)> {
        self.next = self.next.take().or_else(|| (self.due)());
        let DueChange { ps: at, change } = self.next.take_if(|next| next.ps <= ps)?;
        let before = self.wanted;
        self.wanted = (before & !change.mask) | (change.levels & change.mask);
        Some((at, self.wanted != before))
    }

    /// The pins have the levels `found` from `ps` on.
    fn take(&mut self, ps: u64, found: u8) {
        let mut is_due = false;
        while let Some((at, changes)) = self.apply(ps) {
            if at == ps {
                is_due |= changes;
            } else if changes && self.found != self.wanted {
                self.wrong(at, self.found ^ self.wanted, "does not change");
            }
        }
        let changed = std::mem::replace(&mut self.found, found) ^ found;
        match found ^ self.wanted {
            0 if changed == 0 => {}
            0 if is_due => self.report.changes += 1,
            0 => self.wrong(ps, changed, "changes late"),
            differs => self.wrong(ps, differs, "has the wrong level"),
        }
    }
}

impl<F: FnMut() -> Option<DueChange>> PinSink for OutputCheck<F> {
    fn change(&mut self, _: PinChange) -> Result<(), TraceError> {
        Ok(())
    }

    fn changes(&mut self, _: &[PinChange]) -> Result<(), TraceError> {
        Ok(())
    }

    fn outputs(&mut self, ps: u64, levels: u8) -> Result<(), TraceError> {
        self.take(ps, levels);
        Ok(())
    }

    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        self.take(ps, self.found);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Output 0 goes on at 100 ps, outputs 0 and 1 change at 200 ps, and 300 ps changes nothing.
    const PLAN: [(u64, u8, u8); 3] = [(100, 1, 1), (200, 3, 2), (300, 1, 0)];

    fn check(pins: &[(u64, u8)]) -> OutputReport {
        let mut due = PLAN.into_iter().map(|(ps, mask, levels)| {
            let change = OutputChange { mask, levels, duty: None };
            DueChange { ps, change }
        });
        let mut check = OutputCheck::new(|| due.next());
        for (ps, levels) in pins {
            check.outputs(*ps, *levels).unwrap();
        }
        check.end(1000).unwrap();
        check.finish()
    }

    #[test]
    fn changes_in_their_clocks_pass() {
        let report = check(&[(100, 1), (200, 2)]);
        assert_eq!((report.passed, report.changes, report.wrong), (true, 2, 0), "{report}");
    }

    #[test]
    fn late_early_lost_and_stray_changes_are_found() {
        for wrong in [
            [(112, 1), (200, 2)].as_slice(),
            &[(88, 1), (200, 2)],
            &[(100, 1)],
            &[],
            &[(100, 1), (200, 3)],
            &[(100, 1), (200, 2), (250, 3)],
            &[(100, 1), (200, 2), (300, 3)],
            &[(100, 1), (150, 0), (160, 1), (200, 2)],
        ] {
            let report = check(wrong);
            assert!(!report.passed && report.first_wrong.is_some(), "{wrong:?}: {report}");
        }
    }
}

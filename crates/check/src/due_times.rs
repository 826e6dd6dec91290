//! The times at which events of one kind are due, and those at which they come: pulses of an axis,
//! or changes of an output. The k-th event that comes belongs to the k-th that is due.

use std::collections::VecDeque;

/// Most events of one kind that wait for the capture.
const WAITING: usize = 1 << 18;

/// The error of an event.
#[derive(Debug, Clone, Copy)]
struct ErrorAt {
    ps: i64,
    number: u64,
    /// When the event came, ps of the capture.
    at: u64,
}

/// The events of one kind.
#[derive(Debug, Default)]
pub(crate) struct DueTimes {
    /// Times at which events are due, ps from the start of the plan.
    waiting: VecDeque<i64>,
    /// Events of the plan so far, and of the capture.
    pub expected: u64,
    pub found: u64,
    /// Events that were not due, and the first of them, ps of the capture.
    surplus: u64,
    first_surplus: Option<u64>,
    /// The events that wait are too many: they do not come.
    gone: bool,
    least: Option<ErrorAt>,
    greatest: Option<ErrorAt>,
}

/// With what errors are judged.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Judged {
    /// It is subtracted from all errors, ps.
    pub shift: i64,
    /// The start of the plan, ps of the capture.
    pub origin: i64,
    /// The bound of the errors, ps.
    pub bound: f64,
}

impl DueTimes {
    /// An event is due, ps from the start of the plan.
    pub fn due(&mut self, ps: i64) {
        self.expected += 1;
        if self.gone {
            return;
        }
        self.waiting.push_back(ps);
        if self.waiting.len() > WAITING {
            self.waiting.clear();
            self.gone = true;
        }
    }

    /// The next time at which an event is due.
    pub fn first(&self) -> Option<i64> {
        self.waiting.front().copied()
    }

    /// An event comes at `ps` of the capture. The plan starts at `base`.
    pub fn comes(&mut self, ps: u64, base: i64) {
        self.found += 1;
        if self.gone {
            return;
        }
        let Some(due) = self.waiting.pop_front() else {
            self.surplus += 1;
            self.first_surplus.get_or_insert(ps);
            return;
        };
        let now = i64::try_from(ps).unwrap_or(i64::MAX);
        let error = ErrorAt { ps: now - base - due, number: self.found, at: ps };
        if self.least.is_none_or(|least| error.ps < least.ps) {
            self.least = Some(error);
        }
        if self.greatest.is_none_or(|greatest| error.ps > greatest.ps) {
            self.greatest = Some(error);
        }
    }

    /// The least and the greatest error, ps.
    pub fn errors(&self) -> Option<[i64; 2]> {
        Some([self.least?.ps, self.greatest?.ps])
    }

    /// What is wrong. `who` makes these events, of which one is called `what`.
    pub fn failures(&self, who: &str, what: &str, judged: Judged) -> Vec<String> {
        let Judged { shift, origin, bound } = judged;
        let seconds = |ps: u64| (i128::from(ps) - i128::from(origin)) as f64 / 1e12;
        let Self { expected, found, surplus, .. } = self;
        let mut failures = Vec::new();
        if found != expected {
            failures.push(format!("{who}: {found} {what}s, the plan makes {expected}"));
        }
        if self.gone {
            failures.push(format!("{who}: its {what}s do not come; their times are not compared"));
        }
        if let Some(first) = self.first_surplus {
            failures.push(format!(
                "{who}: {surplus} {what}s are not due, the first at {:.9} s",
                seconds(first)
            ));
        }
        for (error, way) in [(self.least, "early"), (self.greatest, "late")] {
            let Some(error) = error else { continue };
            let off = (error.ps - shift) as f64;
            if off.abs() > bound && (off < 0.0) == (way == "early") {
                failures.push(format!(
                    "{who}: {what} {} at {:.9} s is {:.1} ns {way}, the bound is {:.1} ns",
                    error.number,
                    seconds(error.at),
                    off.abs() / 1e3,
                    bound / 1e3
                ));
            }
        }
        failures
    }
}

//! Compares the places where outputs change with the program alone.
//!
//! A mark is a change between two moves. The tool, rebuilt from the pulses, has to be there when
//! the output changes: within the tolerance and one step of the end of the move before, or, for a
//! change while the tool moves, at or behind this place.
//!
//! ```text
//!     path   ---------o==========x---------->        o  the mark     x  the tool
//!                 near    at most LATE               outputs change between o and x
//! ```
//!
//! Marks take effect in their order. Those that are passed within one segment of the plan may take
//! effect together, and then only the last level of each output shows. Behind a mark at which the
//! program dwells, the levels must show.

use crate::path_follow::PathFollow;
use carrystep_core::OutputChange;
use std::iter::Peekable;

/// How long after the tool has passed it a mark in motion may take effect, ps: a segment lasts at
/// most 16 ms and a tick.
const LATE_PS: u64 = 16_100_000_000;

/// A change of outputs between two legs of a programmed path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OutputMark {
    /// Number of the leg, from 0, at whose start the outputs change. Behind the last leg, the
    /// number of legs.
    pub leg: u64,
    /// What changes.
    pub change: OutputChange,
    /// Whether the tool rests there.
    pub at_rest: bool,
    /// Whether the program dwells behind it, before the next mark.
    pub dwells: bool,
    /// Line of the program.
    pub line: u64,
}

/// The marks of a program, in order.
pub type OutputMarks<'a> = Box<dyn Iterator<Item = OutputMark> + Send + 'a>;

/// What is wrong with an output, and when, ps of the capture.
#[derive(Debug, Clone)]
pub(crate) struct Misplaced {
    pub what: String,
    pub ps: u64,
}

/// Compares the levels of outputs with the marks of a program. Only the next mark is kept.
pub(crate) struct OutputPlaces<'a> {
    marks: Peekable<OutputMarks<'a>>,
    mask: u8,
    slack_ps: u64,
    /// The levels behind the marks that have taken effect, and those of the pins.
    marked: u8,
    found: u8,
    /// Since when the pins have levels that were not compared yet.
    since: Option<u64>,
    /// When the tool was first seen behind the next mark.
    passed: Option<u64>,
    /// Changes of one output or more on the pins.
    pub changes: u64,
    pub wrong: Option<Misplaced>,
}

impl<'a> OutputPlaces<'a> {
    /// A check of the outputs of this mask, which are all inactive.
    pub fn new(marks: OutputMarks<'a>, mask: u8, slack_ps: u64) -> Self {
        Self {
            marks: marks.peekable(),
            mask,
            slack_ps,
            marked: 0,
            found: 0,
            since: None,
            passed: None,
            changes: 0,
            wrong: None,
        }
    }

    /// The pins have these levels from `ps` on.
    pub fn levels(&mut self, ps: u64, levels: u8, follow: &PathFollow<'_>) {
        self.before(ps, follow);
        let levels = levels & self.mask;
        if std::mem::replace(&mut self.found, levels) != levels {
            self.since.get_or_insert(ps);
        }
        // Without uncertainty of the times, all outputs of a mark change at once.
        if self.slack_ps == 0 {
            self.compare(follow);
        }
    }

    /// Nothing more happens before `ps`: levels are compared that have stood for longer than the
    /// times are uncertain.
    pub fn before(&mut self, ps: u64, follow: &PathFollow<'_>) {
        if self.since.is_some_and(|since| ps > since.saturating_add(self.slack_ps)) {
            self.compare(follow);
        }
    }

    /// Compares the levels of the pins with the marks that the tool has reached.
    fn compare(&mut self, follow: &PathFollow<'_>) {
        let Some(ps) = self.since.take() else { return };
        if self.wrong.is_some() || self.found == self.marked {
            return;
        }
        self.changes += 1;
        while self.found != self.marked {
            let changed = (self.found ^ self.marked).trailing_zeros();
            let Some(mark) = self.marks.peek() else {
                let what = format!("output {changed} changes, and the program changes none there");
                return self.fail(what, ps);
            };
            if !follow.may_be_at(mark.leg) {
                let line = mark.line;
                let what = format!(
                    "output {changed} changes before the tool is where line {line} changes outputs"
                );
                return self.fail(what, ps);
            }
            self.apply(ps);
        }
    }

    /// The next mark takes effect.
    fn apply(&mut self, ps: u64) {
        let Some(mark) = self.marks.next() else { return };
        let OutputMark { change: OutputChange { mask, levels, .. }, dwells, line, .. } = mark;
        let mask = mask & self.mask;
        self.marked = (self.marked & !mask) | (levels & mask);
        self.passed = None;
        if dwells && self.marked != self.found {
            self.missing(line, ps);
        }
    }

    /// The tool has moved. A mark that it has passed must have taken effect.
    pub fn moved(&mut self, ps: u64, follow: &PathFollow<'_>) {
        while self.wrong.is_none()
            && let Some(mark) = self.marks.peek().copied()
            && follow.is_behind(mark.leg)
        {
            let passed = *self.passed.get_or_insert(ps);
            let late = if mark.at_rest { 0 } else { LATE_PS };
            if ps < passed.saturating_add(late).saturating_add(self.slack_ps) {
                return;
            }
            self.apply(ps);
            // Marks that were passed together show only the last level.
            while self.wrong.is_none()
                && self.marked != self.found
                && self.marks.peek().is_some_and(|next| follow.may_be_at(next.leg))
            {
                self.apply(ps);
            }
            if self.marked != self.found {
                self.missing(mark.line, ps);
            }
        }
    }

    /// The capture has ended.
    pub fn end(&mut self, ps: u64, follow: &PathFollow<'_>) {
        self.compare(follow);
        let mut line = 0;
        while self.wrong.is_none()
            && let Some(mark) = self.marks.peek()
        {
            // From this mark on, the levels differ.
            line = if self.marked == self.found { mark.line } else { line };
            self.apply(ps);
        }
        if self.marked != self.found {
            self.missing(line, ps);
        }
    }

    fn missing(&mut self, line: u64, ps: u64) {
        let number = (self.found ^ self.marked).trailing_zeros();
        self.fail(format!("output {number} does not change where line {line} does it"), ps);
    }

    fn fail(&mut self, what: String, ps: u64) {
        self.wrong.get_or_insert(Misplaced { what, ps });
    }
}

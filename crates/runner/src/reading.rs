//! How far the rows of a stretch have been read, and what the axes have not taken of them.
//!
//! ```text
//! rows      r0   r1   r2   r3   r4   r5 | r6 ...        r6 has not been read
//! read           |--------------------->|               the last ones, kept for a cut
//! segments                 x: s4, s5   y: s5            what the axes have not taken
//! rewind 3                 |<-----------|               r3 is the next row that is read
//! ```

use carrystep_core::{OutputChange, Segment};
use carrystep_program::{Row, outputs};
use std::collections::VecDeque;

/// Rows that are kept after they were read: those of the deepest queue, and those that are on their
/// way there.
const KEPT: usize = 64;

/// A place in the rows of a program.
#[derive(Debug, Clone)]
pub(crate) struct Reading {
    /// Rows that come before those of the planner.
    pub ahead: VecDeque<Row>,
    /// The rows of the stretch that were read last, each with P of each axis where it begins, 2^-64
    /// step from machine zero.
    read: VecDeque<(Row, Vec<i128>)>,
    /// Number of rows of the stretch that were read.
    count: u32,
    /// P of each axis where the next row begins.
    pub at: Vec<i128>,
    /// Rows of the stretch that are still to be read, if a hold has shortened it.
    pub left: Option<usize>,
    /// The line in which a hold brings the motion to rest at the end of the stretch.
    pub held: Option<u64>,
    /// Segments of each axis that were read and not taken.
    pub segments: Vec<VecDeque<Segment>>,
    /// The changes of outputs of the rows of which axis 0 has not taken its segment.
    pub outputs: VecDeque<OutputChange>,
    /// What changes with the segment that axis 0 has just taken.
    pub change: OutputChange,
    /// Whether the last row that was read is the last of its stretch.
    pub whole: bool,
}

impl Reading {
    /// Nothing has been read; the rows begin at these steps from machine zero.
    pub fn new(start_steps: &[i64]) -> Self {
        Self {
            ahead: VecDeque::new(),
            read: VecDeque::new(),
            count: 0,
            at: start_steps.iter().map(|&steps| i128::from(steps) << 64).collect(),
            left: None,
            held: None,
            segments: vec![VecDeque::new(); start_steps.len()],
            outputs: VecDeque::new(),
            change: OutputChange::NONE,
            whole: true,
        }
    }

    /// Begins a stretch.
    pub fn begin(&mut self) {
        self.forget();
        self.read.clear();
        self.count = 0;
        (self.left, self.whole) = (None, false);
    }

    /// Drops what was read and not taken.
    fn forget(&mut self) {
        self.segments.iter_mut().for_each(VecDeque::clear);
        self.outputs.clear();
        self.change = OutputChange::NONE;
    }

    /// The row that was read last, and P of each axis where it begins.
    pub fn last(&self) -> Option<&(Row, Vec<i128>)> {
        self.read.back()
    }

    /// The rows that were read last, at most so many, with P of each axis where each begins.
    pub fn recent(&self, most: usize) -> impl Iterator<Item = &(Row, Vec<i128>)> {
        self.read.iter().skip(self.read.len().saturating_sub(most))
    }

    /// Reads a row, of which `ends` says whether the motion rests behind it though the planner's
    /// goes on.
    pub fn take(&mut self, row: Row, ends: bool, travel: impl Fn(&Segment) -> i128) {
        let before = self.at.clone();
        self.outputs.push_back(outputs(&row));
        let places = self.at.iter_mut().zip(&mut self.segments);
        for ((at, queue), segment) in places.zip(&row.segments) {
            *at += travel(segment);
            queue.push_back(Segment { last: ends || segment.last, ..*segment });
        }
        if self.read.len() == KEPT {
            self.read.pop_front();
        }
        self.read.push_back((row, before));
        self.count += 1;
    }

    /// The number of rows from the first on that last for so many ticks behind the first `begun`
    /// rows, if they have been read.
    pub fn behind(&self, begun: u32, ticks: u64) -> Option<u32> {
        let first = self.count - self.read.len() as u32;
        let mut lasts = 0;
        let skipped = begun.checked_sub(first)?;
        for (number, (row, _)) in (begun..).zip(self.read.iter().skip(skipped as usize)) {
            lasts += u64::from(row.ticks);
            if lasts >= ticks {
                return Some(number + 1);
            }
        }
        None
    }

    /// Goes back to the end of the first `keep` rows; false if that row is not kept.
    pub fn rewind(&mut self, keep: u32) -> bool {
        let first = self.count - self.read.len() as u32;
        if keep <= first || keep > self.count {
            return false;
        }
        while self.count > keep {
            if let Some((row, at)) = self.read.pop_back() {
                self.ahead.push_front(row);
                self.at = at;
            }
            self.count -= 1;
        }
        self.forget();
        self.whole = false;
        true
    }
}

//! How far the rows of a stretch have been read, and what the axes have not taken of them.
//!
//! ```text
//! rows      r0   r1   r2   r3   r4   r5 | r6 ...        r6 has not been read
//! read           |--------------------->|               the last ones, kept for a cut
//! segments                 x: s4, s5   y: s5            what the axes have not taken
//! rewind 3                 |<-----------|               r3 is the next row that is read
//! ```

use crate::spindle::Spindle;
use carrystep_core::{OutputChange, Segment};
use carrystep_job::{Pace, PacePlace};
use carrystep_program::{Row, RowOutputs};
use std::collections::VecDeque;

/// Rows that are kept after they were read: those of the deepest queue, and those that are on their
/// way there.
const KEPT: usize = 64;

/// A row that is to be read.
#[derive(Debug, Clone)]
pub(crate) struct NextRow {
    pub row: Row,
    /// Planned ticks per tick where it begins.
    pub rate: f64,
    /// Where it begins in the plan; `None` for the rows of a hold.
    pub from: Option<PacePlace>,
}

impl NextRow {
    /// A row that is not of the plan.
    pub const fn own(row: Row) -> Self {
        Self { row, rate: 1.0, from: None }
    }
}

/// A row that was read.
#[derive(Debug, Clone)]
struct ReadRow {
    /// The row, and P of each axis where it begins, 2^-64 step from machine zero.
    row: (Row, Vec<i128>),
    rate: f64,
    from: Option<PacePlace>,
    /// The outputs and the spindle before it.
    outputs: RowOutputs,
    spindle: Spindle,
    switched: OutputChange,
    /// What changed with it besides what the program says.
    added: OutputChange,
}

/// A place in the rows of a program.
#[derive(Debug, Clone)]
pub(crate) struct Reading {
    /// The planned rows at the rates of the overrides.
    pub pace: Pace,
    /// Rows that come before those of `pace`.
    pub ahead: VecDeque<NextRow>,
    /// The rows of the stretch that were read last.
    read: VecDeque<ReadRow>,
    /// The outputs and the spindle behind the rows that were read.
    pub row_outputs: RowOutputs,
    spindle: Spindle,
    /// All changes of outputs of the rows of the stretch that were read, as one.
    pub switched: OutputChange,
    /// What changes with the next row that is read besides what the program says.
    pub pending: OutputChange,
    /// Planned ticks per tick in the row that was read last.
    pub rate: f64,
    /// Number of rows of the stretch that were read.
    count: u32,
    /// P of each axis where the next row begins.
    pub at: Vec<i128>,
    /// Rows of the stretch that are still to be read, if a hold has shortened it.
    pub left: Option<usize>,
    /// Planned ticks of the rows that were read, those of holds included.
    pub gone: f64,
    /// Ticks by which holds have made the motion longer than planned.
    pub added: f64,
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
    pub fn new(start_steps: &[i64], pace: Pace, row_outputs: RowOutputs) -> Self {
        Self {
            pace,
            row_outputs,
            spindle: Spindle::default(),
            switched: OutputChange::NONE,
            pending: OutputChange::NONE,
            rate: 1.0,
            ahead: VecDeque::new(),
            read: VecDeque::new(),
            count: 0,
            at: start_steps.iter().map(|&steps| i128::from(steps) << 64).collect(),
            left: None,
            gone: 0.0,
            added: 0.0,
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
        self.switched = OutputChange::NONE;
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
        self.read.back().map(|read| &read.row)
    }

    /// Where the first row that is kept begins in the plan; that of the next one if none is kept.
    pub fn oldest(&self) -> Option<&PacePlace> {
        let read = self.read.iter().map(|read| read.from.as_ref());
        read.chain(self.ahead.iter().map(|next| next.from.as_ref())).flatten().next()
    }

    /// The rows that were read last, at most so many, with P of each axis where each begins.
    pub fn recent(&self, most: usize) -> impl Iterator<Item = &(Row, Vec<i128>)> {
        self.read.iter().skip(self.read.len().saturating_sub(most)).map(|read| &read.row)
    }

    /// Reads a row, of which `ends` says whether the motion rests behind it though the planner's
    /// goes on. The spindle turns at so many percent of its speed.
    pub fn take(
        &mut self,
        next: NextRow,
        ends: bool,
        percent: u8,
        travel: impl Fn(&Segment) -> i128,
    ) {
        let NextRow { row, rate, from } = next;
        let (before, spindle, switched) = (self.at.clone(), self.spindle, self.switched);
        let outputs = self.row_outputs.clone();
        let added = std::mem::take(&mut self.pending);
        let change = added.then(self.row_outputs.change(&row));
        let change = self.spindle.turns(change, percent);
        self.outputs.push_back(change);
        self.switched = switched.then(change);
        self.rate = rate;
        self.gone += f64::from(row.ticks) * rate;
        let places = self.at.iter_mut().zip(&mut self.segments);
        for ((at, queue), segment) in places.zip(&row.segments) {
            *at += travel(segment);
            queue.push_back(Segment { last: ends || segment.last, ..*segment });
        }
        if self.read.len() == KEPT {
            self.read.pop_front();
        }
        let row = (row, before);
        self.read.push_back(ReadRow { row, rate, from, outputs, spindle, switched, added });
        self.count += 1;
    }

    /// The number of rows from the first on that last for so many ticks behind the first `begun`
    /// rows, if they have been read.
    pub fn behind(&self, begun: u32, ticks: u64) -> Option<u32> {
        let first = self.count - self.read.len() as u32;
        let mut lasts = 0;
        let skipped = begun.checked_sub(first)?;
        for (number, read) in (begun..).zip(self.read.iter().skip(skipped as usize)) {
            lasts += u64::from(read.row.0.ticks);
            if lasts >= ticks {
                return Some(number + 1);
            }
        }
        None
    }

    /// How long the rows last from the first `begun` rows on, up to the first `sent` ones, ticks.
    pub fn lasts(&self, begun: u32, sent: u32) -> u64 {
        let first = self.count - self.read.len() as u32;
        let rows = (first..).zip(&self.read).filter(|(number, _)| (begun..sent).contains(number));
        rows.map(|(_, read)| u64::from(read.row.0.ticks)).sum()
    }

    /// Goes back to the end of the first `keep` rows; false if that row is not kept.
    pub fn rewind(&mut self, keep: u32) -> bool {
        let first = self.count - self.read.len() as u32;
        if keep <= first || keep > self.count {
            return false;
        }
        while self.count > keep {
            if let Some(read) = self.read.pop_back() {
                let ReadRow { row: (row, at), rate, from, outputs, spindle, .. } = read;
                self.switched = read.switched;
                self.pending = read.added.then(self.pending);
                self.gone -= f64::from(row.ticks) * rate;
                self.ahead.push_front(NextRow { row, rate, from });
                (self.at, self.row_outputs, self.spindle) = (at, outputs, spindle);
            }
            self.count -= 1;
        }
        self.forget();
        self.whole = false;
        true
    }
}

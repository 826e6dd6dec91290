//! The planned rows that an override looks at, numbered from the beginning of the program, and where
//! the motors are in them.

use crate::keep::REST;
use crate::row::Row;
use carrystep_core::Segment;
use carrystep_plan::exact::travel;
use std::collections::VecDeque;

/// Distance in a row below which a motor rests where the row begins, 2^-64 step.
const STILL: i128 = 1 << 44;

/// Planned rows of a program, of which those at the front may have been dropped.
#[derive(Debug)]
pub struct Track {
    /// Number of the first row that is kept.
    first: u64,
    rows: VecDeque<Row>,
    /// For each row that is kept, and for the end of the last one: P of each motor, 2^-64 step from
    /// machine zero.
    begins: VecDeque<Vec<i128>>,
    /// Whether no row follows.
    whole: bool,
}

impl Track {
    /// No rows yet; the first one begins at these steps from machine zero.
    pub fn new(start_steps: &[i64]) -> Self {
        let at = start_steps.iter().map(|&steps| i128::from(steps) << 64).collect();
        Self { first: 0, rows: VecDeque::new(), begins: VecDeque::from([at]), whole: false }
    }

    /// Takes rows until the row `number` is there; false if there is no such row.
    pub(super) fn take(&mut self, number: u64, source: &mut dyn FnMut() -> Option<Row>) -> bool {
        while self.end() <= number && !self.whole {
            match source() {
                Some(row) => {
                    let at = &self.begins[self.begins.len() - 1];
                    let motors = at.iter().zip(&row.segments);
                    let end = motors.map(|(at, one)| at + travel(one, one.ticks.into())).collect();
                    self.begins.push_back(end);
                    self.rows.push_back(row);
                }
                None => self.whole = true,
            }
        }
        number < self.end()
    }

    /// Number of the row behind the last one.
    pub(super) fn end(&self) -> u64 {
        self.first + self.rows.len() as u64
    }

    /// Number of the first row that is kept.
    pub(super) const fn first(&self) -> u64 {
        self.first
    }

    /// Drops the rows before a row.
    pub(super) fn forget(&mut self, before: u64) {
        let count = before.saturating_sub(self.first).min(self.rows.len() as u64);
        self.rows.drain(..count as usize);
        self.begins.drain(..count as usize);
        self.first += count;
    }

    fn index(&self, number: u64) -> Option<usize> {
        number.checked_sub(self.first).and_then(|index| usize::try_from(index).ok())
    }

    /// A row that is kept.
    pub(super) fn row(&self, number: u64) -> Option<&Row> {
        self.index(number).and_then(|index| self.rows.get(index))
    }

    /// P of each motor where a row begins.
    pub(super) fn at(&self, number: u64) -> Option<&Vec<i128>> {
        self.index(number).and_then(|index| self.begins.get(index))
    }

    /// The segments of a row; at rest where there is no such row.
    pub(super) fn segments(&self, number: Option<u64>, motors: usize) -> Vec<Segment> {
        let row = number.and_then(|number| self.row(number));
        row.map_or_else(|| vec![REST; motors], |row| row.segments.clone())
    }

    /// Whether all motors rest where a row begins: P of each is at a whole number of steps, as where
    /// a run of the planner ends, and the row begins without speed.
    pub(super) fn rests(&self, number: u64) -> bool {
        let (Some(at), Some(row)) = (self.at(number), self.row(number)) else { return true };
        let still = |one: &Segment| {
            let begin = Segment { a: 0, j: 0, ..*one };
            travel(&begin, one.ticks.into()).abs() < STILL
        };
        at.iter().all(|at| at & ((1 << 64) - 1) == 0) && row.segments.iter().all(still)
    }

    /// Whether a motor moves in a row.
    pub(super) fn moves(&self, number: u64) -> bool {
        let moves = |one: &Segment| (one.v, one.a, one.j) != (0, 0, 0);
        self.row(number).is_some_and(|row| row.segments.iter().any(moves))
    }
}

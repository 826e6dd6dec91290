//! In which executed block of the program the tool is, by the positions of the axes.

use carrystep_core::Segment;
use carrystep_plan::exact::travel;
use std::collections::VecDeque;

/// An executed block, and its line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BlockAt {
    /// Number of the block, from 1.
    pub block: u64,
    /// The line of the program.
    pub line: u64,
}

/// A row that was read: the block that it reaches, and the steps of each axis from machine zero at
/// its beginning and its end.
#[derive(Debug)]
struct Passed {
    at: BlockAt,
    ends: Vec<[f64; 2]>,
}

/// The rows that the board may not have finished.
#[derive(Debug)]
pub(crate) struct Recent {
    rows: VecDeque<Passed>,
    most: usize,
}

/// Rows that are read and not in a queue: the one that runs, and those on the line.
const ON_THE_WAY: usize = 4;

/// Steps by which a position may be off a row: pulses are late by up to two, and P is rounded.
const NEAR: f64 = 2.0;

/// 2^64, the units of a step.
const STEP: f64 = 18_446_744_073_709_551_616.0;

impl Recent {
    /// No rows, for a board with queues of this length.
    pub(crate) fn of_queue(queue: usize) -> Self {
        Self { rows: VecDeque::new(), most: queue.saturating_add(ON_THE_WAY) }
    }

    /// Adds a row that begins at these P, 2^-64 step from machine zero.
    pub(crate) fn add(&mut self, at: BlockAt, begin: &[i128], segments: &[Segment]) {
        let ends = begin.iter().zip(segments).map(|(&begin, segment)| {
            let end = begin + travel(segment, segment.ticks.into());
            [begin, end].map(|units| units as f64 / STEP)
        });
        self.rows.push_back(Passed { at, ends: ends.collect() });
        while self.rows.len() > self.most {
            self.rows.pop_front();
        }
    }

    /// The block of the row that is nearest to these positions, steps from machine zero: of equal
    /// ones the first, so that nothing is left out by whoever goes on there.
    pub(crate) fn nearest(&self, positions: &[i64]) -> Option<BlockAt> {
        let off = |row: &Passed| {
            let axes = row.ends.iter().zip(positions);
            let off = |(&[begin, end], &position): (&[f64; 2], &i64)| {
                let position = position as f64;
                let (least, most) = (begin.min(end) - NEAR, begin.max(end) + NEAR);
                (least - position).max(position - most).max(0.0)
            };
            axes.map(off).fold(0.0, f64::max)
        };
        let mut best: Option<(f64, BlockAt)> = None;
        for row in &self.rows {
            let off = off(row);
            if best.is_none_or(|(least, _)| off < least) {
                best = Some((off, row.at));
            }
        }
        best.map(|(_, at)| at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recent(rows: &[(u64, i64)]) -> Recent {
        let mut recent = Recent::of_queue(4);
        let mut at = 0_i128;
        for &(block, steps) in rows {
            let v = steps << 44;
            let segment = Segment { ticks: 1 << 20, v, a: 0, j: 0, last: false };
            recent.add(BlockAt { block, line: 1 }, &[at], &[segment]);
            at += i128::from(steps) << 64;
        }
        recent
    }

    #[test]
    fn block_is_that_of_the_nearest_row() {
        let recent = recent(&[(1, 10), (1, 10), (2, 30), (3, 0), (4, -40)]);
        let block = |position| recent.nearest(&[position]).map(|at| at.block);
        assert_eq!([block(-90), block(15), block(35), block(99)].map(Option::unwrap), [1, 1, 2, 2]);
        assert_eq!(Recent::of_queue(4).nearest(&[0]), None);
    }

    #[test]
    fn rows_that_the_board_has_finished_are_forgotten() {
        let rows: Vec<(u64, i64)> = (1..=20).map(|block| (block, 1000)).collect();
        assert_eq!(recent(&rows).nearest(&[0]).map(|at| at.block), Some(13));
    }
}

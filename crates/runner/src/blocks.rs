//! In which executed block of the program the tool is, by the positions of the axes.

use carrystep_plan::exact::travel;
use carrystep_program::Row;

/// An executed block, and its line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BlockAt {
    /// Number of the block, from 1.
    pub block: u64,
    /// The line of the program.
    pub line: u64,
}

/// Steps by which a position may be off a row: pulses are late by up to two, and P is rounded.
const NEAR: f64 = 2.0;

/// 2^64, the units of a step.
const STEP: f64 = 18_446_744_073_709_551_616.0;

/// The block of the row that is nearest to these positions, steps from machine zero: of equal ones
/// the first, so that nothing is left out by whoever goes on there. The rows come with P of each axis
/// where each begins, 2^-64 step from machine zero.
pub(crate) fn nearest<'a>(
    rows: impl Iterator<Item = &'a (Row, Vec<i128>)>,
    positions: &[i64],
) -> Option<BlockAt> {
    let off = |(row, at): &(Row, Vec<i128>)| {
        let axes = at.iter().zip(&row.segments).zip(positions);
        let off = |((&begin, segment), &position)| {
            let end = begin + travel(segment, segment.ticks.into());
            let [begin, end] = [begin, end].map(|units| units as f64 / STEP);
            let position = position as f64;
            let (least, most) = (begin.min(end) - NEAR, begin.max(end) + NEAR);
            (least - position).max(position - most).max(0.0)
        };
        axes.map(off).fold(0.0, f64::max)
    };
    let mut best: Option<(f64, BlockAt)> = None;
    for passed in rows {
        let (off, Row { block, line, .. }) = (off(passed), &passed.0);
        if best.is_none_or(|(least, _)| off < least) {
            best = Some((off, BlockAt { block: *block, line: *line }));
        }
    }
    best.map(|(_, at)| at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_core::Segment;

    fn rows(rows: &[(u64, i64)]) -> Vec<(Row, Vec<i128>)> {
        let mut at = 0_i128;
        let row = |&(block, steps): &(u64, i64)| {
            let segment = Segment { ticks: 1 << 20, v: steps << 44, a: 0, j: 0, last: false };
            let begin = vec![at];
            at += i128::from(steps) << 64;
            let (feed, off, corner) = (1.0, 0.0, 0.0);
            let (ticks, segments, marks) = (1 << 20, vec![segment], Vec::new());
            (Row { ticks, segments, line: 1, block, feed, off, corner, marks, rests: false }, begin)
        };
        rows.iter().map(row).collect()
    }

    #[test]
    fn block_is_that_of_the_nearest_row() {
        let rows = rows(&[(1, 10), (1, 10), (2, 30), (3, 0), (4, -40)]);
        let block = |position| nearest(rows.iter(), &[position]).map(|at| at.block);
        assert_eq!([block(-90), block(15), block(35), block(99)].map(Option::unwrap), [1, 1, 2, 2]);
        assert_eq!(nearest(rows.iter().take(0), &[0]), None);
    }
}

//! Numbers of the caller for places of the path, from where they are pushed to the rows that carry
//! them.
//!
//! ```text
//! path     ------------m---------       the place of a mark
//! rows     | row 1 | row 2 | row 3 |    reached in row 2
//!                          ^            a mark is at the start of row 3,
//!                  ^                    or of row 2, if that is nearer and it may be early
//! ```

use std::collections::VecDeque;

/// A number of the caller for a place of the path.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mark {
    pub number: u64,
    /// Whether it may come before the place, if that is nearer.
    pub may_be_early: bool,
}

/// A mark, the piece before which it is, and the place, units of 2^-64 step.
#[derive(Debug)]
struct Marked<const N: usize> {
    mark: Mark,
    piece: u64,
    at: [i128; N],
}

/// Marks that no row has, in their order.
#[derive(Debug, Default)]
pub(crate) struct Marks<const N: usize>(VecDeque<Marked<N>>);

impl<const N: usize> Marks<N> {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds a mark at the start of a piece, where the motors are at `at`.
    pub fn push(&mut self, mark: Mark, piece: u64, at: [i128; N]) {
        self.0.push_back(Marked { mark, piece, at });
    }

    /// Takes the marks of a row: the path has reached one piece at its start, and another one at its
    /// end, where the motors are at these places.
    pub fn take(&mut self, [reached, passed]: [u64; 2], [begin, end]: [&[i128; N]; 2]) -> Vec<u64> {
        let mut numbers = Vec::new();
        while let Some(next) = self.0.front() {
            let is_near = next.mark.may_be_early
                && next.piece <= passed
                && distance(&next.at, begin) < distance(&next.at, end);
            if next.piece > reached && !is_near {
                break;
            }
            numbers.push(next.mark.number);
            self.0.pop_front();
        }
        numbers
    }
}

/// The distance of two places of the motors, units of 2^-64 step.
fn distance<const N: usize>(a: &[i128; N], b: &[i128; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| ((a - b) as f64).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(number: u64, may_be_early: bool) -> Mark {
        Mark { number, may_be_early }
    }

    #[test]
    fn early_mark_has_the_nearer_row_and_others_the_next_one() {
        for (may_be_early, at, first, second) in [
            (true, 40, vec![7], vec![]),
            (true, 60, vec![], vec![7]),
            (true, 50, vec![], vec![7]),
            (false, 1, vec![], vec![7]),
        ] {
            let mut marks = Marks::default();
            marks.push(mark(7, may_be_early), 3, [at]);
            assert_eq!(marks.take([2, 3], [&[0], &[100]]), first, "{at}");
            assert_eq!(marks.take([3, 3], [&[100], &[200]]), second, "{at}");
            assert!(marks.is_empty());
        }
    }

    #[test]
    fn marks_keep_their_order() {
        let mut marks = Marks::default();
        marks.push(mark(1, false), 3, [40]);
        marks.push(mark(2, true), 3, [40]);
        assert!(marks.take([2, 3], [&[0], &[100]]).is_empty());
        assert_eq!(marks.take([3, 3], [&[100], &[200]]), [1, 2]);
        // A piece that the row does not reach.
        marks.push(mark(3, true), 9, [210]);
        assert!(marks.take([3, 8], [&[200], &[300]]).is_empty());
    }
}

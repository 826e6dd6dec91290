//! Sums and greatest values over all moves of a plan. They are found before anything moves, and
//! they are all that is kept of a plan of any length.

use crate::peaks::Peaks;
use crate::plan::{PlannedAxis, PlannedMove};
use carrystep_core::Segment;
use carrystep_files::PathKind;
use carrystep_profile::Travel;

/// Sums and greatest values of all moves.
#[derive(Debug, Clone, Default)]
pub struct Totals {
    /// Number of moves.
    pub moves: u64,
    /// Ticks from the origin to the end of the last move.
    pub ticks: u64,
    /// Whether the axes keep to a straight line in any move.
    pub straight: bool,
    /// Each axis, in the order of the machine file; empty if there is no move.
    pub axes: Vec<AxisTotals>,
}

/// Sums and greatest values of one axis.
#[derive(Debug, Clone, Default)]
pub struct AxisTotals {
    /// What the axis does in all moves together.
    pub travel: Travel,
    /// Number of segments.
    pub segments: u64,
    /// The distance of all segments together, 2^-64 step, negative backward.
    pub distance: i128,
    /// Greatest values.
    pub peaks: Peaks,
}

impl Totals {
    /// Adds the next move.
    pub fn add(&mut self, planned: &PlannedMove) {
        self.moves += 1;
        self.ticks = planned.start_tick + planned.ticks;
        self.straight |= planned.path == PathKind::Straight;
        self.axes.resize(planned.axes.len(), AxisTotals::default());
        for (number, (totals, axis)) in self.axes.iter_mut().zip(&planned.axes).enumerate() {
            totals.add(axis);
            if let Some(leg) = planned.leg(number) {
                totals.travel.add(&leg);
            }
        }
    }

    /// Number of segments of all axes.
    pub fn segments(&self) -> u64 {
        self.axes.iter().map(|axis| axis.segments).sum()
    }
}

impl<'a> FromIterator<&'a PlannedMove> for Totals {
    fn from_iter<I: IntoIterator<Item = &'a PlannedMove>>(moves: I) -> Self {
        let mut totals = Self::default();
        moves.into_iter().for_each(|planned| totals.add(planned));
        totals
    }
}

impl AxisTotals {
    fn add(&mut self, axis: &PlannedAxis) {
        self.segments += axis.segments.len() as u64;
        self.distance += axis.segments.iter().map(distance).sum::<i128>();
        self.peaks = self.peaks.with(&axis.peaks);
    }

    /// P at the end minus P at the start, 2^-64 step: 0 if the axis ends exactly at its target.
    pub fn residue(&self) -> i128 {
        self.distance - (i128::from(self.travel.position) << 64)
    }
}

/// The exact distance of a segment, 2^-64 step.
fn distance(segment: &Segment) -> i128 {
    let n = i128::from(segment.ticks);
    let (v, a, j) = (i128::from(segment.v), i128::from(segment.a), i128::from(segment.j));
    n * v + n * (n - 1) / 2 * a + n * (n - 1) * (n - 2) / 6 * j
}

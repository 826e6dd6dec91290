//! The edges on the pins of all axes, merged into one stream in order of time.

use crate::parts::shaper;
use carrystep_core::engine::MAX_AXES;

/// A change on an axis' pins. STEP always falls `step_high` clocks after it rises, so its falling
/// edge is not reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Change {
    /// STEP rises.
    Rise,
    /// DIR changes its level.
    DirChange,
}

/// A change on the pins of one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Edge {
    /// The first clock cycle with the new level, from 0.
    pub clock: u64,
    /// Number of the axis, from 0.
    pub axis: u8,
    /// The kind of change.
    pub change: Change,
    /// The level of DIR after the change; true is backward.
    pub backward: bool,
}

/// A receiver of edges, in order of clock and then of axis.
pub trait Edges {
    /// Receives one edge.
    fn edge(&mut self, edge: Edge);

    /// Receives the levels of the engine's outputs, one bit each, from the clock in which one of
    /// them has changed.
    fn levels(&mut self, _clock: u64, _levels: u8) {}

    /// Receives the duty of the engine's PWM, 0 to 4095, from the clock on in which it has changed,
    /// with the level of the pin in that clock. The pin's further changes follow from the duty.
    fn duty(&mut self, _clock: u64, _duty: u16, _level: bool) {}

    /// Receives the level of the PWM's pin from the clock on in which it has changed, instead of the
    /// duty from which it follows.
    fn pwm(&mut self, _clock: u64, _level: bool) {}
}

/// Collects every edge; for tests and short runs.
impl Edges for Vec<Edge> {
    fn edge(&mut self, edge: Edge) {
        self.push(edge);
    }
}

/// Ignores the edges.
impl Edges for () {
    fn edge(&mut self, _: Edge) {}
}

/// An edge packed into 64 bits. Records compare as edges are ordered: clock, axis, change, DIR.
pub(super) type Record = u64;

impl Edge {
    #[inline]
    pub(super) const fn record(self) -> Record {
        let dir_change = matches!(self.change, Change::DirChange) as u64;
        self.clock << 5 | (self.axis as u64) << 2 | dir_change << 1 | self.backward as u64
    }

    #[inline]
    const fn from_record(record: Record) -> Self {
        let change = if record >> 1 & 1 == 1 { Change::DirChange } else { Change::Rise };
        Self {
            clock: record >> 5,
            axis: (record >> 2 & 7) as u8,
            change,
            backward: record & 1 == 1,
        }
    }
}

/// Reports the edges on an axis' pins between two consecutive states.
pub(super) fn changes(
    clock: u64,
    axis: u8,
    before: &shaper::ShaperState,
    now: &shaper::ShaperState,
    to: &mut (impl Edges + ?Sized),
) {
    let backward = now.dir;
    if now.position != before.position {
        to.edge(Edge { clock, axis, change: Change::Rise, backward });
    }
    if now.dir != before.dir {
        to.edge(Edge { clock, axis, change: Change::DirChange, backward });
    }
}

/// The edges of one window; those of each axis are in order of time.
#[derive(Debug, Clone)]
pub(super) struct Window {
    /// One list per axis, with [`Record::MIN`] before its edges and [`Record::MAX`] behind them
    /// during a merge.
    axes: [Vec<Record>; MAX_AXES],
    /// The later half of the edges, in reverse order.
    late: Vec<Record>,
}

impl Default for Window {
    fn default() -> Self {
        Self { axes: std::array::from_fn(|_| vec![Record::MIN]), late: Vec::new() }
    }
}

impl Window {
    /// Empties all lists and returns them, one per axis.
    pub fn clear(&mut self) -> &mut [Vec<Record>] {
        self.axes.iter_mut().for_each(|axis| axis.truncate(1));
        &mut self.axes
    }

    /// Reports the edges of all axes in order of time.
    pub fn merge(&mut self, to: &mut impl Edges) {
        let edges = self.axes.iter().map(Vec::len).sum::<usize>() - MAX_AXES;
        if edges == 0 {
            return;
        }
        self.axes.iter_mut().for_each(|axis| axis.push(Record::MAX));
        let Self { axes, late } = self;
        let [a, b, c, d, e, f, g, h] = axes.each_ref().map(Vec::as_slice);
        if g.len() + h.len() == 4 {
            merge([a, b, c, d, e, f], edges, late, to);
        } else {
            merge([a, b, c, d, e, f, g, h], edges, late, to);
        }
    }
}

/// Merges from both ends at once. Each search depends on the result of the previous one, so two
/// independent searches take no longer than one. The selection is branch-free, because the next
/// axis cannot be predicted.
fn merge<const N: usize>(
    axes: [&[Record]; N],
    edges: usize,
    late: &mut Vec<Record>,
    to: &mut impl Edges,
) {
    let (mut next, mut last) = ([1; N], axes.map(|axis| axis.len() - 2));
    late.clear();
    for _ in 0..edges / 2 {
        let heads: [Record; N] = std::array::from_fn(|axis| axes[axis][next[axis]]);
        let tails: [Record; N] = std::array::from_fn(|axis| axes[axis][last[axis]]);
        let (least, greatest) = (best(heads, Record::min), best(tails, Record::max));
        for axis in 0..N {
            // All records differ, because each contains the number of its axis.
            next[axis] += usize::from(heads[axis] == least);
            last[axis] -= usize::from(tails[axis] == greatest);
        }
        to.edge(Edge::from_record(least));
        late.push(greatest);
    }
    if edges % 2 == 1 {
        to.edge(Edge::from_record(best(
            std::array::from_fn::<_, N, _>(|axis| axes[axis][next[axis]]),
            Record::min,
        )));
    }
    late.iter().rev().for_each(|record| to.edge(Edge::from_record(*record)));
}

/// Returns the least or the greatest record with the fewest dependent comparisons.
#[inline(always)]
fn best<const N: usize>(
    mut records: [Record; N],
    better: impl Fn(Record, Record) -> Record,
) -> Record {
    let mut count = N;
    while count > 1 {
        let half = count / 2;
        for i in 0..half {
            records[i] = better(records[i], records[count - 1 - i]);
        }
        count -= half;
    }
    records[0]
}

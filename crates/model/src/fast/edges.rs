//! What happens on the pins, and six streams of it as one.

use crate::parts::shaper;
use carrystep_core::engine::MAX_AXES;

/// What changes on an axis' pins. STEP falls W clocks after it rises, always, so that is not told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Change {
    /// STEP rises.
    Rise,
    /// DIR turns.
    Turn,
}

/// A change on the pins of one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Edge {
    /// The first clock cycle with the new level.
    pub clock: u64,
    /// Which axis.
    pub axis: u8,
    /// What.
    pub change: Change,
    /// The level of DIR.
    pub backward: bool,
}

/// Who wants to hear of every edge, in order of clock, then axis.
pub trait Edges {
    /// One edge.
    fn edge(&mut self, edge: Edge);
}

/// Keeps every edge: for tests and short runs.
impl Edges for Vec<Edge> {
    fn edge(&mut self, edge: Edge) {
        self.push(edge);
    }
}

/// Nobody wants to.
impl Edges for () {
    fn edge(&mut self, _: Edge) {}
}

/// An edge in 64 bits that order as edges do: clock, axis, change, DIR.
pub(super) type Record = u64;

impl Edge {
    #[inline]
    pub(super) const fn record(self) -> Record {
        let turn = matches!(self.change, Change::Turn) as u64;
        self.clock << 5 | (self.axis as u64) << 2 | turn << 1 | self.backward as u64
    }

    #[inline]
    const fn from_record(record: Record) -> Self {
        let change = if record >> 1 & 1 == 1 { Change::Turn } else { Change::Rise };
        Self { clock: record >> 5, axis: (record >> 2 & 7) as u8, change, backward: record & 1 == 1 }
    }
}

/// What one clock has changed on an axis' pins.
pub(super) fn changes(clock: u64, axis: u8, before: &shaper::State, now: &shaper::State, to: &mut impl Edges) {
    let backward = now.dir;
    if now.position != before.position {
        to.edge(Edge { clock, axis, change: Change::Rise, backward });
    }
    if now.dir != before.dir {
        to.edge(Edge { clock, axis, change: Change::Turn, backward });
    }
}

/// The edges of one window, each axis' in order.
#[derive(Debug, Clone)]
pub(super) struct Window {
    /// Between the least and the greatest record there is.
    axes: [Vec<Record>; MAX_AXES],
    /// The later half, the last edge first.
    late: Vec<Record>,
}

impl Default for Window {
    fn default() -> Self {
        Self { axes: std::array::from_fn(|_| vec![Record::MIN]), late: Vec::new() }
    }
}

impl Window {
    /// None yet; one list for each axis, behind [`Record::MIN`].
    pub fn clear(&mut self) -> &mut [Vec<Record>] {
        self.axes.iter_mut().for_each(|axis| axis.truncate(1));
        &mut self.axes
    }

    /// Hands over the edges of all axes in order.
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

/// From both ends at once: what is first has to be known before the second can be looked for, and so two
/// searches take no longer than one. Without a branch on who is first, which cannot be predicted.
fn merge<const N: usize>(axes: [&[Record]; N], edges: usize, late: &mut Vec<Record>, to: &mut impl Edges) {
    let (mut next, mut last) = ([1; N], axes.map(|axis| axis.len() - 2));
    late.clear();
    for _ in 0..edges / 2 {
        let heads: [Record; N] = std::array::from_fn(|axis| axes[axis][next[axis]]);
        let tails: [Record; N] = std::array::from_fn(|axis| axes[axis][last[axis]]);
        let (least, greatest) = (best(heads, Record::min), best(tails, Record::max));
        for axis in 0..N {
            // No two are the same: each names its axis.
            next[axis] += usize::from(heads[axis] == least);
            last[axis] -= usize::from(tails[axis] == greatest);
        }
        to.edge(Edge::from_record(least));
        late.push(greatest);
    }
    if edges % 2 == 1 {
        to.edge(Edge::from_record(best(std::array::from_fn::<_, N, _>(|axis| axes[axis][next[axis]]), Record::min)));
    }
    late.iter().rev().for_each(|record| to.edge(Edge::from_record(*record)));
}

/// The least or the greatest, in as few steps one after the other as there can be.
#[inline(always)]
fn best<const N: usize>(mut records: [Record; N], better: impl Fn(Record, Record) -> Record) -> Record {
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

//! What happens on the pins, and six streams of it as one.

use carrystep_spec::AXES;

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

/// Hands over the edges of all axes in order; each axis' are in order already.
///
/// Without a branch or a look at memory that depends on who is first: that cannot be predicted.
pub(super) fn merge(axes: &mut [Vec<Record>; AXES], to: &mut impl Edges) {
    let edges: usize = axes.iter().map(Vec::len).sum();
    axes.iter_mut().for_each(|axis| axis.push(Record::MAX));
    let [a, b, c, d, e, f] = axes.each_ref().map(Vec::as_slice);
    let mut next = [0; AXES];
    for _ in 0..edges {
        let heads = [a[next[0]], b[next[1]], c[next[2]], d[next[3]], e[next[4]], f[next[5]]];
        let least = heads[0].min(heads[1]).min(heads[2].min(heads[3])).min(heads[4].min(heads[5]));
        for (next, head) in next.iter_mut().zip(heads) {
            // No two are the same: each names its axis.
            *next += usize::from(head == least);
        }
        to.edge(Edge::from_record(least));
    }
}

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
pub(super) fn merge(axes: &[Vec<Record>; AXES], to: &mut impl Edges) {
    let mut next = [0; AXES];
    let head = |axis: usize, next: usize| axes[axis].get(next).copied().unwrap_or(Record::MAX);
    let mut heads: [Record; AXES] = std::array::from_fn(|axis| head(axis, 0));
    for _ in 0..axes.iter().map(Vec::len).sum() {
        let least = heads.iter().fold(Record::MAX, |least, &head| least.min(head));
        let edge = Edge::from_record(least);
        let axis = usize::from(edge.axis);
        next[axis] += 1;
        heads[axis] = head(axis, next[axis]);
        to.edge(edge);
    }
}

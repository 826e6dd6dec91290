//! The output: one row after the other.

use carrystep_core::Segment;

/// The segments of all axes for the same ticks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// Length in ticks, the same for each axis.
    pub ticks: u32,
    /// One segment for each axis, in the order of the machine file.
    pub segments: Vec<Segment>,
    /// The source line of the element that the path has reached at the end of the row.
    pub line: u64,
    /// The marks ([`Item::Mark`]) that the path has reached at the start of the row.
    pub marks: Vec<u64>,
}

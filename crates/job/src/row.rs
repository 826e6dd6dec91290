//! The output: one row after the other.

use carrystep_core::Segment;

/// The segments of all axes for the same ticks.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Length in ticks, the same for each axis.
    pub ticks: u32,
    /// One segment for each axis, in the order of the machine file.
    pub segments: Vec<Segment>,
    /// The source line of the element that the path has reached at the end of the row.
    pub line: u64,
    /// The number ([`Element::block`](crate::Element::block)) of that element.
    pub block: u64,
    /// The lowest feed of the elements that the path passes in the row, mm/s (degrees/s where only
    /// rotary letters move); infinite in rapid moves and at rest.
    pub feed: f64,
    /// The greatest distance of the planned curve from the path in the row, as a part of the
    /// tolerance, from 0 to 1. It is measured at four places of the row.
    pub off: f64,
    /// How sharp the corner is that the curve rounds, as a part of the tolerance: the height of an
    /// arc with the curvature of the planned curve over a chord as long as the row's shortest
    /// element, less the height of the element's own arc. Above 1 the curve rounds a corner; far
    /// below 1 it follows a path that is itself bent, as chords of a large circle are.
    pub corner: f64,
    /// The marks ([`Item::Mark`](crate::Item::Mark)) that the path has reached at the start of the
    /// row, and those ([`Item::NearMark`](crate::Item::NearMark)) that are nearest to it there.
    pub marks: Vec<u64>,
    /// Whether the motion rests where the row ends.
    pub rests: bool,
}

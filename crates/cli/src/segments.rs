//! Segments in documents and in tables.

use carrystep_core::Segment;
use schemars::JsonSchema;
use serde::{Serialize, Serializer};
use std::fmt::Write as _;

/// Numbers of 64 bits are strings, because many JSON readers keep only 53 bits.
#[derive(JsonSchema, Serialize)]
pub struct SegmentJson {
    ticks: u32,
    v: String,
    a: String,
    j: String,
    last: bool,
}

/// Writes the segments one after another. All of them as text would need several times the memory
/// of the plan.
pub fn segments<S: Serializer>(segments: &[Segment], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(segments.iter().map(|s| SegmentJson {
        ticks: s.ticks,
        v: s.v.to_string(),
        a: s.a.to_string(),
        j: s.j.to_string(),
        last: s.last,
    }))
}

/// Adds the line of a segment.
pub fn add_segment(text: &mut String, name: &str, segment: &Segment) {
    let Segment { ticks, v, a, j, last } = segment;
    let mark = if *last { "  last" } else { "" };
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{name:<4}  {ticks:>7} ticks  V {v:>19}  A {a:>19}  J {j}{mark}");
}

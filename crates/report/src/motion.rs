//! The input: a row of a plan.

use carrystep_core::Segment;

/// A row of segments and what the planner knows of it.
#[derive(Debug, Clone, Copy)]
pub struct Motion<'a> {
    /// Length in ticks.
    pub ticks: u32,
    /// A segment for each axis, all of this length.
    pub segments: &'a [Segment],
    /// The line of the program that the path has reached at the end of the row, or the number of
    /// the move.
    pub line: u64,
    /// The feed in force, units/s; infinite if there is none.
    pub feed: f64,
    /// Whether the move file gives the time of the move.
    pub given: bool,
    /// The greatest distance from the programmed path, as a part of the tolerance; 0 for moves.
    pub off: f64,
    /// Sharpness of the corner that the row rounds, see `corner` of the planner's rows; 0 for moves.
    pub corner: f64,
}

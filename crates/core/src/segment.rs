//! What the host hands to the gateware: segments, and the commands that carry them.

use alloc::vec::Vec;

/// A stretch of whole ticks over which one axis follows a cubic.
///
/// When it starts, V, A and J are loaded and P carries on. After n ticks the axis has moved by
/// `n V + n(n-1)/2 A + n(n-1)(n-2)/6 J` units of 2^-64 step, exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Segment {
    /// Length in ticks, at least 1.
    pub ticks: u32,
    /// Speed in 2^-64 step per tick, always above -2^63.
    pub v: i64,
    /// Acceleration in 2^-64 step per tick^2.
    pub a: i64,
    /// Jerk in 2^-64 step per tick^3.
    pub j: i64,
    /// The axis stops (V = A = J = 0) when this segment is over.
    pub last: bool,
}

/// One thing that a host does, in order (docs/clock-by-clock.md, "host").
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Command {
    /// Offer a segment to an axis until it is taken.
    Segment {
        /// Axis number, from 0.
        axis: u8,
        /// The segment.
        segment: Segment,
    },
    /// Start the axes of this mask (bit i is axis i) on one tick.
    Start {
        /// Bit i starts axis i.
        mask: u8,
    },
    /// Offer nothing for this many clocks, at least 1.
    Wait {
        /// Clock cycles.
        clocks: u32,
    },
    /// Resume after a fault.
    Clear,
}

/// Everything a host sends for one or more moves, in order.
pub type Program = Vec<Command>;

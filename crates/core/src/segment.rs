//! What the host sends to the gateware: segments, and the commands that carry them.

use crate::output_change::OutputChange;
#[cfg(feature = "alloc")]
use alloc::vec::Vec;

/// A run of whole ticks during which one axis follows a cubic.
///
/// When the segment starts, the axis loads V, A and J and keeps its position P. After n ticks the
/// axis has moved by exactly `n V + n(n-1)/2 A + n(n-1)(n-2)/6 J` units of 2^-64 step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Segment {
    /// Length in ticks, at least 1. The engine receives `ticks` - 1 in word 0 of the segment.
    pub ticks: u32,
    /// Speed in 2^-64 step per tick, always greater than -2^63.
    pub v: i64,
    /// Acceleration in 2^-64 step per tick^2.
    pub a: i64,
    /// Jerk in 2^-64 step per tick^3.
    pub j: i64,
    /// Whether the axis stops (V = A = J = 0) at the end of this segment. A segment that follows in
    /// the queue then waits for the next [`Command::Start`] of the axis. A segment that is not the
    /// last needs a successor in the queue at its end; without one there is an underrun.
    pub last: bool,
}

/// One action of a host; a [`Program`] lists them in order (docs/clock-by-clock.md, "host").
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Command {
    /// Offer a segment to an axis until the gateware accepts it.
    Segment {
        /// Axis number, from 0.
        axis: u8,
        /// The segment.
        segment: Segment,
    },
    /// Change outputs where the next segment of axis 0 begins. Several of these before one segment
    /// have the effect of one after the other. The parallel core has no outputs and ignores it.
    Outputs(OutputChange),
    /// Start the axes of this mask on the same tick.
    Start {
        /// Bit i starts axis i.
        mask: u8,
    },
    /// Offer nothing for this number of clocks.
    Wait {
        /// Clock cycles, at least 1.
        clocks: u32,
    },
    /// Resume after a fault (the `clear` input).
    Clear,
}

/// Everything a host sends for one or more moves, in order.
#[cfg(feature = "alloc")]
pub type Program = Vec<Command>;

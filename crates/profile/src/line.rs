//! A move in which all axes keep to one straight line.

/// What the pulses of such a move can be measured against: not when, only where the axes are together.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Pulses that each axis has made before the move.
    pub before: Vec<u64>,
    /// Steps of each axis in the move, either sign.
    pub steps: Vec<i64>,
    /// Greatest part of the line that is travelled in a second.
    pub speed: f64,
}

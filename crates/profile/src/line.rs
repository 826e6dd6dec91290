//! The description of a move in which all axes keep to one straight line.

/// The line against which the checker measures the pulses of such a move. It compares the positions
/// of the axes with each other, not with the time.
#[derive(Debug, Clone, PartialEq)]
pub struct StraightLine {
    /// Pulses that each axis has made before the move.
    pub before: Vec<u64>,
    /// Steps of each axis in the move; negative is backward.
    pub steps: Vec<i64>,
    /// Greatest speed along the line, as the fraction of the line that is travelled in a second.
    pub speed: f64,
}

//! The description of a move that the check of straight lines needs.

/// The steps of all axes in one move, and the straight line along which they travel. The checker
/// compares the positions of the axes with each other, not with the time.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// Steps of each axis in the move; negative is backward.
    pub steps: Vec<i64>,
    /// The greatest speed along the line, as the fraction of the line that is travelled in a
    /// second; `None` if the axes of this move are independent.
    pub line_speed: Option<f64>,
}

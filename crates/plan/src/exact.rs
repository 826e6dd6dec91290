//! Exact integer arithmetic of segments, for planners of other motion: limits in the gateware's
//! units, distances, and the extremes of the speed.

pub use crate::check::speeds;
pub use crate::edges::travel;
pub use crate::limits::ExactLimits;
pub use crate::units::nearest;

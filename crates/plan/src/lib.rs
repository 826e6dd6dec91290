//! Moves to integer segments that land exactly.
//!
//! A float profile says where each axis should be; [`plan`] turns it into segments whose sums are exact:
//! floats decide how the distance of a move is spread over its ticks, never how long it is.

mod bend;
mod bounds;
mod check;
mod corridor;
mod demand;
mod direction;
mod edges;
mod error;
mod exchange;
mod fit;
mod landing;
mod limits;
mod line;
mod longest;
mod peaks;
mod placed;
mod plan;
mod planner;
mod run;
mod share;
mod slow;
mod units;

pub use error::{Broken, PlanError};
pub use peaks::Peaks;
pub use plan::{Plan, PlannedAxis, PlannedMove};
pub use planner::plan;

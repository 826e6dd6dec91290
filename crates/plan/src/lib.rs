//! Plans moves: turns each move of a file into integer segments that land exactly.
//!
//! A float profile gives the position of each axis over time. [`plan`] turns it into segments whose
//! distances add up exactly to the commanded steps. Floats only decide how the distance of a move
//! is spread over its ticks, never how long the distance is.
//!
//! The public items are the entrances [`plan`], for a file that is held in memory, and [`Survey`],
//! for one of any length, with their results and errors, and [`exact`], the integer arithmetic that
//! other planners share; the other modules are private and may change.

mod asked;
mod bend;
mod beside;
mod bounds;
mod check;
mod corridor;
mod cubic;
mod demand;
mod direction;
mod edges;
mod error;
mod exchange;
mod fine;
mod fit;
mod fitted;
mod kept;
mod landing;
mod limits;
mod line;
mod longest;
mod own;
mod peaks;
mod placed;
mod plan;
mod planner;
mod registers;
mod run;
mod sampled;
mod scaled;
mod search;
mod share;
mod slow;
mod stream;
mod totals;
mod units;

pub mod exact;
pub use error::{Broken, PlanError};
pub use peaks::Peaks;
pub use plan::{Plan, PlannedAxis, PlannedMove};
pub use planner::plan;
pub use stream::{Pass, Survey};
pub use totals::{AxisTotals, Totals};

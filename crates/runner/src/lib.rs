//! Planned programs as a board runs them.
//!
//! ```text
//! lines of a sender -> growing: rows from rest to rest, of what has come so far
//! rows of the planner -> stretches: what the link sends between two places at which the machine
//!                        ^          rests and somebody must let it go on (M0, M1, M6, a hold)
//!        hold, overrides -'
//! ```
//!
//! The crate knows rows, and what a board's queues hold; it knows no line and no terminal.

mod blocks;
mod first_ways;
mod growing;
mod held;
mod horizon;
mod override_setting;
mod reading;
mod settling;
mod spindle;
mod stretches;
mod time_left;

pub use blocks::BlockAt;
pub use growing::{BatchEnd, Growing, GrowingRows, LINES, MotionGuard};
pub use horizon::Horizon;
pub use override_setting::OverrideSetting;
pub use settling::settling;
pub use stretches::{Stretches, Wait, kept_ticks};
pub use time_left::{MotionPace, TimeLeft};

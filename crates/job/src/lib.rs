//! Plans jobs: from a programmed path to integer segments of all axes with common ticks, which land
//! exactly.
//!
//! The input is a path of lines, arcs and helices in machine coordinates, with feeds and
//! tolerances ([`Item`]). The output is one row after the other ([`Row`]): for each axis a cubic
//! segment, all of the same length. The path is smoothed within its tolerance across moves, and
//! the motion is the fastest along the smoothed path within feed, speed and acceleration; a filter
//! in time keeps the jerk limit. `docs/jobs.md` explains the stages in their order:
//!
//! | stage | file | from | to |
//! |---|---|---|---|
//! | first law | `rough.rs` | pieces of the path | knots on it, one each 4 ms |
//! | smoothing | `smooth.rs` | knots | control points of a curve within the tolerance |
//! | speed law | `speed.rs`, `retime.rs` | curve | its samples at the greatest speed: the knots of the next smoothing |
//! | last speed law | `settle.rs` | curve | control points over time, known to keep limits and tolerance |
//! | integers | `weave.rs` | control points over time | segments that land exactly, checked |
//!
//! Memory does not grow with the length of a job: each stage holds a window as long as the machine
//! needs to stop.

mod attempt;
mod banded;
mod confined;
mod cover;
mod element;
mod emitted;
mod error;
mod filter;
mod halt;
mod hold;
mod inspect;
mod job;
mod keep;
mod limits;
mod marks;
mod pace;
mod path;
mod piece;
mod planner;
mod refuse;
mod retime;
mod rhythm;
mod rough;
mod row;
mod run;
mod settle;
mod smooth;
mod speed;
mod spline;
mod targets;
mod turn;
mod vector;
mod weave;

pub use element::{Arc, Element, Item, Tolerance};
pub use error::{JobError, Rule};
pub use hold::{Curve, CurvePlace, Held, Hold};
pub use pace::{Overrides, Pace, PacePlace, Paced, Track};
pub use planner::{Planner, rows};
pub use rhythm::check_line;
pub use row::Row;

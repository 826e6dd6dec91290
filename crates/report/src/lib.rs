//! What a plan does with its time, and the page that shows it.
//!
//! A [`Recorder`] takes the segments of all axes, row by row, as the planner makes them. It decides
//! for each row what binds the motion there ([`Bound`]), and adds up the time of each cause and of
//! each line. If a page is wanted, it also keeps the drawing: the path, and the speed, acceleration
//! and jerk of each axis. Its memory is bounded for a job of any length.
//!
//! ```text
//! segments -> split: common ticks -> frame: speeds, places -> bound: what binds
//!                                        |
//!                      stops: ramps to and from a rest, known afterwards
//!                                        |-> time_use: seconds of each cause and line  (--json)
//!                                        |-> charts: least and greatest values over time
//!                                        '-> trace: the path
//! ```
//!
//! [`write_page`] puts the drawing and the document that `--json` prints into one HTML file. The
//! page computes no figure of its own.

mod axis;
mod bound;
mod charts;
mod drawing;
mod frame;
mod lines;
mod motion;
mod page;
mod recorder;
mod split;
mod stops;
mod time_use;
mod trace;

pub use axis::AxisSetup;
pub use bound::Bound;
pub use drawing::Drawing;
pub use motion::Motion;
pub use page::{PageError, write_page};
pub use recorder::{Detail, Recorder};
pub use split::common_rows;
pub use time_use::{LinesOf, TimeOf, TimeUse};

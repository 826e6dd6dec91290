//! G-code programs on a machine.
//!
//! A [`ProgramFile`] is a program, its machine, and how it is to be run. It is read as often as
//! anybody needs it, always from its beginning and in constant memory:
//!
//! ```text
//! file -> gcode: canonical moves -> events: moves with tolerances, rests, outputs, switches
//!                                    |-> rows   the planner's segments -> survey: figures, limits
//!                                    |-> legs   the programmed path in straight legs, for the checker
//!                                    '-> marks  the legs between which outputs change, for it
//! line of a sender -> lines: the same events as the planner's items, line by line
//! ```
//!
//! An [`Entry`] takes the place of the blocks before the one with which a program begins; [`Blocks`]
//! lists them.
//!
//! Legs and marks come from the canonical moves and not from the planner, so that the checker
//! judges the pins by the program alone.

mod blocks;
mod counts;
mod enter;
mod entry;
mod error;
mod event;
mod events;
mod file;
mod items;
mod laser;
mod legs;
mod letter;
mod letters;
mod lines;
mod marks;
mod outputs;
mod pause;
mod row_outputs;
mod rows;
mod survey;
mod switch;
mod sync;
mod translate;

pub use blocks::{Blocks, TimedBlock};
pub use carrystep_gcode::{
    AXIS_LETTERS, Input, Modes, Offsets, PathMode, Plane, Point, Turn, Until,
};
pub use carrystep_job::Row;
pub use counts::Counts;
pub use entry::{DEFAULT_SPINDLE_DWELL, ENTRY_FEED, Entry, FromBlock};
pub use error::{Fault, ProgramError};
pub use event::{Event, ProgrammedMove, Reading};
pub use events::Events;
pub use file::{Found, ProgramFile, Resumed, Settings, is_program};
pub use laser::LaserPower;
pub use legs::Legs;
pub use letter::unit;
pub use letters::Letters;
pub use lines::{LineBreak, LineFault, Lines, PlannedLine, ProbeLine};
pub use marks::Marks;
pub use pause::{Stop, stop_at};
pub use row_outputs::RowOutputs;
pub use rows::Rows;
pub use survey::{AxisSurvey, Survey, SurveyedRows};
pub use switch::{Switch, SwitchCount};
pub use sync::{SyncPoint, sync_points};
pub use translate::DEFAULT_TOLERANCE;

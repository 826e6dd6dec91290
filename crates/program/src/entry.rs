//! The entry of a program in its middle: what takes the place of the blocks before the one with
//! which it begins.
//!
//! ```text
//!  z    .----- X, Y and rotary axes at rapid -----.      height: the highest z so far, or --safe-z
//!       |                                         |      spindle and coolant on, dwell
//!       up at rapid                               down at feed
//!       |                                         |      other outputs
//!   the machine                                   the place where the block begins
//! ```
//!
//! The blocks before are executed without motion. Where the program goes may depend on where it
//! began: with G91 or G92, or as long as an axis has not moved. This is found by executing these
//! blocks a second time from another place.

use crate::switch::SwitchCount;
use carrystep_core::OutputChange;
use carrystep_gcode::{AXES, ExecutedBlock, Modes, Point};

/// The dwell behind the start of the spindle if the program has none, s.
pub const DEFAULT_SPINDLE_DWELL: f64 = 3.0;

/// The feed of the way down if no F is in force, mm/s: 120 mm/min.
pub const ENTRY_FEED: f64 = 2.0;

/// Where a program begins instead of its first block.
#[derive(Debug, Clone, PartialEq)]
pub struct FromBlock {
    /// The executed block, from 1.
    pub block: u64,
    /// The machine place where the program began, as far as it is known, mm and degrees.
    pub began_at: [Option<f64>; AXES],
    /// The machine height for the way of X and Y, mm, instead of the highest so far.
    pub safe_z: Option<f64>,
    /// The dwell behind the start of the spindle, s, instead of the program's.
    pub spindle_dwell: Option<f64>,
}

/// How a program is entered.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The block with which the program goes on.
    pub block: ExecutedBlock,
    /// The machine place where it begins, mm and degrees.
    pub place: Point,
    /// The modes in which it begins.
    pub modes: Modes,
    /// The machine height of the way of X and Y, mm; `None` if the machine has no axis z.
    pub height: Option<f64>,
    /// The feed of the way down, mm/s.
    pub feed: f64,
    /// The dwell behind the start of spindle and coolant, s.
    pub dwell: f64,
    /// Outputs of `M62` to `M68` as the blocks before leave them.
    pub outputs: OutputChange,
    /// What the blocks before have asked for and the entry does not: probes and inputs, of which
    /// the result is assumed, pauses and tool changes.
    pub passed: Vec<SwitchCount>,
    /// The machine place at which the program is taken to have begun.
    pub(crate) program_start: Point,
    /// The axes of which it is not known where they began. They have not moved.
    pub(crate) unknown: [bool; AXES],
}

impl Entry {
    /// The machine place at which the program is taken to have begun, mm and degrees.
    pub const fn program_start(&self) -> Point {
        self.program_start
    }
}

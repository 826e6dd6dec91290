//! How a program is read: where the machine is, what it has kept, and when a loop has no end.

use crate::canon::Point;
use crate::kept::Offsets;
use crate::tools::ToolTable;

/// Lines that loops and subroutines may run by default.
pub const DEFAULT_BLOCKS: u64 = 10_000_000;

/// How a program is read.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Machine place at the beginning: x, y, z in mm, a, b, c in degrees.
    pub start: Point,
    /// Whether lines that begin with `/` are left out.
    pub block_delete: bool,
    /// How many lines may run again, in loops and subroutines, before the program is taken for one
    /// that does not end. Each stage of a drilling cycle counts as a line.
    pub blocks: u64,
    /// Offsets that the machine has kept. [`Options::parameters`] come behind them.
    pub offsets: Offsets,
    /// Values of numbered parameters at the beginning, such as offsets that the machine has kept
    /// (`#5221` is X of G54, in mm). Numbers without a parameter are ignored.
    pub parameters: Vec<(u16, f64)>,
    /// The tools of the machine. Without a table, T takes any number, and G43 is refused.
    pub tools: Option<ToolTable>,
}

impl Default for Options {
    /// Machine zero, lines with `/` are left out, [`DEFAULT_BLOCKS`], no offsets, no tool
    /// table.
    fn default() -> Self {
        Self {
            start: Point::default(),
            block_delete: true,
            blocks: DEFAULT_BLOCKS,
            offsets: Offsets::default(),
            parameters: Vec::new(),
            tools: None,
        }
    }
}

//! The executed blocks of a program with the times at which their motion begins.
//!
//! The program is read twice side by side, and neither reading is kept: once block by block, once
//! row by row as it is planned.

use crate::error::ProgramError;
use crate::file::ProgramFile;
use crate::rows::Rows;
use carrystep_gcode::{ExecutedBlock, Interpreter, Options, Point};
use std::fs::File;

/// An executed block, and when its motion begins.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedBlock {
    /// The block.
    pub block: ExecutedBlock,
    /// The time at which its motion begins, s, to the row of at most 16 ms; `None` if it has none.
    pub begins_s: Option<f64>,
    /// The machine place where it begins, mm and degrees.
    pub at: Point,
}

/// The blocks of a program, from its first one.
#[derive(Debug)]
pub struct Blocks {
    steps: Interpreter<File>,
    rows: Rows,
    file: ProgramFile,
    /// Seconds of a tick, and ticks of the rows before the last one that was read.
    tick_seconds: f64,
    ticks: u64,
    /// Length of the last row that was read, and the block that it reaches.
    row: Option<(u32, u64)>,
    over: bool,
}

impl Blocks {
    /// Reads and plans a program from its beginning.
    ///
    /// # Errors
    /// As [`Rows::new`].
    pub fn new(file: &ProgramFile) -> Result<Self, ProgramError> {
        let settings = file.settings();
        let options =
            Options { start: settings.start, blocks: settings.blocks, ..Options::default() };
        let steps = Interpreter::open(file.path(), &options)
            .map_err(|error| ProgramError::of_gcode(file.path(), error))?;
        Ok(Self {
            steps,
            rows: Rows::new(file)?,
            file: file.clone(),
            tick_seconds: file.machine().timebase.tick_seconds(),
            ticks: 0,
            row: None,
            over: false,
        })
    }

    /// Plans on to the row that reaches this block, and returns its beginning, s.
    fn begins(&mut self, block: u64) -> Result<f64, ProgramError> {
        while self.row.is_none_or(|(_, reached)| reached < block) {
            let Some(row) = self.rows.next().transpose()? else { break };
            self.ticks += self.row.map_or(0, |(ticks, _)| u64::from(ticks));
            self.row = Some((row.ticks, row.block));
        }
        Ok(self.ticks as f64 * self.tick_seconds)
    }

    fn block(&mut self) -> Option<Result<TimedBlock, ProgramError>> {
        let at = self.steps.place();
        let block = match self.steps.next_block()? {
            Ok(block) => block,
            Err(error) => return Some(Err(ProgramError::of_gcode(self.file.path(), error))),
        };
        let begins_s = match block.moves.then(|| self.begins(block.number)).transpose() {
            Ok(begins_s) => begins_s,
            Err(error) => return Some(Err(error)),
        };
        Some(Ok(TimedBlock { block, begins_s, at }))
    }
}

impl Iterator for Blocks {
    type Item = Result<TimedBlock, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        let block = if self.over { None } else { self.block() };
        self.over |= !matches!(block, Some(Ok(_)));
        block
    }
}

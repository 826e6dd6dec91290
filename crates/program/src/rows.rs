//! The planned segments of a program, row by row.

use crate::counts::Counts;
use crate::error::{Fault, ProgramError};
use crate::event::Event;
use crate::events::Events;
use crate::file::ProgramFile;
use crate::items::Items;
use crate::switch::Switch;
use carrystep_files::Machine;
use carrystep_gcode::{Offsets, Point};
use carrystep_job::{JobError, Planner, Row};
use std::path::PathBuf;

/// The rows of a program. After an error there are no more. A program without any row is an error,
/// because nothing would be tried.
#[derive(Debug)]
pub struct Rows {
    events: Events,
    planner: Planner,
    counts: Counts,
    items: Items,
    /// Number of places to wait at that are still to be passed before anything is planned.
    skips: u64,
    state: State,
    /// Whether no row has been given yet.
    is_empty: bool,
    path: PathBuf,
    machine: Machine,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// The program has more events.
    Reads,
    /// The planner has all events.
    Finishes,
    /// The last row has been given, or an error.
    Over,
}

impl Rows {
    /// Plans a program from its beginning.
    ///
    /// # Errors
    /// As [`Events::new`]; the planner refuses the machine.
    pub fn new(file: &ProgramFile) -> Result<Self, ProgramError> {
        let (machine, letters) = (file.machine().clone(), file.letters().clone());
        let start = letters.coordinates(file.begins());
        let skips = file.settings().resumed.last().map_or(0, |resumed| resumed.number);
        let planner = Planner::new(&machine, letters.linear(), &start)
            .map_err(|error| ProgramError::of_planner(file.path(), &machine, error))?;
        Ok(Self {
            events: Events::new(file)?,
            planner,
            counts: Counts::default(),
            items: Items::new(letters, *file.begins()),
            skips,
            state: State::Reads,
            // Behind a place where it was resumed, nothing may be left.
            is_empty: skips == 0,
            path: file.path().to_owned(),
            machine,
        })
    }

    /// Figures of what has been read so far: after the last row, of the program.
    pub fn counts(&self) -> &Counts {
        &self.counts
    }

    /// Whether all lines so far were of the program itself, and not of files beside it.
    pub fn one_file(&self) -> bool {
        self.events.one_file()
    }

    /// The offsets that the machine keeps, behind what has been read.
    pub fn offsets(&self) -> Offsets {
        self.events.offsets()
    }

    /// The place where the last move that was read ends, exactly as programmed.
    pub fn end(&self) -> &Point {
        &self.items.end
    }

    fn row(&mut self) -> Result<Option<Row>, ProgramError> {
        loop {
            let row = self.planner.next_row().map_err(|error| self.refused(error))?;
            if row.is_some() || self.state != State::Reads {
                return Ok(row);
            }
            let Some(event) = self.events.next().transpose()? else {
                self.state = State::Finishes;
                self.planner.finish().map_err(|error| self.refused(error))?;
                continue;
            };
            self.counts.add(&event);
            if self.skips > 0 {
                self.skips -= u64::from(is_wait(&event));
                continue;
            }
            for item in self.items.items(&event) {
                self.planner.push(&item).map_err(|error| self.refused(error))?;
            }
        }
    }

    fn refused(&self, error: JobError) -> ProgramError {
        ProgramError::of_planner(&self.path, &self.machine, error)
    }
}

/// Whether whoever runs the program waits or reads something there, so that the place has a number.
pub(crate) const fn is_wait(event: &Event) -> bool {
    matches!(
        event,
        Event::Switch { switch: Switch::Pause | Switch::ToolChange, .. } | Event::Reading { .. }
    )
}

impl Iterator for Rows {
    type Item = Result<Row, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.state == State::Over {
            return None;
        }
        let row = match self.row() {
            Ok(None) if self.is_empty => Err(ProgramError::new(&self.path, 0, Fault::Nothing)),
            row => row,
        };
        self.is_empty = false;
        if !matches!(row, Ok(Some(_))) {
            self.state = State::Over;
        }
        row.transpose()
    }
}

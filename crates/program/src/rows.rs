//! The planned segments of a program, row by row.

use crate::counts::Counts;
use crate::error::{Fault, ProgramError};
use crate::event::{Event, ProgrammedMove, Reading};
use crate::events::Events;
use crate::file::ProgramFile;
use crate::letters::Letters;
use crate::switch::Switch;
use crate::sync::SyncPoint;
use carrystep_files::Machine;
use carrystep_gcode::{Offsets, Point};
use carrystep_job::{Arc, Cartesian, Element, Item, JobError, Planner, Row};
use std::path::PathBuf;

/// Time in s for which the tool rests where outputs change before a wait, so that a row has the
/// change.
pub(crate) const SWITCHING: f64 = 0.004;

/// The rows of a program. After an error there are no more. A program without any row is an error,
/// because nothing would be tried.
#[derive(Debug)]
pub struct Rows {
    events: Events,
    planner: Planner,
    counts: Counts,
    /// The place where the last move that was read ends.
    end: Point,
    /// The places to wait at since the last motion, change of outputs or dwell.
    waits: Vec<SyncPoint>,
    /// Whether outputs have changed since then, so that no row has the change yet.
    is_marked: bool,
    /// Number of places to wait at that are still to be passed before anything is planned.
    skips: u64,
    state: State,
    /// Whether no row has been given yet.
    is_empty: bool,
    path: PathBuf,
    machine: Machine,
    letters: Letters,
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
        let planner = Planner::new(&machine, &Cartesian, letters.linear(), &start)
            .map_err(|error| ProgramError::of_planner(file.path(), &machine, error))?;
        Ok(Self {
            events: Events::new(file)?,
            planner,
            counts: Counts::default(),
            end: *file.begins(),
            waits: Vec::new(),
            is_marked: false,
            skips,
            state: State::Reads,
            // Behind a place where it was resumed, nothing may be left.
            is_empty: skips == 0,
            path: file.path().to_owned(),
            machine,
            letters,
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
        &self.end
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
            for item in self.items(&event) {
                self.planner.push(&item).map_err(|error| self.refused(error))?;
            }
        }
    }

    fn refused(&self, error: JobError) -> ProgramError {
        ProgramError::of_planner(&self.path, &self.machine, error)
    }

    /// What the planner is given for an event. A place to wait at is only marked when something
    /// follows it.
    fn items(&mut self, event: &Event) -> Vec<Item> {
        let rest = |dwell: f64, line: u64| Item::Rest { dwell, line };
        let (first, then) = match *event {
            Event::Move(ref one) => {
                self.end = one.to;
                self.is_marked &= one.length() == 0.0;
                (None, Some(Item::Move(self.element(one))))
            }
            Event::Rest { seconds, line } if seconds > 0.0 => {
                self.is_marked = false;
                (None, Some(rest(seconds, line)))
            }
            Event::Rest { line, .. } => (Some(rest(0.0, line)), None),
            Event::Outputs { change, with_motion, line } => {
                let mark = Item::Mark(change.word().into());
                self.is_marked = true;
                (Some(rest(0.0, line)).filter(|_| !with_motion), Some(mark))
            }
            Event::Laser { power, .. } => (None, Some(Item::NearMark(power.mark()))),
            Event::Switch { switch, line } => {
                self.waits.extend(SyncPoint::of(switch, line));
                // What was switched before a wait is switched when the wait begins: the spindle
                // does not turn in a tool change.
                let stops = SyncPoint::of(switch, line).is_some();
                let dwell = if stops && self.is_marked { SWITCHING } else { 0.0 };
                self.is_marked &= dwell == 0.0;
                (Some(rest(dwell, line)), None)
            }
            Event::Reading { reading: Reading::Probe { .. }, line } => {
                // The probe move ends here, so that what follows is a stretch of its own.
                self.waits.push(SyncPoint { switch: Switch::Probe, line });
                (Some(rest(0.0, line)), None)
            }
            Event::Reading { reading: Reading::Input { .. }, .. } => (None, None),
            Event::End { line } => {
                // Something may follow an input that is not what the plan assumes.
                let reads = self.waits.iter().any(|wait| wait.switch == Switch::Input);
                (None, reads.then(|| rest(SWITCHING, line)))
            }
        };
        let mut items: Vec<Item> = first.into_iter().collect();
        if let Some(then) = then {
            items.extend(self.waits.drain(..).map(|point| Item::Mark(point.mark())));
            items.push(then);
        }
        items
    }

    fn element(&self, one: &ProgrammedMove) -> Element {
        let arc = one.arc.and_then(|arc| {
            let [first, second, _] = arc.plane.axes();
            let plane = [self.letters.axis(first)?, self.letters.axis(second)?];
            Some(Arc { plane, centre: arc.centre, angle: arc.sweep })
        });
        let to = self.letters.coordinates(&one.to);
        Element {
            to,
            arc,
            feed: one.feed,
            tolerance: one.tolerance,
            line: one.line,
            block: one.block,
        }
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

//! The public planner: items of a path in, rows of segments out.
//!
//! [`Planner::push`] only stores an item. [`Planner::next_row`] works as far as the next row needs,
//! so that no item, however long it takes, makes memory grow.

use crate::element::{Element, Item};
use crate::error::JobError;
use crate::job::{Job, Jobs};
use crate::rhythm::check_line;
use crate::row::Row;
use carrystep_files::Machine;

/// Plans a job while it is read. Memory does not grow with its length.
#[derive(Debug)]
pub struct Planner {
    job: Box<dyn Jobs>,
    /// For each motor, the number of its letter's segment in the rows of the job.
    letters: Vec<usize>,
    /// For each letter, its first motor.
    leaders: Vec<usize>,
    ended: bool,
}

impl Planner {
    /// A planner for a machine whose letters are at these places, mm or degrees. Letters are in the
    /// order of their first motors. The first `linear` letters (at most three) are linear, the others
    /// rotary. The start is rounded to whole steps. All motors of a letter get the same segments.
    ///
    /// # Errors
    /// [`JobError::Axes`], [`JobError::SlowLine`], [`JobError::Coordinates`] and
    /// [`JobError::Number`], all with line 0.
    pub fn new(machine: &Machine, linear: usize, start: &[f64]) -> Result<Self, JobError> {
        Self::with_room(machine, linear, start, 0)
    }

    /// As [`Planner::new`], with room for at least so many letters. It is public for the test that the
    /// room changes no row.
    #[doc(hidden)]
    pub fn with_room(
        machine: &Machine,
        linear: usize,
        start: &[f64],
        room: usize,
    ) -> Result<Self, JobError> {
        let motors = machine.axes.len();
        let (leaders, letters) = (machine.leaders(), machine.letter_numbers());
        // The other motors of a letter have the limits of the first one.
        let mut planned = machine.clone();
        planned.axes = leaders.iter().map(|&motor| machine.axes[motor].clone()).collect();
        check_line(machine)?;
        // What the line has to carry is the segments of all motors.
        let machine = (&planned, motors);
        let job: Box<dyn Jobs> = match room.max(leaders.len()) {
            1..=3 => Box::new(Job::<3>::new(machine, linear, start)?),
            4..=6 => Box::new(Job::<6>::new(machine, linear, start)?),
            other => return Err(JobError::Axes(other)),
        };
        Ok(Self { job, letters, leaders, ended: false })
    }

    /// Stores the next item of the path. Take rows until there is none before the next item, so
    /// that memory stays small.
    ///
    /// # Errors
    /// What is wrong with the item, with its line. [`JobError::Ended`] after [`Planner::finish`].
    pub fn push(&mut self, item: &Item) -> Result<(), JobError> {
        if self.ended {
            return Err(JobError::Ended);
        }
        self.job.push(item)
    }

    /// Checks an element that begins at this place, without storing it: what [`Planner::push`] would
    /// refuse.
    ///
    /// # Errors
    /// What is wrong with the element, with its line.
    pub fn check(&self, from: &[f64], element: &Element) -> Result<(), JobError> {
        self.job.check(from, element)
    }

    /// The path ends at rest. The last row is marked as the last one.
    ///
    /// # Errors
    /// As [`Planner::push`], about the last element.
    pub fn finish(&mut self) -> Result<(), JobError> {
        if self.ended {
            return Err(JobError::Ended);
        }
        self.ended = true;
        self.job.finish()
    }

    /// The next row, or `None` if more items are needed (after [`Planner::finish`]: at the end).
    ///
    /// # Errors
    /// [`JobError::Broken`]. No row comes after an error.
    pub fn next_row(&mut self) -> Result<Option<Row>, JobError> {
        match self.job.next_row() {
            Ok(row) => Ok(row.map(|row| self.of_motors(row))),
            Err(JobError::Broken { line, axis, rule }) => {
                self.ended = true;
                let axis = self.leaders.get(axis).copied().unwrap_or(axis);
                Err(JobError::Broken { line, axis, rule })
            }
            Err(error) => {
                self.ended = true;
                Err(error)
            }
        }
    }

    /// The row with the segments of all motors.
    fn of_motors(&self, row: Row) -> Row {
        let segments = self.letters.iter().map(|&letter| row.segments[letter]).collect();
        Row { segments, ..row }
    }
}

/// Plans all items; stops after the first error.
pub fn rows<I: IntoIterator<Item = Item>>(
    mut planner: Planner,
    items: I,
) -> impl Iterator<Item = Result<Row, JobError>> {
    let mut items = items.into_iter();
    let mut failed = false;
    std::iter::from_fn(move || {
        while !failed {
            let done = planner.ended;
            let step = match planner.next_row() {
                Ok(Some(row)) => return Some(Ok(row)),
                Ok(None) if done => return None,
                Ok(None) => match items.next() {
                    Some(item) => planner.push(&item),
                    None => planner.finish(),
                },
                Err(error) => Err(error),
            };
            if let Err(error) = step {
                failed = true;
                return Some(Err(error));
            }
        }
        None
    })
}

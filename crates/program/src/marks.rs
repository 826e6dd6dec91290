//! Where a program changes outputs, for the checker: between which legs of the path.

use crate::error::ProgramError;
use crate::event::Event;
use crate::events::Events;
use crate::file::ProgramFile;
use crate::legs::chords;
use crate::rows::is_wait;
use carrystep_check::OutputMark;

/// The changes of outputs of a program, in order.
#[derive(Debug)]
pub struct Marks {
    events: Events,
    tick_seconds: f64,
    /// Number of legs so far.
    legs: u64,
    /// The last mark: whether the program dwells behind it is not known yet.
    last: Option<OutputMark>,
}

impl Marks {
    /// Reads a program from its beginning.
    ///
    /// # Errors
    /// As [`Events::new`].
    pub fn new(file: &ProgramFile) -> Result<Self, ProgramError> {
        let tick_seconds = file.machine().timebase.tick_seconds();
        Ok(Self { events: Events::new(file)?, tick_seconds, legs: 0, last: None })
    }
}

impl Iterator for Marks {
    type Item = Result<OutputMark, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.events.next() {
                None => return self.last.take().map(Ok),
                Some(Err(error)) => return Some(Err(error)),
                Some(Ok(Event::Move(one))) if one.length() > 0.0 => {
                    self.legs += chords(&one).0;
                    if let Some(last) = self.last.take() {
                        return Some(Ok(last));
                    }
                }
                Some(Ok(Event::Outputs { change, with_motion, line })) if change.mask != 0 => {
                    let (leg, at_rest) = (self.legs, !with_motion);
                    let mark = OutputMark { leg, change, at_rest, dwells: false, line };
                    if let Some(last) = self.last.replace(mark) {
                        return Some(Ok(last));
                    }
                }
                // A dwell of less than half a tick is none.
                Some(Ok(Event::Rest { seconds, .. })) => {
                    let dwells = (seconds / self.tick_seconds).round() >= 1.0;
                    self.last.iter_mut().for_each(|last| last.dwells |= dwells);
                }
                Some(Ok(event)) if is_wait(&event) => {
                    self.last.iter_mut().for_each(|last| last.dwells = true);
                }
                Some(Ok(_)) => {}
            }
        }
    }
}

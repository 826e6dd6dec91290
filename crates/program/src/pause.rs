//! What a program has come to at a place where it waits or reads something.

use crate::error::ProgramError;
use crate::event::{Event, Reading};
use crate::events::Events;
use crate::file::ProgramFile;
use crate::rows::is_wait;
use carrystep_gcode::{Offsets, Point};

/// A place at which a program stops.
#[derive(Debug, Clone, PartialEq)]
pub struct Stop {
    /// The work offsets that are in force there.
    pub offsets: Offsets,
    /// The machine place, exactly as programmed: x, y, z in mm, then a, b, c in degrees. Of a probe
    /// it is the target.
    pub at: Point,
    /// What is read there, and the line; `None` for a pause and a tool change.
    pub reading: Option<(Reading, u64)>,
}

/// The place of this number at which a program waits or reads something, counted from 1 in the order
/// in which they are executed; the place of a probe is behind its move. The program is read up to
/// there, and not planned. If it stops less often, it is the end of the program.
///
/// # Errors
/// As [`Events`]: the file has changed, or a mistake of the program before the place.
pub fn stop_at(file: &ProgramFile, number: u64) -> Result<Stop, ProgramError> {
    let (mut events, mut passed) = (Events::new(file)?, 0);
    let mut reading = None;
    while passed < number {
        let Some(event) = events.next().transpose()? else { break };
        passed += u64::from(is_wait(&event));
        reading = match event {
            Event::Reading { reading, line } if passed == number => Some((reading, line)),
            _ => None,
        };
    }
    Ok(Stop { offsets: events.offsets(), at: *events.at(), reading })
}

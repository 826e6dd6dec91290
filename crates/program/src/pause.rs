//! What a program has come to at a place where it waits.

use crate::error::ProgramError;
use crate::event::Event;
use crate::events::Events;
use crate::file::ProgramFile;
use crate::sync::SyncPoint;
use carrystep_gcode::Offsets;

/// The work offsets that are in force at the place of this number where a program waits, counted
/// from 1 in the order in which they are executed. The program is read up to there, and not
/// planned. If it waits less often, they are those at its end.
///
/// # Errors
/// As [`Events`]: the file has changed, or a mistake of the program before the place.
pub fn offsets_at(file: &ProgramFile, number: u64) -> Result<Offsets, ProgramError> {
    let (mut events, mut passed) = (Events::new(file)?, 0);
    while passed < number {
        match events.next().transpose()? {
            Some(Event::Switch { switch, line }) if SyncPoint::of(switch, line).is_some() => {
                passed += 1;
            }
            Some(_) => {}
            None => break,
        }
    }
    Ok(events.offsets())
}

//! Where the machine is when senders begin to drive it, and behind homing.

use super::server::Server;
use super::terms;
use crate::drive::Place;
use crate::failure::Failure;
use crate::memory::BoardMemory;
use carrystep_files::Machine;
use carrystep_grbl::{Dialect, Settings};
use carrystep_program::{Letters, Lines, Offsets};
use carrystep_runner::LINES;

/// The place of a board, and whether its machine zero is not known although it could home. Then the
/// place is zero, and nothing bounds it.
///
/// # Errors
/// The machine stands beyond the travel of an axis.
pub fn find(
    machine: &Machine,
    letters: &Letters,
    memory: &BoardMemory,
    positions: &[i32],
) -> Result<(Place, bool), Failure> {
    let homed = |number: usize| machine.axes[number].home.is_none() || memory.is_homed(number);
    let lost = !(0..machine.axes.len()).all(homed);
    Ok((Place::find(machine, letters, memory, positions, lost)?, lost))
}

/// The lines of senders from a place on.
///
/// # Errors
/// Jobs cannot be planned for this machine.
pub fn lines(
    machine: &Machine,
    place: &Place,
    offsets: Offsets,
    tolerance: Option<f64>,
) -> Result<Lines, Failure> {
    Lines::new(&place.bounded(machine), place.start, offsets, tolerance)
        .map_err(|fault| Failure::input(fault.to_string()))
}

impl Server<'_> {
    /// Takes the place of the machine from its memory, behind homing.
    pub fn placed(&mut self) -> Result<(), Failure> {
        let read = self.board.read_status();
        let positions = read.map_err(|error| self.lost(&error))?.positions;
        let letters = self.requests.lines.letters().clone();
        let (place, lost) = find(self.machine, &letters, self.memory, &positions)?;
        let offsets = match (self.requests.keeps, self.memory.work()) {
            (false, Ok(kept)) if !lost => kept.clone(),
            _ => self.requests.lines.interpreter().offsets(),
        };
        self.requests.keeps = !lost;
        let lines = lines(self.machine, &place, offsets, self.tolerance)?;
        let settings = Settings {
            machine: terms::settings(self.machine, &letters, &place.soft),
            ..self.requests.dialect.settings.clone()
        };
        self.requests.dialect = Dialect::new(settings, LINES);
        self.requests.placed(lines, place, &positions);
        // At the end the file is written again.
        let _ = self.memory.drives(self.board);
        Ok(())
    }

    /// Keeps the work offsets if lines have changed them.
    pub fn keeps_offsets(&mut self) {
        let offsets = self.requests.lines.interpreter().offsets();
        if self.requests.keeps && self.memory.work().is_ok_and(|kept| *kept != offsets) {
            self.memory.set_work(offsets);
            // At the end the file is written again.
            let _ = self.memory.drives(self.board);
        }
    }
}

//! What the command remembers of a board from one call to the next: where machine zero is, and the limits that were met.
//!
//! The position register counts from where the board was configured and cannot be written. So the file of a board, named after
//! its port and its build id, holds for each axis the machine coordinate of the register's zero. It holds as long as
//! nobody else has driven the board, and its drivers have kept their power:
//!
//! ```text
//! next        the number of the next write: any command of another host changes it
//! positions   of all axes: any move changes them
//! ready       0 behind every configuration, until a host switches the drivers on: a restart is always seen
//! ```
//!
//! Where one of them is not as it was left, all is forgotten. Only a restart followed by another host that makes a multiple of
//! 256 writes and leaves every register at the very same position would not be noticed.

use crate::connection::{Board, Connection};
use crate::found;
use carrystep_core::engine::{Cause, Guard};
use carrystep_link::Status;
use serde::{Deserialize, Serialize};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

/// The form of the file.
const SCHEMA: u32 = 1;
/// Names the folder, where tests or a user want another one.
const FOLDER: &str = "CARRYSTEP_STATE";

/// The file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Record {
    schema: u32,
    port: String,
    build: String,
    next: u8,
    ready: bool,
    axes: Vec<AxisRecord>,
}

/// One axis in it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct AxisRecord {
    position: i32,
    /// Steps in a unit of the machine file that it was homed with.
    steps_per_unit: f64,
    /// The machine coordinate of the register's zero, steps, where the axis is homed.
    offset: Option<i64>,
    limit: Option<Limit>,
}

/// A limit that an axis has met, and has not moved away from yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Limit {
    /// Which way it moved: 1 or -1.
    pub direction: i8,
    /// Where it came to rest, steps of the register.
    pub at: i32,
    /// How far it must move back until the switch is open, steps.
    pub clear: u32,
}

impl Limit {
    /// How far an axis at this position has to move away still, steps; 0: far enough.
    pub fn to_go(self, position: i32) -> u32 {
        let away = i64::from(self.at.wrapping_sub(position)) * i64::from(self.direction);
        u32::try_from(i64::from(self.clear) - away).unwrap_or(0)
    }
}

/// What is known of a board.
#[derive(Debug)]
pub struct Memory {
    path: Option<PathBuf>,
    record: Record,
}

impl Memory {
    /// What holds of the board of this connection, as it stands now.
    pub fn recall(connection: &Connection) -> Self {
        let Connection { board, axes, steps_per_unit, port, .. } = connection;
        // A port has one name here, whatever link leads to it.
        let port = Path::new(port).canonicalize().map_or_else(|_| port.clone(), |path| path.display().to_string());
        let build = format!("{:016x}", board.facts().build);
        let name: String = port.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        let path = folder().map(|folder| folder.join(format!("{name}-{build}.json")));
        let blank = vec![AxisRecord::default(); axes.len()];
        let Status { answer, positions } = *board.status();
        let mut record = Record { schema: SCHEMA, port, build, next: answer.next, ready: answer.ready, axes: blank };
        let stored = path.as_ref().and_then(|path| std::fs::read(path).ok());
        if let Some(stored) = stored.and_then(|text| serde_json::from_slice::<Record>(&text).ok())
            && (stored.schema, &stored.port, &stored.build) == (SCHEMA, &record.port, &record.build)
            && (stored.next, stored.ready, stored.axes.len()) == (record.next, record.ready, record.axes.len())
            && stored.axes.iter().zip(positions).all(|(axis, position)| axis.position == position)
        {
            record.axes = stored.axes;
        }
        for (axis, &steps) in record.axes.iter_mut().zip(steps_per_unit) {
            // A coordinate in steps means nothing where a step is another one.
            if axis.steps_per_unit.to_bits() != steps.to_bits() {
                *axis = AxisRecord { steps_per_unit: steps, ..AxisRecord::default() };
            }
        }
        Self { path, record }
    }

    /// The machine coordinate of the register's zero of an axis, steps, where it is homed.
    pub fn offset(&self, axis: usize) -> Option<i64> {
        self.record.axes.get(axis)?.offset
    }

    /// The machine coordinate, in units of the axis, at a position of its register.
    pub fn coordinate(&self, axis: usize, position: i32) -> Option<f64> {
        let AxisRecord { steps_per_unit, offset, .. } = self.record.axes.get(axis)?;
        Some((i64::from(position) + (*offset)?) as f64 / steps_per_unit)
    }

    /// The limit that an axis has met, and stands near.
    pub fn limit(&self, axis: usize) -> Option<Limit> {
        self.record.axes.get(axis)?.limit
    }

    /// The machine coordinate of the register's zero of an axis; `None`: it is not homed.
    pub fn set_offset(&mut self, axis: usize, offset: Option<i64>) {
        self.record.axes.get_mut(axis).into_iter().for_each(|axis| axis.offset = offset);
    }

    /// No axis is homed any more: after a freeze motors may have lost steps.
    pub fn forget_places(&mut self) {
        self.record.axes.iter_mut().for_each(|axis| axis.offset = None);
    }

    /// The limit that an axis has met; `None`: it is away from it.
    pub fn set_limit(&mut self, axis: usize, limit: Option<Limit>) {
        self.record.axes.get_mut(axis).into_iter().for_each(|axis| axis.limit = limit);
    }

    /// Writes it, with the board as it stands now; the file appears whole or not at all.
    ///
    /// # Errors
    /// The board does not answer, or the system refuses the file: what was there before does not match the board then, and
    /// counts for nothing.
    pub fn keep(&mut self, board: &mut Board) -> io::Result<()> {
        let Status { answer, positions } = board.look().map_err(io::Error::other)?;
        (self.record.next, self.record.ready) = (answer.next, answer.ready);
        for (axis, position) in self.record.axes.iter_mut().zip(positions) {
            axis.position = position;
            axis.limit = axis.limit.filter(|limit| limit.to_go(position) > 0);
            // Without power a motor keeps no place.
            axis.offset = axis.offset.filter(|_| answer.ready);
        }
        let path = self.path.as_ref().ok_or_else(|| io::Error::other("the system names no folder for it"))?;
        let folder = path.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder)?;
        let mut file = tempfile::NamedTempFile::new_in(folder)?;
        file.write_all(&serde_json::to_vec_pretty(&self.record)?)?;
        file.persist(path).map(drop).map_err(|error| error.error)
    }
}

/// Whether a cause stops the axes at once, so that their motors may lose steps.
pub fn freezes(cause: u8, guard: &Guard) -> bool {
    match found::by_number(cause) {
        Some(Cause::Limit) => guard.limit_freezes,
        Some(Cause::Watchdog | Cause::Underrun | Cause::Stop) => false,
        Some(Cause::EStop | Cause::Overrun | Cause::Protocol | Cause::Overspeed) | None => true,
    }
}

/// Whether a cause stops the axes at once on every machine, whatever its file says of limits.
pub const fn always_freezes(cause: Cause) -> bool {
    matches!(cause, Cause::EStop | Cause::Overrun | Cause::Protocol | Cause::Overspeed)
}

/// Where the files are.
fn folder() -> Option<PathBuf> {
    match std::env::var_os(FOLDER) {
        Some(folder) => Some(folder.into()),
        None => Some(dirs::state_dir().or_else(dirs::data_local_dir)?.join("carrystep").join("boards")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_is_off_its_limit_when_it_has_moved_back_far_enough() {
        let back = Limit { direction: -1, at: -105, clear: 20 };
        assert_eq!([-105, -104, -86, -85, 300, -110].map(|position| back.to_go(position)), [20, 19, 1, 0, 0, 25]);
        let forth = Limit { direction: 1, at: 105, clear: 20 };
        assert_eq!([105, 86, 85, -300].map(|position| forth.to_go(position)), [20, 1, 0, 0]);
    }
}

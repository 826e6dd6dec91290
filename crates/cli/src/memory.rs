//! The command's memory of a board between two calls: the machine zero of each axis, and the limits
//! that the axes have met.
//!
//! The position register counts from the configuration of the board and cannot be written.
//! Therefore a file, named after the port and the build id, holds the machine coordinate of the
//! register's zero for each axis. The content is valid as long as nobody else has driven the board
//! and its drivers have kept their power. Three values detect a change:
//!
//! ```text
//! session     the number of the last session: another host opens one of its own before it writes,
//!             and a configuration leaves none
//! positions   of all axes: any move changes them
//! ready       the drivers have power
//! ```
//!
//! If one of them differs from the stored value, the content is discarded. The board does not tell
//! the number of its session; it only tells whether a number that it is asked about is the one.

use crate::connection::{ConnectedBoard, Connection};
use crate::limits::ClosedLimits;
use carrystep_core::engine::{Cause, Guard};
use carrystep_link::Status;
use serde::{Deserialize, Serialize};
use std::io::{self, Write as _};
use std::num::NonZeroU16;
use std::path::{Path, PathBuf};

/// The version of the file's format.
const SCHEMA: u32 = 2;
/// The environment variable that overrides the folder.
const FOLDER: &str = "CARRYSTEP_STATE";

/// The content of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Record {
    schema: u32,
    port: String,
    build: String,
    session: Option<NonZeroU16>,
    ready: bool,
    axes: Vec<AxisRecord>,
}

/// The entry of one axis.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct AxisRecord {
    position: i32,
    /// Steps per unit in the machine file with which the axis was homed.
    steps_per_unit: f64,
    /// The machine coordinate of the register's zero in steps, if the axis is homed.
    offset: Option<i64>,
    /// The direction, 1 or -1, in which the axis has met a limit whose switch is still closed.
    limit: Option<i8>,
}

/// What is known about a board.
#[derive(Debug)]
pub struct BoardMemory {
    path: Option<PathBuf>,
    record: Record,
}

impl BoardMemory {
    /// Reads the memory of the connected board. Entries that no longer match the board are
    /// discarded. No session may be open; an error of the line counts as a change.
    pub fn recall(connection: &mut Connection) -> Self {
        let Connection { board, axes, steps_per_unit, port, .. } = connection;
        // The canonical path, so that every link to the port gives the same name.
        let port = Path::new(port)
            .canonicalize()
            .map_or_else(|_| port.clone(), |path| path.display().to_string());
        let build = format!("{:016x}", board.facts().build);
        let name: String =
            port.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        let path = folder().map(|folder| folder.join(format!("{name}-{build}.json")));
        let blank = vec![AxisRecord::default(); axes.len()];
        let Status { answer, positions } = *board.status();
        let mut record =
            Record { schema: SCHEMA, port, build, session: None, ready: answer.ready, axes: blank };
        let stored = path.as_ref().and_then(|path| std::fs::read(path).ok());
        if let Some(stored) = stored.and_then(|text| serde_json::from_slice::<Record>(&text).ok())
            && (stored.schema, &stored.port, &stored.build) == (SCHEMA, &record.port, &record.build)
            && (stored.ready, stored.axes.len()) == (record.ready, record.axes.len())
            && stored.axes.iter().zip(positions).all(|(axis, position)| axis.position == position)
            // A read of the owner would restart the watchdog of axes that move.
            && (answer.idle || answer.halted)
            && stored.session.is_some_and(|number| board.keeps(number).unwrap_or(false))
        {
            record.session = stored.session;
            record.axes = stored.axes;
            if let Ok(closed) = ClosedLimits::read(board) {
                for (number, axis) in record.axes.iter_mut().enumerate() {
                    axis.limit = axis.limit.filter(|_| closed.any(number));
                }
            }
        }
        for (axis, &steps) in record.axes.iter_mut().zip(steps_per_unit.iter()) {
            // A coordinate in steps is meaningless if the size of a step has changed.
            if axis.steps_per_unit.to_bits() != steps.to_bits() {
                *axis = AxisRecord { steps_per_unit: steps, ..AxisRecord::default() };
            }
        }
        Self { path, record }
    }

    /// The machine coordinate of an axis' register zero, in steps; `None` if the axis is not homed.
    pub fn offset(&self, axis: usize) -> Option<i64> {
        self.record.axes.get(axis)?.offset
    }

    /// The machine coordinate in units of the axis for a position of its register; `None` if the
    /// axis is not homed.
    pub fn coordinate(&self, axis: usize, position: i32) -> Option<f64> {
        let AxisRecord { steps_per_unit, offset, .. } = self.record.axes.get(axis)?;
        Some((i64::from(position) + (*offset)?) as f64 / steps_per_unit)
    }

    /// The direction, 1 or -1, in which an axis has met a limit whose switch is still closed.
    pub fn limit(&self, axis: usize) -> Option<i8> {
        self.record.axes.get(axis)?.limit
    }

    /// The same for all axes.
    pub fn limits(&self) -> Vec<Option<i8>> {
        self.record.axes.iter().map(|axis| axis.limit).collect()
    }

    /// Sets the machine coordinate of an axis' register zero, in steps; `None` means not homed.
    pub fn set_offset(&mut self, axis: usize, offset: Option<i64>) {
        self.record.axes.get_mut(axis).into_iter().for_each(|axis| axis.offset = offset);
    }

    /// Marks every axis as not homed, because motors may lose steps in a freeze.
    pub fn forget_places(&mut self) {
        self.record.axes.iter_mut().for_each(|axis| axis.offset = None);
    }

    /// Sets the direction in which an axis has met a limit; `None` means that it is clear of limits.
    pub fn set_limit(&mut self, axis: usize, direction: Option<i8>) {
        self.record.axes.get_mut(axis).into_iter().for_each(|axis| axis.limit = direction);
    }

    /// Writes the memory together with the board's present state. The file appears only when it is
    /// complete.
    ///
    /// # Errors
    /// The board does not answer, or the system refuses the file. The old file then no
    /// longer matches the board and is ignored.
    pub fn keep(&mut self, board: &mut ConnectedBoard) -> io::Result<()> {
        let Status { answer, positions } = board.read_status().map_err(io::Error::other)?;
        self.record.ready = answer.ready;
        self.record.session = board.session().or(self.record.session);
        for (axis, position) in self.record.axes.iter_mut().zip(positions) {
            axis.position = position;
            // A motor without power does not keep its position.
            axis.offset = axis.offset.filter(|_| answer.ready);
        }
        let path = self
            .path
            .as_ref()
            .ok_or_else(|| io::Error::other("the system names no folder for it"))?;
        let folder = path.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder)?;
        let mut file = tempfile::NamedTempFile::new_in(folder)?;
        file.write_all(&serde_json::to_vec_pretty(&self.record)?)?;
        file.persist(path).map(drop).map_err(|error| error.error)
    }
}

/// True if a cause stops the axes at once on this machine, so that their motors may lose steps.
pub fn freezes(cause: u8, guard: &Guard) -> bool {
    Cause::from_number(cause).is_none_or(|cause| cause.freezes(guard.limit_freezes))
}

/// True if a cause stops the axes at once on every machine, whatever its setting for limits.
pub const fn always_freezes(cause: Cause) -> bool {
    cause.freezes(false)
}

/// The folder of the files.
fn folder() -> Option<PathBuf> {
    match std::env::var_os(FOLDER) {
        Some(folder) => Some(folder.into()),
        None => {
            Some(dirs::state_dir().or_else(dirs::data_local_dir)?.join("carrystep").join("boards"))
        }
    }
}

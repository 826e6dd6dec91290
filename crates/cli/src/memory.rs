//! The command's memory of a board between two calls: the machine zero of each axis, the limits that
//! the axes have met, and work offsets.
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
//! While a command drives the board, the file says so, and any positions are right: if the command
//! is killed, its session is still that of the board.
//!
//! The cause of a stop that is in force decides what stands: behind a ramp everything does, behind a
//! freeze no axis is homed, and the work offsets remain. Of a limit, the file says which of both it
//! is, because commands without a machine file clear stops, too.
//!
//! A file that cannot be read is never replaced: commands that move something refuse it. Work
//! offsets that do not belong to the present session are dropped, and the file says so until the
//! user has set or cleared them.

use crate::connection::{self, ConnectedBoard, Connection};
use crate::failure::Failure;
use crate::json;
use crate::limits::ClosedLimits;
use crate::work::WorkRecord;
use carrystep_core::engine::Cause;
use carrystep_files::Machine;
use carrystep_gcode::Offsets;
use carrystep_link::Status;
use record::{AxisRecord, Record};
use std::io::{self, Write as _};
use std::num::NonZeroU16;
use std::path::{Path, PathBuf};

mod record;

/// The environment variable that overrides the folder.
const FOLDER: &str = "CARRYSTEP_STATE";

/// What is known about a board.
#[derive(Debug)]
pub struct BoardMemory {
    path: Option<PathBuf>,
    record: Record,
    /// The work offsets of the record.
    work: Offsets,
    /// Why the file cannot be used.
    refused: Option<String>,
}

/// The port's canonical path, so that every link to it gives the same name, and the file.
fn file_of(port: &str, build: &str) -> (String, Option<PathBuf>) {
    let canonical = Path::new(port).canonicalize();
    let port = canonical.map_or_else(|_| port.to_owned(), |path| path.display().to_string());
    let name: String =
        port.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let path = folder().map(|folder| folder.join(format!("{name}-{build}.json")));
    (port, path)
}

/// What a user does about a file that cannot be used.
fn unusable(path: &Path, why: &str) -> Failure {
    Failure::input(format!(
        "{}: the state of the board cannot be used: {why}. Delete the file, home the machine, and \
         set the work offsets again with `carrystep offset`",
        path.display()
    ))
}

/// What a user does about work offsets that were dropped.
fn dropped(port: &str) -> Failure {
    Failure::input(format!(
        "the board at {port} was restarted, or another host has driven it, so its work offsets are \
         gone: set them again with `carrystep offset --set`, or take none with `carrystep offset \
         --clear`"
    ))
}

/// The failure for offsets that were set, and that cannot be written.
pub fn not_kept(error: &io::Error) -> Failure {
    Failure::Run(format!(
        "the work offsets cannot be kept: {error}; CARRYSTEP_STATE names another folder"
    ))
}

/// The work offsets that are kept of the board of a machine at a port, without a look at the board.
/// `name` is the path of the machine file.
///
/// # Errors
/// Nothing is kept of it, its file cannot be used, or its work offsets were dropped.
pub fn kept_offsets(port: &str, machine: &Machine, name: &Path) -> Result<Offsets, Failure> {
    let (_, id) = connection::wanted(machine, name)?;
    let build = format!("{:016x}", id.0);
    let (port, path) = file_of(port, &build);
    let nothing = || {
        Failure::input(format!(
            "nothing is known of a board at {port} with the gateware of {}: `carrystep offset` \
             shows and sets its work offsets",
            name.display()
        ))
    };
    let path = path.ok_or_else(nothing)?;
    let read = Record::read(&path, &port, &build).map_err(|why| unusable(&path, &why))?;
    match read.ok_or_else(nothing)? {
        (Record { work_lost: true, .. }, _) => Err(dropped(&port)),
        (_, offsets) => Ok(offsets),
    }
}

impl BoardMemory {
    /// Reads the memory of the connected board. Entries that no longer match the board are
    /// discarded. No session may be open; an error of the line counts as a change.
    pub fn recall(connection: &mut Connection) -> Self {
        let Connection { board, axes, steps_per_unit, registers, limit_freezes, port, .. } =
            connection;
        let build = format!("{:016x}", board.facts().build);
        let (port, path) = file_of(port, &build);
        let Status { answer, positions } = *board.status();
        let read = match &path {
            Some(path) => Record::read(path, &port, &build).map_err(|why| unusable(path, &why)),
            None => Ok(None),
        };
        let mut record = Record::blank(port, build, answer.ready, axes.len());
        record.limit_freezes = *limit_freezes;
        let (stored, refused) = match read {
            Ok(stored) => (stored, None),
            Err(failure) => (None, Some(failure.message())),
        };
        let mut work = Offsets::default();
        if let Some((stored, offsets)) = stored {
            let stands = |(axis, position): (&AxisRecord, i32)| axis.position == position;
            let is_same = (stored.ready, stored.axes.len()) == (record.ready, record.axes.len())
                && (stored.driving || stored.axes.iter().zip(positions).all(stands))
                // A read of the owner would restart the watchdog of axes that move.
                && (answer.idle || answer.halted)
                && stored.session.is_some_and(|number| keeps(board, number));
            record.work_lost = stored.work_lost || !is_same && !offsets.is_zero();
            record.limit_freezes = record.limit_freezes.or(stored.limit_freezes);
            if is_same {
                work = offsets;
                record.session = stored.session;
                record.axes = stored.axes;
                if let Ok(closed) = ClosedLimits::read(board) {
                    for (number, axis) in record.axes.iter_mut().enumerate() {
                        axis.limit = axis.limit.filter(|_| closed.any(number));
                    }
                }
            }
        }
        let known = steps_per_unit.iter().zip(registers.iter());
        for (axis, (&steps, registers)) in record.axes.iter_mut().zip(known) {
            // A coordinate in steps is meaningless if the size of a step has changed, or the motors
            // that move the letter.
            if axis.steps_per_unit.to_bits() != steps.to_bits() || axis.registers != *registers {
                let registers = registers.clone();
                *axis = AxisRecord { steps_per_unit: steps, registers, ..AxisRecord::default() };
            }
        }
        let limit_freezes = record.limit_freezes.unwrap_or(true);
        let mut memory = Self { path, record, work, refused };
        if answer.fault && freezes(answer.cause, limit_freezes) {
            memory.forget_places();
        }
        memory
    }

    /// Refuses a file that cannot be used.
    ///
    /// # Errors
    /// The file is not whole, or that of another board.
    pub fn usable(&self) -> Result<(), Failure> {
        self.refused.clone().map_or(Ok(()), |message| Err(Failure::input(message)))
    }

    /// The work offsets.
    ///
    /// # Errors
    /// As [`BoardMemory::usable`], and if they were dropped.
    pub fn work(&self) -> Result<&Offsets, Failure> {
        self.usable()?;
        if self.record.work_lost { Err(dropped(&self.record.port)) } else { Ok(&self.work) }
    }

    /// Sets the work offsets.
    pub fn set_work(&mut self, offsets: Offsets) {
        self.record.work_lost = false;
        self.work = offsets;
    }

    /// Says in the file that this command drives the board from now on, in the session that is
    /// open. After [`BoardMemory::keep`] it does not any more.
    ///
    /// # Errors
    /// As [`BoardMemory::keep`].
    pub fn drives(&mut self, board: &mut ConnectedBoard) -> io::Result<()> {
        self.record.driving = true;
        self.write(board)
    }

    /// Whether an axis is homed.
    pub fn is_homed(&self, axis: usize) -> bool {
        self.record.axes.get(axis).is_some_and(|axis| axis.offset.is_some())
    }

    /// The machine place of an axis' letter in steps for these positions of all registers: on crossed
    /// belts whole halves of a step. `None` if the axis is not homed.
    pub fn place(&self, axis: usize, positions: &[i32]) -> Option<f64> {
        let AxisRecord { registers, offset, .. } = self.record.axes.get(axis)?;
        let offset = (*offset)?;
        if registers.is_empty() {
            return Some((i64::from(*positions.get(axis)?) + offset) as f64);
        }
        let parts = registers.iter().zip(positions);
        let sum: i64 = parts.map(|(&way, &at)| i64::from(way) * i64::from(at)).sum();
        Some((sum + offset) as f64 / 2.0)
    }

    /// The machine coordinate in units of the axis for these positions of all registers; `None` if
    /// the axis is not homed.
    pub fn coordinate(&self, axis: usize, positions: &[i32]) -> Option<f64> {
        let AxisRecord { steps_per_unit, .. } = self.record.axes.get(axis)?;
        Some(self.place(axis, positions)? / steps_per_unit)
    }

    /// Makes the offsets of letters with common registers fit: these are whole steps, so the sum of
    /// both places in half steps is even. The offset of `axis` changes by half a step at most.
    pub fn fit_offset(&mut self, axis: usize) {
        let axes = &mut self.record.axes;
        let Some(own) = axes.get(axis).filter(|own| !own.registers.is_empty()) else { return };
        let common = |(number, other): (usize, &AxisRecord)| {
            let shares = own.registers.iter().zip(&other.registers).any(|(a, b)| a * b != 0);
            other.offset.filter(|_| number != axis && shares)
        };
        let other = axes.iter().enumerate().find_map(common);
        if let (Some(other), Some(own)) = (other, &mut axes[axis].offset) {
            *own += (*own + other).rem_euclid(2);
        }
    }

    /// The direction, 1 or -1, in which an axis has met a limit whose switch is still closed.
    pub fn limit(&self, axis: usize) -> Option<i8> {
        self.record.axes.get(axis)?.limit
    }

    /// The same for all axes.
    pub fn limits(&self) -> Vec<Option<i8>> {
        self.record.axes.iter().map(|axis| axis.limit).collect()
    }

    /// Sets the machine coordinate of the zero of an axis' registers, in steps, on crossed belts in half
    /// steps; `None` means not homed.
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
        self.record.driving = false;
        self.write(board)
    }

    fn write(&mut self, board: &mut ConnectedBoard) -> io::Result<()> {
        if let Some(why) = &self.refused {
            return Err(io::Error::other(why.clone()));
        }
        let Status { answer, positions } = board.read_status().map_err(io::Error::other)?;
        self.record.ready = answer.ready;
        self.record.session = board.session().or(self.record.session);
        self.record.work = WorkRecord::from(&self.work);
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
        file.write_all(json::indented(&self.record)?.as_bytes())?;
        file.as_file().sync_all()?;
        file.persist(path).map(drop).map_err(|error| error.error)
    }
}

/// Whether the board keeps this session. A command that was killed may have left a request or an
/// answer on the line, which the first try takes away.
fn keeps(board: &mut ConnectedBoard, session: NonZeroU16) -> bool {
    (0..3).find_map(|_| board.keeps(session).ok()).unwrap_or(false)
}

/// True if a cause stops the axes at once, so that their motors may lose steps. `limit_freezes` is
/// that of the machine's guard.
pub fn freezes(cause: u8, limit_freezes: bool) -> bool {
    Cause::from_number(cause).is_none_or(|cause| cause.freezes(limit_freezes))
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

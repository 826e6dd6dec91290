//! The file of a board: what is in it, and how it is read.

use crate::work::WorkRecord;
use carrystep_gcode::Offsets;
use serde::{Deserialize, Serialize};
use std::io;
use std::num::NonZeroU16;
use std::path::Path;

/// The version of the file's format.
const SCHEMA: u32 = 3;

/// The content of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Record {
    pub(super) schema: u32,
    pub(super) port: String,
    pub(super) build: String,
    pub(super) session: Option<NonZeroU16>,
    pub(super) ready: bool,
    /// A command drives the board, or was killed while it did.
    pub(super) driving: bool,
    /// Whether a limit freezes the axes of this build, if a command has known it. Files of earlier
    /// versions do not say it.
    #[serde(default)]
    pub(super) limit_freezes: Option<bool>,
    pub(super) axes: Vec<AxisRecord>,
    pub(super) work: WorkRecord,
    /// Work offsets were dropped, and the user has not set others since.
    pub(super) work_lost: bool,
}

impl Record {
    /// A record of a board about which nothing is known.
    pub(super) fn blank(port: String, build: String, ready: bool, axes: usize) -> Self {
        Self {
            schema: SCHEMA,
            port,
            build,
            session: None,
            ready,
            driving: false,
            limit_freezes: None,
            axes: vec![AxisRecord::default(); axes],
            work: WorkRecord::default(),
            work_lost: false,
        }
    }

    /// Reads the file of this port and build; `None` if there is none, or one of an older version,
    /// which had no work offsets.
    pub(super) fn read(
        path: &Path,
        port: &str,
        build: &str,
    ) -> Result<Option<(Self, Offsets)>, String> {
        let text = match std::fs::read(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            text => text.map_err(|error| error.to_string())?,
        };
        let value: serde_json::Value =
            serde_json::from_slice(&text).map_err(|error| format!("it is not whole: {error}"))?;
        let schema = value.get("schema").and_then(serde_json::Value::as_u64);
        let schema = schema.ok_or_else(|| "it has no schema".to_owned())?;
        if schema < u64::from(SCHEMA) {
            return Ok(None);
        }
        if schema > u64::from(SCHEMA) {
            return Err(format!("its schema is {schema}, and this carrystep knows {SCHEMA}"));
        }
        let record: Self = serde_json::from_value(value).map_err(|error| error.to_string())?;
        if record.port != port {
            return Err(format!("it is that of the board at {}", record.port));
        }
        if record.build != build {
            return Err(format!("it is that of a board of build {}", record.build));
        }
        let offsets = record.work.offsets();
        let offsets = offsets.ok_or_else(|| "its work offsets are impossible".to_owned())?;
        Ok(Some((record, offsets)))
    }
}

/// The entry of one axis.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct AxisRecord {
    pub(super) position: i32,
    /// Steps per unit in the machine file with which the axis was homed.
    pub(super) steps_per_unit: f64,
    /// On crossed belts, 1 or -1 for each register that counts in the letter's place, and 0 for the
    /// others: the place is in half steps. Empty if the axis' own register is its letter's place.
    #[serde(default)]
    pub(super) registers: Vec<i8>,
    /// The machine coordinate of the registers' zero in steps, on crossed belts in half steps, if the
    /// axis is homed.
    pub(super) offset: Option<i64>,
    /// The direction, 1 or -1, in which the axis has met a limit whose switch is still closed.
    pub(super) limit: Option<i8>,
}

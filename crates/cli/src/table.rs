//! The table of a plan: the greatest speeds and accelerations of each axis beside the machine's
//! limits. A plan never exceeds a limit, because the planner would have refused it.

use carrystep_core::Timebase;
use carrystep_files::unit::digits;
use carrystep_files::{Axis, Machine, Unit};
use carrystep_plan::{AxisTotals, Totals};
use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, Table};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// The limits of all axes.
#[derive(Debug, JsonSchema, Serialize)]
pub struct LimitsJson {
    /// Whole ticks of all moves, rests included.
    pub total_ticks: u64,
    /// The same in seconds.
    pub total_s: f64,
    /// The tick, ns.
    pub tick_ns: u64,
    /// How the tick was chosen, if the machine file gives none and the clock is not the default.
    pub tick_note: Option<String>,
    /// One entry per axis.
    pub axes: Vec<AxisLimits>,
}

/// The greatest values of one axis over all moves, from the exact integers of its segments.
#[derive(Debug, JsonSchema, Serialize)]
pub struct AxisLimits {
    pub axis: String,
    /// The unit of the axis.
    pub unit: String,
    /// Steps per unit, as the nearest float.
    pub steps_per_unit: f64,
    /// Number of segments of the axis.
    pub segments: u64,
    /// Steps forward minus steps backward.
    pub steps: i64,
    /// P at the end minus P at the start, in 2^-64 step: exactly 0.
    pub residue: i128,
    pub speed_steps_per_s: f64,
    pub speed_limit_steps_per_s: f64,
    pub acceleration_steps_per_s2: f64,
    pub acceleration_limit_steps_per_s2: f64,
    pub start_speed_steps_per_s: f64,
    pub start_speed_limit_steps_per_s: f64,
}

/// The totals of a plan beside the limits of its machine.
pub fn limits(machine: &Machine, totals: &Totals) -> LimitsJson {
    let axes = machine.axes.iter().zip(&totals.axes);
    LimitsJson {
        total_ticks: totals.ticks,
        total_s: totals.ticks as f64 * machine.timebase.tick_seconds(),
        tick_ns: machine.timebase.tick_ns(),
        tick_note: machine.chosen_tick.map(|chosen| chosen.to_string()),
        axes: axes.map(|(axis, totals)| axis_limits(axis, totals, &machine.timebase)).collect(),
    }
}

fn axis_limits(axis: &Axis, totals: &AxisTotals, timebase: &Timebase) -> AxisLimits {
    AxisLimits {
        axis: axis.name.clone(),
        unit: axis.unit.name.clone(),
        steps_per_unit: axis.unit.steps,
        segments: totals.segments,
        steps: totals.travel.position,
        residue: totals.residue(),
        speed_steps_per_s: totals.peaks.steps_per_s(timebase),
        speed_limit_steps_per_s: axis.speed_limit.float,
        acceleration_steps_per_s2: totals.peaks.steps_per_s2(timebase),
        acceleration_limit_steps_per_s2: axis.accel_limit.float,
        start_speed_steps_per_s: totals.peaks.start_steps_per_s(timebase),
        start_speed_limit_steps_per_s: axis.start_speed.float,
    }
}

impl LimitsJson {
    /// True if every axis ends exactly at its target, including P.
    pub fn landed(&self) -> bool {
        self.axes.iter().all(|axis| axis.residue == 0)
    }
}

impl AxisLimits {
    /// The unit in which lengths and speeds are displayed.
    fn unit(&self) -> Unit {
        Unit { name: self.unit.clone(), steps: self.steps_per_unit }
    }

    /// The row of the first table, in steps.
    fn in_steps(&self) -> [String; 7] {
        [
            self.axis.clone(),
            self.segments.to_string(),
            self.steps.to_string(),
            self.unit().own(self.steps as f64, 0),
            format!("{:.0}", self.speed_steps_per_s),
            format!("{:.0}", self.acceleration_steps_per_s2),
            self.residue.to_string(),
        ]
    }

    /// The row of the second table: the reached values and the limits, in the axis' unit.
    fn in_units(&self) -> [String; 4] {
        let unit = self.unit();
        // A start speed of one unit of V is displayed as 0.
        let seen = |found: f64| if found < 1e-6 { 0.0 } else { found };
        let of = |found: f64, limit: f64, seconds| {
            format!("{} of {}", digits(seen(found / unit.steps)), unit.own(limit, seconds))
        };
        [
            self.axis.clone(),
            of(self.speed_steps_per_s, self.speed_limit_steps_per_s, 1),
            of(self.acceleration_steps_per_s2, self.acceleration_limit_steps_per_s2, 2),
            of(self.start_speed_steps_per_s, self.start_speed_limit_steps_per_s, 1),
        ]
    }
}

impl fmt::Display for LimitsJson {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} ticks of {} ns, {:.6} s", self.total_ticks, self.tick_ns, self.total_s)?;
        if let Some(note) = &self.tick_note {
            writeln!(f, "{}", note.replace("; ", "\n"))?;
        }
        let head = ["axis", "segments", "steps", "position", "steps/s", "steps/s^2", "residue"];
        columns(f, head, self.axes.iter().map(AxisLimits::in_steps), |column| column == 0)?;
        let head = ["axis", "speed", "acceleration", "start speed"];
        columns(f, head, self.axes.iter().map(AxisLimits::in_units), |_| true)?;
        write!(f, "greatest values, and the limits that they keep to; residue in 2^-64 step")
    }
}

/// Writes rows in columns as wide as their widest cell, separated by two blanks. Columns for which
/// `left` is true are aligned to the left, the others to the right.
pub fn columns<const N: usize>(
    out: &mut impl fmt::Write,
    head: [&str; N],
    rows: impl Iterator<Item = [String; N]>,
    left: fn(usize) -> bool,
) -> fmt::Result {
    let mut table = Table::new();
    table.load_style(NOTHING).set_header(head).add_rows(rows);
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        column.set_cell_alignment(if left(index) {
            CellAlignment::Left
        } else {
            CellAlignment::Right
        });
    }
    writeln!(out, "{}", table.trim_fmt())
}

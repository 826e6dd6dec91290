//! The figures of a planned program, as a table and in `--json`.

use crate::entry::EntryFigures;
use crate::table::columns;
use carrystep_core::Timebase;
use carrystep_files::machine::Kinematics;
use carrystep_files::unit::digits;
use carrystep_files::{Axis, Unit};
use carrystep_program::{AxisSurvey, ProgramFile, Survey, unit};
use carrystep_report::TimeUse;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// Without `jerk_limit`, an axis may change its acceleration from 0 to the limit in this time, s.
pub const JERK_TIME: f64 = 0.004;

/// 2^64, the units of a step.
const STEP: f64 = 18_446_744_073_709_551_616.0;

/// The figures of a program.
#[derive(Debug, JsonSchema, Serialize)]
pub struct ProgramFigures {
    /// Lines of the program up to its end.
    pub lines: u64,
    /// Moves with a length, arcs included.
    pub moves: u64,
    /// Arcs and helices.
    pub arcs: u64,
    /// Runs from rest to rest.
    pub runs: u64,
    /// Segments of each axis; all axes have segments of the same ticks.
    pub rows: u64,
    /// How the motors follow from the letters: `cartesian` or `corexy`.
    pub kinematics: &'static str,
    /// Whole ticks of the job, rests included; waiting for people is not.
    pub total_ticks: u64,
    /// The same in seconds.
    pub total_s: f64,
    /// The tick, ns.
    pub tick_ns: u64,
    /// How the tick was chosen, if the machine file gives none and the clock is not the default.
    pub tick_note: Option<String>,
    /// Time of all G4, s.
    pub dwell_s: f64,
    /// Length of the programmed path, mm.
    pub distance_mm: f64,
    /// The part of it at G0, mm.
    pub rapid_mm: f64,
    /// Length of moves of rotary axes alone, degrees.
    pub rotary_deg: f64,
    /// The least tolerance in force at any move, mm; none without moves.
    pub tolerance_min_mm: Option<f64>,
    /// The greatest one, mm.
    pub tolerance_max_mm: Option<f64>,
    /// What the program does and the plan does not.
    pub not_done: Vec<NotDone>,
    /// How the program is entered, with `--from-block`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub entry: Option<EntryFigures>,
    /// Where the time goes.
    pub time_use: TimeUse,
    /// Each axis, in the order of the machine file.
    pub axes: Vec<ProgramAxis>,
}

/// Something that a program does and a plan does not.
#[derive(Debug, JsonSchema, Serialize)]
pub struct NotDone {
    /// pause, tool change, spindle, coolant, output, input or probe.
    pub what: &'static str,
    /// How often.
    pub count: u64,
    /// The first line of the program that does it.
    pub line: u64,
    /// What the plan does instead.
    pub instead: &'static str,
}

/// One axis of a job, from the exact integers of its segments.
#[derive(Debug, JsonSchema, Serialize)]
pub struct ProgramAxis {
    pub axis: String,
    /// The unit of the axis: mm or deg.
    pub unit: String,
    /// Steps per unit, as the nearest float.
    pub steps_per_unit: f64,
    /// Machine place at the beginning, steps.
    pub start_steps: i64,
    /// Machine place at the end, steps.
    pub end_steps: i64,
    /// P at the end minus P at the start, in 2^-64 step: exactly 0.
    pub residue: i128,
    /// Least machine place at the ends of segments, in the axis' unit: that of its letter, where
    /// crossed belts move two letters.
    pub least: f64,
    /// Greatest machine place at the ends of segments, as the least one.
    pub greatest: f64,
    /// Travel in the axis' unit, if the machine file gives one; no job leaves it. It is that of the
    /// letter.
    pub travel: Option<[f64; 2]>,
    pub speed_steps_per_s: f64,
    pub speed_limit_steps_per_s: f64,
    pub acceleration_steps_per_s2: f64,
    pub acceleration_limit_steps_per_s2: f64,
    pub jerk_steps_per_s3: f64,
    pub jerk_limit_steps_per_s3: f64,
    /// Whether the machine file gives no jerk limit; it is then the acceleration limit / 4 ms.
    pub jerk_limit_is_default: bool,
}

impl ProgramFigures {
    /// The figures of a survey.
    pub fn new(file: &ProgramFile, survey: &Survey, time_use: &TimeUse) -> Self {
        let Survey { counts, ticks, rows, axes, .. } = survey;
        let machine = file.machine();
        let not_done = counts.switches.iter().map(|one| NotDone {
            what: one.switch.name(),
            count: one.count,
            line: one.line,
            instead: one.switch.instead(),
        });
        Self {
            lines: counts.lines,
            moves: counts.moves,
            arcs: counts.arcs,
            runs: counts.runs,
            rows: *rows,
            kinematics: machine.kinematics.name(),
            total_ticks: *ticks,
            total_s: *ticks as f64 * machine.timebase.tick_seconds(),
            tick_ns: machine.timebase.tick_ns(),
            tick_note: machine.chosen_tick.map(|chosen| chosen.to_string()),
            dwell_s: counts.dwell_s,
            distance_mm: counts.distance_mm,
            rapid_mm: counts.rapid_mm,
            rotary_deg: counts.rotary_deg,
            tolerance_min_mm: counts.tolerance_mm.map(|[least, _]| least),
            tolerance_max_mm: counts.tolerance_mm.map(|[_, most]| most),
            not_done: not_done.collect(),
            entry: EntryFigures::of(file),
            time_use: time_use.clone(),
            axes: machine
                .axes
                .iter()
                .zip(file.letters().of_axes())
                .zip(axes)
                .map(|((axis, &letter), planned)| {
                    ProgramAxis::new(axis, planned, unit(letter), &machine.timebase)
                })
                .collect(),
        }
    }

    /// True if every axis ends exactly at its target, including P.
    pub fn landed(&self) -> bool {
        self.axes.iter().all(|axis| axis.residue == 0)
    }

    /// Names of the axes for which something holds, separated by commas; none if there are none.
    fn named(&self, holds: impl Fn(&ProgramAxis) -> bool) -> Option<String> {
        let axes = self.axes.iter().filter(|axis| holds(axis));
        let names: Vec<&str> = axes.map(|axis| axis.axis.as_str()).collect();
        (!names.is_empty()).then(|| names.join(", "))
    }
}

impl ProgramAxis {
    fn new(axis: &Axis, planned: &AxisSurvey, unit: &str, timebase: &Timebase) -> Self {
        let place = |units: i128| units as f64 / STEP / axis.unit.steps;
        let acceleration = axis.accel_limit.float;
        let jerk = axis.jerk_limit.as_ref().map(|limit| limit.float);
        Self {
            axis: axis.name.clone(),
            unit: unit.to_owned(),
            steps_per_unit: axis.unit.steps,
            start_steps: planned.start_steps,
            end_steps: planned.end_steps,
            residue: planned.residue(),
            least: place(planned.extent[0]),
            greatest: place(planned.extent[1]),
            travel: axis.travel.map(|ends| ends.map(|steps| steps as f64 / axis.unit.steps)),
            speed_steps_per_s: planned.peaks.steps_per_s(timebase),
            speed_limit_steps_per_s: axis.speed_limit.float,
            acceleration_steps_per_s2: planned.peaks.steps_per_s2(timebase),
            acceleration_limit_steps_per_s2: acceleration,
            jerk_steps_per_s3: planned.peaks.steps_per_s3(timebase),
            jerk_limit_steps_per_s3: jerk.unwrap_or(acceleration / JERK_TIME),
            jerk_limit_is_default: jerk.is_none(),
        }
    }

    fn row(&self) -> [String; 8] {
        let unit = Unit { name: self.unit.clone(), steps: self.steps_per_unit };
        let of = |found: f64, limit: f64, seconds| {
            format!("{} of {}", digits(found / unit.steps), unit.own(limit, seconds))
        };
        // A place that rounds to zero is shown as zero.
        let place = |value: f64| digits((value * 1e6).round() / 1e6 + 0.0);
        [
            self.axis.clone(),
            place(self.least),
            place(self.greatest),
            self.end_steps.to_string(),
            self.residue.to_string(),
            of(self.speed_steps_per_s, self.speed_limit_steps_per_s, 1),
            of(self.acceleration_steps_per_s2, self.acceleration_limit_steps_per_s2, 2),
            of(self.jerk_steps_per_s3, self.jerk_limit_steps_per_s3, 3),
        ]
    }
}

impl fmt::Display for ProgramFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.entry.iter().try_for_each(|entry| write!(f, "{entry}"))?;
        let Self { lines, moves, arcs, runs, rows, total_ticks, tick_ns, total_s, .. } = self;
        writeln!(f, "lines {lines}, moves {moves}, arcs {arcs}, runs from rest to rest {runs}")?;
        writeln!(
            f,
            "{total_ticks} ticks of {tick_ns} ns, {total_s:.6} s, {rows} segments an axis"
        )?;
        if let Some(note) = &self.tick_note {
            writeln!(f, "{}", note.replace("; ", "\n"))?;
        }
        let Self { distance_mm, rapid_mm, rotary_deg, dwell_s, .. } = self;
        write!(f, "path: {} mm, {} mm of it at G0", digits(*distance_mm), digits(*rapid_mm))?;
        if *rotary_deg > 0.0 {
            write!(f, "; {} degrees of rotary axes alone", digits(*rotary_deg))?;
        }
        if *dwell_s > 0.0 {
            write!(f, "; {} s of G4", digits(*dwell_s))?;
        }
        writeln!(f)?;
        if let (Some(least), Some(most)) = (self.tolerance_min_mm, self.tolerance_max_mm) {
            let range = if least < most {
                format!("{} to {}", digits(least), digits(most))
            } else {
                digits(least)
            };
            writeln!(f, "tolerance: {range} mm")?;
        }
        let head = ["axis", "from", "to", "end", "residue", "speed", "acceleration", "jerk"];
        columns(f, head, self.axes.iter().map(ProgramAxis::row), |column| {
            column == 0 || column > 4
        })?;
        writeln!(
            f,
            "greatest values, and the limits that they keep to; end in steps, residue in 2^-64 step"
        )?;
        if self.kinematics == Kinematics::CoreXy.name() {
            writeln!(
                f,
                "crossed belts: from and to are those of x and y; all else of their rows is of the motors, \
                 which make x + y and x - y"
            )?;
        }
        if let Some(axes) = self.named(|axis| axis.jerk_limit_is_default) {
            writeln!(f, "no jerk_limit for {axes}: it is accel_limit / 4 ms")?;
        }
        if let Some(axes) = self.named(|axis| axis.travel.is_none()) {
            writeln!(f, "no travel for {axes}: no soft limits")?;
        }
        for NotDone { what, count, line, instead } in &self.not_done {
            writeln!(f, "not done: {what} ({count}, first in line {line}): {instead}")?;
        }
        Ok(())
    }
}

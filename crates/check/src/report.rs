//! What the checker found: figures with stable names, sentences, and a table for a terminal.

use carrystep_files::Unit;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// Where the times of a capture are counted from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum OriginKind {
    /// Our own capture: the load of the first move plus the latency L.
    Known,
    /// A foreign capture: one offset for all axes, the midpoint of least and greatest error.
    Midpoint,
    /// Given by the user.
    Fixed,
}

/// The check of one capture.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct Report {
    /// Whether every axis passed.
    pub passed: bool,
    /// How the origin was found.
    pub origin: OriginKind,
    /// Time zero of the profile, in ps of the capture.
    pub origin_ps: i64,
    /// Uncertainty of the capture's times, ns: widens every bound.
    pub slack_ns: f64,
    /// The grid that edges stand on, h/Q, ns.
    pub phase_ns: f64,
    /// One entry an axis, in the machine's order.
    pub axes: Vec<AxisReport>,
}

/// The check of one axis.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct AxisReport {
    /// The axis' name.
    pub axis: String,
    /// Whether there is no failure.
    pub passed: bool,
    /// Pulses that the move asks for.
    pub pulses_expected: u64,
    /// Rising edges of STEP.
    pub pulses_found: u64,
    /// Steps forward less steps back that the move asks for.
    pub position_expected: i64,
    /// Steps forward less steps back on the pins.
    pub position_found: i64,
    /// Pulses with DIR the other way than the profile goes.
    pub pulses_wrong_direction: u64,
    /// Least e = edge less profile: negative is early.
    pub error_min_ns: Option<f64>,
    /// Greatest e.
    pub error_max_ns: Option<f64>,
    /// Root mean square of e.
    pub error_rms_ns: Option<f64>,
    /// Standard deviation of e about its mean.
    pub error_std_ns: Option<f64>,
    /// What rounding down to the phase grid alone gives: h/Q / sqrt(12).
    pub error_std_theory_ns: f64,
    /// The part of the bound that a fit may take: the greatest tolerance of the axis' moves.
    pub error_fit_ns: f64,
    /// h/Q + h^2 max(|a| / (8 v)) + fit + 2 ns + slack: |e| must not exceed it.
    pub error_bound_ns: f64,
    /// Shortest STEP high.
    pub high_min_ns: Option<f64>,
    /// What the driver asks for.
    pub high_required_ns: f64,
    /// Shortest STEP low between pulses.
    pub low_min_ns: Option<f64>,
    /// What the driver asks for.
    pub low_required_ns: f64,
    /// Shortest time from a DIR change to the next rising STEP.
    pub setup_min_ns: Option<f64>,
    /// What the driver asks for.
    pub setup_required_ns: f64,
    /// Shortest time from a rising STEP to the next DIR change.
    pub hold_min_ns: Option<f64>,
    /// What the driver asks for.
    pub hold_required_ns: f64,
    /// Greatest |period on the pins - period of the profile|.
    pub period_jitter_max_ns: Option<f64>,
    /// At constant speed one phase at most; beside it twice the curvature term.
    pub period_jitter_theory_ns: f64,
    /// Greatest relative error of the speed that one period shows, percent.
    pub speed_ripple_max_percent: Option<f64>,
    /// One phase in the shortest period of the profile, percent.
    pub speed_ripple_theory_percent: f64,
    /// Where a move is to be straight: how far the axis has been off the line, at its worst.
    pub line_off_max_steps: Option<f64>,
    /// Half a step, and what the axis travels in the time by which edges may be late: it must not be off further.
    pub line_off_bound_steps: Option<f64>,
    /// What the axis is measured in, for [`fmt::Display`].
    #[serde(skip)]
    pub unit: Option<Unit>,
    /// What is wrong, in sentences.
    pub failures: Vec<String>,
    /// Failures beyond those that are spelled out.
    pub failures_omitted: u64,
}

impl Report {
    /// Whether every axis passed.
    pub fn passed(&self) -> bool {
        self.passed
    }

    /// All failures that are spelled out, axis after axis.
    pub fn failures(&self) -> impl Iterator<Item = &str> {
        self.axes.iter().flat_map(|axis| axis.failures.iter().map(String::as_str))
    }
}

/// Two columns that belong together, as one cell.
fn against(found: &impl fmt::Display, expected: &impl fmt::Display) -> String {
    format!("{found}/{expected}")
}

/// A tenth of a ns is shown; adding zero makes minus zero plus.
fn figure(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |x| format!("{:.1}", (x * 10.0).round() / 10.0 + 0.0))
}

/// A minimum beside what the driver asks for; the latter is whole ns.
fn minimum(found: Option<f64>, required: f64) -> String {
    let found = found.map_or_else(|| "-".to_owned(), |ns| format!("{ns:.0}"));
    against(&found, &required)
}

impl AxisReport {
    /// What its pulses are: counts and errors.
    fn pulses(&self) -> [String; 8] {
        [
            self.axis.clone(),
            against(&self.pulses_found, &self.pulses_expected),
            against(&self.position_found, &self.position_expected),
            figure(self.error_min_ns),
            figure(self.error_max_ns),
            figure(self.error_rms_ns),
            figure(Some(self.error_bound_ns)),
            if self.passed { "ok" } else { "FAILED" }.to_owned(),
        ]
    }

    /// What its pins keep to.
    fn pins(&self) -> [String; 5] {
        [
            self.axis.clone(),
            minimum(self.high_min_ns, self.high_required_ns),
            minimum(self.low_min_ns, self.low_required_ns),
            minimum(self.setup_min_ns, self.setup_required_ns),
            minimum(self.hold_min_ns, self.hold_required_ns),
        ]
    }
}

const PULSES: [&str; 8] = ["axis", "pulses", "position", "e min", "e max", "e rms", "bound", ""];
const PINS: [&str; 5] = ["axis", "high", "low", "set-up", "hold"];

/// Rows under their heads: names to the left, numbers to the right, and what has no head to the left.
fn table<const N: usize>(f: &mut fmt::Formatter<'_>, head: [&str; N], rows: &[[String; N]]) -> fmt::Result {
    let mut widths = head.map(str::len);
    for row in rows {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = cell.chars().count().max(*width);
        }
    }
    let mut line = |cells: [&str; N]| {
        let mut text = String::new();
        for (column, (cell, width)) in cells.into_iter().zip(widths).enumerate() {
            if column == 0 || head[column].is_empty() {
                text.push_str(&format!("{cell:<width$}  "));
            } else {
                text.push_str(&format!("{cell:>width$}  "));
            }
        }
        writeln!(f, "{}", text.trim_end())
    };
    line(head)?;
    rows.iter().try_for_each(|row| line(row.each_ref().map(String::as_str)))
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        table(f, PULSES, &self.axes.iter().map(AxisReport::pulses).collect::<Vec<_>>())?;
        table(f, PINS, &self.axes.iter().map(AxisReport::pins).collect::<Vec<_>>())?;
        writeln!(f, "times in ns; found/required; phase {} ns", self.phase_ns)?;
        match self.origin {
            OriginKind::Known => {}
            OriginKind::Midpoint => writeln!(f, "origin: one for all axes, at {} ps of the capture", self.origin_ps)?,
            OriginKind::Fixed => writeln!(f, "origin: fixed at {} ps of the capture", self.origin_ps)?,
        }
        if self.slack_ns > 0.0 {
            writeln!(f, "the capture is good to {} ns: every bound is wider by that", self.slack_ns)?;
        }
        let fit = self.axes.iter().map(|axis| axis.error_fit_ns).fold(0.0, f64::max);
        if fit > 0.0 {
            writeln!(f, "curves are fitted: up to {fit} ns of a bound are for that")?;
        }
        for axis in &self.axes {
            if let (Some(off), Some(bound)) = (axis.line_off_max_steps, axis.line_off_bound_steps) {
                let far = |steps: f64| match &axis.unit {
                    Some(unit) => unit.both(steps, 0),
                    None => format!("{steps:.3} steps"),
                };
                writeln!(f, "straight: axis {} up to {} off the line, bound {}", axis.axis, far(off), far(bound))?;
            }
        }
        for axis in &self.axes {
            for failure in &axis.failures {
                writeln!(f, "FAILED {failure}")?;
            }
            if axis.failures_omitted > 0 {
                writeln!(f, "FAILED axis {}: and {} more", axis.axis, axis.failures_omitted)?;
            }
        }
        Ok(())
    }
}

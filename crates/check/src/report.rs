//! The report of the checker: figures with stable names, messages, and a table for a terminal.
//!
//! The names of the fields are part of `--json` and may not change.

use carrystep_files::Unit;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// The time of a capture from which all times are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum OriginKind {
    /// A capture by carrystep: the load of the first move plus the latency L.
    Known,
    /// A foreign capture: one offset for all axes, the midpoint of the least and the greatest
    /// error.
    Midpoint,
    /// An origin that the user gives.
    Fixed,
}

/// The check of one capture.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct CheckReport {
    /// Whether every axis passed.
    pub passed: bool,
    /// How the origin was determined.
    pub origin: OriginKind,
    /// Time zero of the profile, ps of the capture.
    pub origin_ps: i64,
    /// Uncertainty of the capture's times, ns. It widens every bound.
    pub slack_ns: f64,
    /// Length of a phase, h/Q, ns. Edges are placed on this grid.
    pub phase_ns: f64,
    /// One entry per axis, in the order of the machine file.
    pub axes: Vec<AxisReport>,
}

/// The check of one axis.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct AxisReport {
    /// The name of the axis.
    pub axis: String,
    /// Whether there is no failure.
    pub passed: bool,
    /// Number of pulses that the moves require.
    pub pulses_expected: u64,
    /// Number of rising edges of STEP.
    pub pulses_found: u64,
    /// Steps forward minus steps backward that the moves require.
    pub position_expected: i64,
    /// Steps forward minus steps backward on the pins.
    pub position_found: i64,
    /// Number of pulses for which DIR and the profile have different directions.
    pub pulses_wrong_direction: u64,
    /// Least error e = edge - profile, ns; negative is early.
    pub error_min_ns: Option<f64>,
    /// Greatest error e, ns.
    pub error_max_ns: Option<f64>,
    /// Root mean square of e, ns.
    pub error_rms_ns: Option<f64>,
    /// Standard deviation of e about its mean, ns.
    pub error_std_ns: Option<f64>,
    /// Standard deviation that results from rounding down to the phase grid alone, h/Q / sqrt(12),
    /// ns.
    pub error_std_theory_ns: f64,
    /// The part of the bound that a fit may use, ns: the greatest tolerance of the axis' moves.
    pub error_fit_ns: f64,
    /// The bound of |e|, ns: h/Q + h^2 max(|a| / (8 v)) + fit + 2 ns + slack.
    pub error_bound_ns: f64,
    /// Shortest high time of STEP, ns.
    pub step_high_min_ns: Option<f64>,
    /// High time that the driver requires, ns.
    pub step_high_required_ns: f64,
    /// Shortest low time of STEP between pulses, ns.
    pub step_low_min_ns: Option<f64>,
    /// Low time that the driver requires, ns.
    pub step_low_required_ns: f64,
    /// Shortest time from a change of DIR to the next rising edge of STEP, ns.
    pub dir_setup_min_ns: Option<f64>,
    /// Set-up time that the driver requires, ns.
    pub dir_setup_required_ns: f64,
    /// Shortest time from a rising edge of STEP to the next change of DIR, ns.
    pub dir_hold_min_ns: Option<f64>,
    /// Hold time that the driver requires, ns.
    pub dir_hold_required_ns: f64,
    /// Greatest |period on the pins - period of the profile|, ns.
    pub period_jitter_max_ns: Option<f64>,
    /// The jitter that theory allows, ns: one phase, and twice the curvature term where the speed
    /// changes.
    pub period_jitter_theory_ns: f64,
    /// Greatest relative error of the speed of one period, percent.
    pub speed_ripple_max_percent: Option<f64>,
    /// The ripple that theory allows: one phase in the shortest period of the profile, percent.
    pub speed_ripple_theory_percent: f64,
    /// Greatest distance of the axis from the line, steps; only for moves along a straight line.
    pub line_off_max_steps: Option<f64>,
    /// The bound of this distance, steps: half a step, and the distance that the axis travels in
    /// the time by which edges may be late.
    pub line_off_bound_steps: Option<f64>,
    /// The unit of the axis, for [`fmt::Display`].
    #[serde(skip)]
    pub unit: Option<Unit>,
    /// The failures, as messages.
    pub failures: Vec<String>,
    /// Number of failures without a message.
    pub failures_omitted: u64,
}

impl CheckReport {
    /// Whether every axis passed.
    pub fn passed(&self) -> bool {
        self.passed
    }

    /// All messages, axis after axis.
    pub fn failures(&self) -> impl Iterator<Item = &str> {
        self.axes.iter().flat_map(|axis| axis.failures.iter().map(String::as_str))
    }
}

/// Two columns that belong together, as one cell.
fn against(found: &impl fmt::Display, expected: &impl fmt::Display) -> String {
    format!("{found}/{expected}")
}

/// Formats ns with one decimal. Adding zero turns minus zero into plus zero.
fn figure(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |x| format!("{:.1}", (x * 10.0).round() / 10.0 + 0.0))
}

/// Formats a minimum beside the value that the driver requires, which is in whole ns.
fn minimum(found: Option<f64>, required: f64) -> String {
    let found = found.map_or_else(|| "-".to_owned(), |ns| format!("{ns:.0}"));
    against(&found, &required)
}

impl AxisReport {
    /// The row of the pulses: counts and errors.
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

    /// The row of the pin times.
    fn pins(&self) -> [String; 5] {
        [
            self.axis.clone(),
            minimum(self.step_high_min_ns, self.step_high_required_ns),
            minimum(self.step_low_min_ns, self.step_low_required_ns),
            minimum(self.dir_setup_min_ns, self.dir_setup_required_ns),
            minimum(self.dir_hold_min_ns, self.dir_hold_required_ns),
        ]
    }
}

const PULSES: [&str; 8] = ["axis", "pulses", "position", "e min", "e max", "e rms", "bound", ""];
const PINS: [&str; 5] = ["axis", "high", "low", "set-up", "hold"];

/// Writes rows below their headings. Names and columns without a heading are aligned to the left,
/// numbers to the right.
pub(crate) fn table<const N: usize>(
    f: &mut fmt::Formatter<'_>,
    head: [&str; N],
    rows: &[[String; N]],
) -> fmt::Result {
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

impl fmt::Display for CheckReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        table(f, PULSES, &self.axes.iter().map(AxisReport::pulses).collect::<Vec<_>>())?;
        table(f, PINS, &self.axes.iter().map(AxisReport::pins).collect::<Vec<_>>())?;
        writeln!(f, "times in ns; found/required; phase {} ns", self.phase_ns)?;
        match self.origin {
            OriginKind::Known => {}
            OriginKind::Midpoint => {
                writeln!(f, "origin: one for all axes, at {} ps of the capture", self.origin_ps)?;
            }
            OriginKind::Fixed => {
                writeln!(f, "origin: fixed at {} ps of the capture", self.origin_ps)?;
            }
        }
        if self.slack_ns > 0.0 {
            writeln!(
                f,
                "the capture is good to {} ns: every bound is wider by that",
                self.slack_ns
            )?;
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
                writeln!(
                    f,
                    "straight: axis {} up to {} off the line, bound {}",
                    axis.axis,
                    far(off),
                    far(bound)
                )?;
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

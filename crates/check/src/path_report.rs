//! The report of a checked job: figures with stable names, messages, and a table for a terminal.
//!
//! The names of the fields are part of `--json` and may not change.

use crate::pins::Stretch;
use crate::report::table;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// The check of the pulses of a job.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct PathReport {
    /// Whether there is no failure.
    pub passed: bool,
    /// The greatest distance of the tool from the programmed path, as a part of what is allowed
    /// there: over x, y and z, mm.
    pub deviation_mm: f64,
    /// What is allowed at this place: the tolerance and one step of each axis, mm.
    pub deviation_bound_mm: f64,
    /// The distance of the tool from the path at the same place, the greatest of a, b and c,
    /// degrees.
    pub deviation_deg: f64,
    /// What is allowed at this place, degrees.
    pub deviation_bound_deg: f64,
    /// The line of the program at this place; none if nothing moves.
    pub deviation_line: Option<u64>,
    /// The time at this place, s from the start of the job; none if nothing moves.
    pub deviation_at_s: Option<f64>,
    /// Number of pulses by the distance of the tool from the programmed path after them, as a part
    /// of what is allowed there: from 0 to 1/40, from 1/40 to 2/40, and so on. The last number
    /// counts the pulses beyond what is allowed.
    pub deviation_counts: Vec<u64>,
    /// Changes of one output or more, whose places were compared with the program; none if the
    /// outputs were not checked.
    pub output_changes: Option<u64>,
    /// Each axis, in the order of the machine file.
    pub axes: Vec<PathAxisReport>,
    /// What is wrong.
    pub failures: Vec<String>,
}

/// The pins of one axis.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct PathAxisReport {
    /// The name of the axis.
    pub axis: String,
    /// Number of rising edges of STEP.
    pub pulses: u64,
    /// Steps forward minus steps backward that the program requires.
    pub position_expected: i64,
    /// Steps forward minus steps backward on the pins.
    pub position_found: i64,
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
}

/// A measured time in ns.
pub(crate) fn minimum(stretch: Option<Stretch>) -> Option<f64> {
    stretch.map(|stretch| stretch.ps as f64 / 1e3)
}

impl PathAxisReport {
    /// The pin times: name, found, required.
    fn times(&self) -> [(&'static str, Option<f64>, f64); 4] {
        [
            ("STEP is high for", self.step_high_min_ns, self.step_high_required_ns),
            ("STEP is low for", self.step_low_min_ns, self.step_low_required_ns),
            ("DIR is set up for", self.dir_setup_min_ns, self.dir_setup_required_ns),
            ("DIR is held for", self.dir_hold_min_ns, self.dir_hold_required_ns),
        ]
    }

    /// What is wrong with this axis, in a capture whose times are uncertain by so many ns.
    pub(crate) fn failures(&self, slack_ns: f64) -> Vec<String> {
        let Self { axis, position_expected, position_found, .. } = self;
        let mut failures = Vec::new();
        if position_found != position_expected {
            failures.push(format!(
                "axis {axis}: the pulses end at {position_found} steps, the program at \
                 {position_expected}"
            ));
        }
        for (what, found, required) in self.times() {
            if let Some(found) = found.filter(|found| *found + slack_ns < required) {
                failures
                    .push(format!("axis {axis}: {what} {found} ns, {required} ns are required"));
            }
        }
        failures
    }

    fn row(&self) -> [String; 7] {
        let time = |(_, found, required): (&str, Option<f64>, f64)| {
            let found = found.map_or_else(|| "-".to_owned(), |ns| format!("{ns:.0}"));
            format!("{found}/{required}")
        };
        let [high, low, set_up, hold] = self.times().map(time);
        let position = format!("{}/{}", self.position_found, self.position_expected);
        [self.axis.clone(), self.pulses.to_string(), position, high, low, set_up, hold]
    }
}

const HEAD: [&str; 7] = ["axis", "pulses", "position", "high", "low", "set-up", "hold"];

impl fmt::Display for PathReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        table(f, HEAD, &self.axes.iter().map(PathAxisReport::row).collect::<Vec<_>>())?;
        writeln!(f, "positions in steps, times in ns; found/required")?;
        if let (Some(line), Some(at)) = (self.deviation_line, self.deviation_at_s) {
            write!(
                f,
                "from the path: {:.4} of {:.4} mm",
                self.deviation_mm, self.deviation_bound_mm
            )?;
            if self.deviation_deg > 0.0 {
                write!(
                    f,
                    ", {:.4} of {:.4} degrees",
                    self.deviation_deg, self.deviation_bound_deg
                )?;
            }
            writeln!(f, " at {at:.6} s, line {line}")?;
        }
        if let Some(changes) = self.output_changes {
            writeln!(
                f,
                "changes of outputs, compared with their places in the program: {changes}"
            )?;
        }
        self.failures.iter().try_for_each(|failure| writeln!(f, "FAILED {failure}"))
    }
}

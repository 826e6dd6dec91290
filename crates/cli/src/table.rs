//! What a plan asks of each axis, beside what the machine allows. No plan exceeds a limit: it would
//! have been refused.

use carrystep_plan::Plan;
use carrystep_spec::{Axis, MoveFile, Segment, decimal};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// The limits of all axes.
#[derive(Debug, JsonSchema, Serialize)]
pub struct Limits {
    /// Whole ticks of all moves, rests included.
    pub total_ticks: u64,
    /// The same in seconds.
    pub total_s: f64,
    /// One entry an axis.
    pub axes: Vec<AxisLimits>,
}

/// The greatest values of one axis over all moves, from the exact integers of its segments.
#[derive(Debug, JsonSchema, Serialize)]
pub struct AxisLimits {
    pub axis: String,
    /// Segments sent to it.
    pub segments: usize,
    /// Steps forward less steps back.
    pub steps: i64,
    /// P at the end less P at the start, in 2^-64 step: exactly 0.
    pub residue: i128,
    pub speed_steps_per_s: f64,
    pub speed_limit_steps_per_s: f64,
    pub acceleration_steps_per_s2: f64,
    pub acceleration_limit_steps_per_s2: f64,
    pub start_speed_steps_per_s: f64,
    pub start_speed_limit_steps_per_s: f64,
}

/// Measures a plan against its machine.
pub fn limits(file: &MoveFile, plan: &Plan) -> Limits {
    let axes: Vec<AxisLimits> =
        file.machine.axes.iter().enumerate().map(|(i, axis)| axis_limits(i, axis, plan)).collect();
    let total_ticks = plan.total_ticks();
    Limits { total_ticks, total_s: total_ticks as f64 * plan.build.timebase.tick_seconds(), axes }
}

fn axis_limits(index: usize, axis: &Axis, plan: &Plan) -> AxisLimits {
    let timebase = &plan.build.timebase;
    let planned = || plan.moves.iter().map(|m| &m.axes[index]);
    let greatest = |of: fn(&carrystep_plan::Peaks) -> u64| planned().map(|a| of(&a.peaks)).max().unwrap_or(0);
    let (v, a, start) = (greatest(|p| p.speed), greatest(|p| p.acceleration), greatest(|p| p.start_speed));
    let steps: i64 = planned().map(|a| a.steps).sum();
    let travelled: i128 = plan.axis_segments(index).map(|(_, segment)| distance(&segment)).sum();
    let per_second =
        |units: u64, power: u32| units as f64 * 2_f64.powi(-64) / timebase.tick_seconds().powi(power.cast_signed());
    AxisLimits {
        axis: axis.name.clone(),
        segments: planned().map(|a| a.segments.len()).sum(),
        steps,
        residue: travelled - (i128::from(steps) << 64),
        speed_steps_per_s: per_second(v, 1),
        speed_limit_steps_per_s: decimal::to_f64(&axis.speed_limit),
        acceleration_steps_per_s2: per_second(a, 2),
        acceleration_limit_steps_per_s2: decimal::to_f64(&axis.accel_limit),
        start_speed_steps_per_s: per_second(start, 1),
        start_speed_limit_steps_per_s: decimal::to_f64(&axis.start_speed),
    }
}

/// What a segment travels, in 2^-64 step, exactly.
fn distance(segment: &Segment) -> i128 {
    let n = i128::from(segment.ticks);
    let (v, a, j) = (i128::from(segment.v), i128::from(segment.a), i128::from(segment.j));
    n * v + n * (n - 1) / 2 * a + n * (n - 1) * (n - 2) / 6 * j
}

impl Limits {
    /// Every axis ends exactly where it should, P included.
    pub fn landed(&self) -> bool {
        self.axes.iter().all(|axis| axis.residue == 0)
    }
}

impl fmt::Display for Limits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} ticks, {:.6} s", self.total_ticks, self.total_s)?;
        let name = self.axes.iter().map(|axis| axis.axis.len()).max().unwrap_or(4).max(4);
        writeln!(
            f,
            "{:<name$}  {:>8}  {:>8}  {:>19}  {:>19}  {:>15}  {:>7}",
            "axis", "segments", "steps", "speed/limit", "accel/limit", "start/limit", "residue"
        )?;
        for axis in &self.axes {
            let pair = |found: f64, limit: f64| format!("{found:.0}/{limit:.0}");
            writeln!(
                f,
                "{:<name$}  {:>8}  {:>8}  {:>19}  {:>19}  {:>15}  {:>7}",
                axis.axis,
                axis.segments,
                axis.steps,
                pair(axis.speed_steps_per_s, axis.speed_limit_steps_per_s),
                pair(axis.acceleration_steps_per_s2, axis.acceleration_limit_steps_per_s2),
                pair(axis.start_speed_steps_per_s, axis.start_speed_limit_steps_per_s),
                axis.residue
            )?;
        }
        write!(f, "steps/s and steps/s^2; residue in 2^-64 step")
    }
}

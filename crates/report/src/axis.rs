//! What is known of an axis before a plan begins.

use serde::Serialize;

/// An axis and its limits, in its own unit and seconds.
#[derive(Debug, Clone, Serialize)]
pub struct AxisSetup {
    /// Its name.
    pub name: String,
    /// The name of its unit.
    pub unit: String,
    /// Steps in one unit, over 0.
    pub steps_per_unit: f64,
    /// Where it is at the beginning, units.
    pub start: f64,
    /// Greatest speed, acceleration and jerk, units/s, units/s^2 and units/s^3. An axis without a
    /// jerk limit has none.
    pub limits: [Option<f64>; 3],
    /// Whether the feed counts its speed: true for the axes that move the tool along a line in mm.
    /// Where none of them moves, the feed counts the others.
    pub linear: bool,
    /// How far the tool moves with one unit of the axis, for the speed along the path: 1; 0 for all but
    /// the first motor of a letter; the root of a half for the motors of crossed belts, which move the
    /// tool along diagonals.
    #[serde(skip)]
    pub counts: f64,
    /// The coordinate of its letter, which the path is drawn over: a sum of the places of axes, each
    /// with its factor. It is that of the axis itself, except on crossed belts.
    #[serde(skip)]
    pub letter: Vec<(usize, f64)>,
    /// What the curves of the axis are called.
    pub title: String,
}

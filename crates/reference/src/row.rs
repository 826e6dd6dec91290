//! One step of a list.

use serde::Serialize;

/// Most steps in a list.
pub const MOST_ROWS: u32 = 1_000_000;

/// Step n: when it is reached, how fast it is passed, and how long the next one takes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Row {
    /// n, from 0.
    pub step: u32,
    /// t_n, seconds.
    pub time_s: f64,
    /// Speed at t_n, steps/s.
    pub speed_steps_per_s: f64,
    /// c_n = t_(n+1) - t_n, seconds; none after the last step.
    pub delay_s: Option<f64>,
    /// c_n in counts of a timer, rounded to the nearest, where a clock was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delay_counts: Option<u64>,
}

//! The figures of a table that a user needs to judge it.
//!
//! The names of the fields are part of `--json` and may not change.

use crate::groups::Group;
use crate::request::TableRequest;
use schemars::JsonSchema;
use serde::Serialize;

/// Figures of a table. "Real" figures are those of the rounded counts that the timer plays.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct TableFigures {
    /// Timer counts per second.
    pub timer_hz: f64,
    /// Number of entries.
    pub entries: usize,
    /// Number of pulses of the ramp, over all entries.
    pub ramp_pulses: u64,
    /// Real duration of the ramp, seconds.
    pub ramp_seconds: f64,
    /// Duration of the ramp by the formula, seconds.
    pub ramp_seconds_ideal: f64,
    /// Real speed of the first entry, steps/s, to which the motor jumps from rest.
    pub first_speed: f64,
    /// Requested top speed, steps/s.
    pub top_speed_asked: f64,
    /// Real top speed, steps/s: the nearest speed that whole counts allow.
    pub top_speed: f64,
    /// Real top speed, rpm.
    pub top_rpm: f64,
    /// Greatest relative change of the speed of an entry or of the cruise by rounding.
    pub worst_speed_error: f64,
    /// Greatest acceleration by the formula, between the middles of neighbouring entries,
    /// steps/s^2.
    pub peak_acceleration: f64,
    /// Memory on the controller, bytes.
    pub bytes: usize,
}

impl TableFigures {
    pub(crate) fn new(
        request: &TableRequest,
        ideal: &[f64],
        counts: &[u32],
        sizes: &[u32],
        groups: &[Group],
        inverse: Option<&[u16]>,
    ) -> Self {
        let timer_hz = request.timer.frequency();
        let asked = request.top_frequency();
        let cruise = (timer_hz / asked).round();
        let error = |(&c, &i): (&u32, &f64)| (i / f64::from(c) - 1.0).abs();
        let worst = counts
            .iter()
            .zip(ideal)
            .map(error)
            .fold((timer_hz / (asked * cruise) - 1.0).abs(), f64::max);
        Self {
            timer_hz,
            entries: counts.len(),
            ramp_pulses: sizes.iter().map(|&p| u64::from(p)).sum(),
            ramp_seconds: counts
                .iter()
                .zip(sizes)
                .map(|(&c, &p)| u64::from(c) * u64::from(p))
                .sum::<u64>() as f64
                / timer_hz,
            ramp_seconds_ideal: ideal
                .iter()
                .zip(sizes)
                .map(|(c, &p)| c * f64::from(p))
                .sum::<f64>()
                / timer_hz,
            first_speed: counts.first().map_or(timer_hz / cruise, |&c| timer_hz / f64::from(c)),
            top_speed_asked: asked,
            top_speed: timer_hz / cruise,
            top_rpm: request.motor.rpm(timer_hz / cruise),
            worst_speed_error: worst,
            peak_acceleration: peak_acceleration(timer_hz, ideal, sizes),
            bytes: 2 * (counts.len() + inverse.map_or(0, <[u16]>::len)) + 4 * groups.len(),
        }
    }
}

/// The acceleration (v2^2 - v1^2) / 2, divided by the steps between the middles of two entries.
fn peak_acceleration(timer_hz: f64, ideal: &[f64], sizes: &[u32]) -> f64 {
    let entries: Vec<(f64, f64)> =
        ideal.iter().zip(sizes).map(|(c, &p)| (timer_hz / c, f64::from(p))).collect();
    let between = |pair: &[(f64, f64)]| {
        let ((v1, p1), (v2, p2)) = (pair[0], pair[1]);
        (v2 - v1) * (v2 + v1) / (p1 + p2)
    };
    entries.windows(2).map(between).fold(0.0, f64::max)
}

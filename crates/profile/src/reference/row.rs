//! The rows of a list, and the choice of what is listed.
//!
//! The names of the fields are part of `--json` and may not change.

use carrystep_core::StartPhase;
use schemars::JsonSchema;
use serde::Serialize;

/// The greatest number of rows in a list.
pub const MOST_ROWS: u32 = 1_000_000;

/// What is listed of a profile.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Listing {
    /// The position of a pulse in its step. `Zero` lists t_0, t_1 and so on, as the sources do;
    /// `Half` lists the middles of the steps, at which the gateware emits the pulses by default.
    pub phase: StartPhase,
    /// Frequency of a timer's clock, Hz. If it is given, delays are also listed in counts of this
    /// clock.
    pub clock_hz: Option<f64>,
}

impl Listing {
    /// The listing of the sources, which begins with t_0 = 0.
    pub const SOURCES: Self = Self { phase: StartPhase::Zero, clock_hz: None };

    /// The number of the first step, and the distance in steps from its pulse to its end.
    pub(crate) const fn first(&self) -> (u32, f64) {
        match self.phase {
            StartPhase::Zero => (0, 0.0),
            StartPhase::Half => (1, 0.5),
        }
    }
}

/// One step n: the time at which it is reached, the speed there, and the delay until the next step.
#[derive(Debug, Clone, Copy, PartialEq, JsonSchema, Serialize)]
pub struct Row {
    /// The number n of the step, counted from 0, or from 1 if pulses are in the middle of their
    /// steps.
    pub step: u32,
    /// The time t_n, seconds.
    pub time_s: f64,
    /// Speed at t_n, steps/s.
    pub speed_steps_per_s: f64,
    /// The delay c_n = t_(n+1) - t_n, seconds; absent after the last step.
    pub delay_s: Option<f64>,
    /// The delay c_n in counts of the timer, rounded to the nearest, if a clock was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delay_counts: Option<u64>,
}

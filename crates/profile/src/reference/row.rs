//! One step of a list, and what is listed.

use carrystep_core::StartPhase;
use schemars::JsonSchema;
use serde::Serialize;

/// Most steps in a list.
pub const MOST_ROWS: u32 = 1_000_000;

/// What is listed of a profile.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Listing {
    /// Where in a step a pulse is: `Zero` lists t_0, t_1 ... as the sources do, `Half` the middles of the steps, as
    /// the gateware emits them by default.
    pub phase: StartPhase,
    /// A timer's clock, Hz: delays in its counts too.
    pub clock_hz: Option<f64>,
}

impl Listing {
    /// As the sources list: t_0 = 0, t_1 ...
    pub const SOURCES: Self = Self { phase: StartPhase::Zero, clock_hz: None };

    /// Number of the first step, and how far before its end its pulse is.
    pub(crate) const fn first(&self) -> (u32, f64) {
        match self.phase {
            StartPhase::Zero => (0, 0.0),
            StartPhase::Half => (1, 0.5),
        }
    }
}

/// Step n: when it is reached, how fast it is passed, and how long the next one takes.
#[derive(Debug, Clone, Copy, PartialEq, JsonSchema, Serialize)]
pub struct Row {
    /// n, from 0; from 1 where pulses are in the middle of their step.
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

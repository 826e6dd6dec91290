//! Why there can be no engine with some parameters: each error names them, and what would do.

use super::{MAX_AXES, MAX_LOOKS, MAX_ROUND, MAX_ROUNDS, MIN_CLOCKS_PER_PHASE, TURN};
use crate::build::MAX_CLOCKS;
use thiserror::Error;

/// Parameters that make no engine.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum EngineError {
    /// No axis, or too many.
    #[error("{0} axes: an engine has 1 to {MAX_AXES}")]
    Axes(usize),
    /// A tick is too short for the turns of all axes.
    #[error(
        "{axes} axes need {TURN} clocks each and one to close the tick, {needed} in all, but a tick of {tick_ns} ns \
         at {clock_hz} Hz has {clocks}: {}, {} or fewer axes would do", tick_said(.least_tick_ns), clock_said(.least_hz)
    )]
    Schedule {
        /// How many there are to be.
        axes: usize,
        /// Clocks of their turns.
        needed: u32,
        /// Clocks of a tick.
        clocks: u32,
        /// Tick, ns.
        tick_ns: u64,
        /// Clock, Hz.
        clock_hz: u64,
        /// The shortest tick that would do, ns.
        least_tick_ns: Option<u64>,
        /// The slowest clock that would do, Hz.
        least_hz: Option<u64>,
    },
    /// Events could not be written between the phases.
    #[error(
        "{phases} phases in the {clocks} clocks of a tick: an engine needs {MIN_CLOCKS_PER_PHASE} clocks in each; \
         {}, {} or fewer phases would do", tick_said(.least_tick_ns), clock_said(.least_hz)
    )]
    ShortPhase {
        /// Phases of a tick.
        phases: u32,
        /// Clocks of a tick.
        clocks: u32,
        /// The shortest tick that would do, ns.
        least_tick_ns: Option<u64>,
        /// The slowest clock that would do, Hz.
        least_hz: Option<u64>,
    },
    /// A pin timing that the timers cannot count.
    #[error("axis {axis}: {name} is {clocks} clocks: from 1 to {MAX_CLOCKS} can be counted")]
    PinTiming {
        /// The axis.
        axis: usize,
        /// width, gap, setup or hold.
        name: &'static str,
        /// What was asked for.
        clocks: u32,
    },
    /// A round is not a power of two.
    #[error("a round of {0} ticks: a power of two from 2 to {MAX_ROUND} is needed")]
    Round(u32),
    /// A figure of the guard that its counter cannot hold.
    #[error("{name} of {rounds} rounds: at most {MAX_ROUNDS} can be counted; a longer round would do")]
    Rounds {
        /// watchdog or enable.
        name: &'static str,
        /// What was asked for.
        rounds: u32,
    },
    /// Looks that the debounce cannot count.
    #[error("a debounce of {0} looks: from 1 to {MAX_LOOKS} can be counted; a longer round would do")]
    Debounce(u32),
    /// A stop acceleration that is none, or that passes every speed.
    #[error("the stop acceleration of axis {axis} is {units} x 2^-64 steps per tick^2: from 1 to 2^62 is needed")]
    StopAcceleration {
        /// The axis.
        axis: usize,
        /// What was asked for.
        units: u64,
    },
    /// Not one stop acceleration for each axis.
    #[error("{found} stop accelerations for {axes} axes")]
    StopCount {
        /// Axes with pins.
        axes: usize,
        /// Stop accelerations.
        found: usize,
    },
}

fn clock_said(least_hz: &Option<u64>) -> String {
    least_hz.map_or_else(|| "a faster clock".to_owned(), |hz| format!("a clock of {hz} Hz"))
}

fn tick_said(least_ns: &Option<u64>) -> String {
    least_ns.map_or_else(|| "a longer tick".to_owned(), |ns| format!("a tick of {ns} ns"))
}

//! Errors of the engine's build parameters. Each names the parameter, its value, and values that
//! are possible.

use super::{
    Adders, MAX_AXES, MAX_DEBOUNCE_SAMPLES, MAX_LATCHES, MAX_LOOKS, MAX_PWM_DIVIDER, MAX_ROUND,
    MAX_ROUNDS, MIN_CLOCKS_PER_PHASE, PWM_STEPS,
};
use crate::build::MAX_CLOCKS;
use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::String;
use thiserror::Error;

/// Build parameters for which no engine can be built.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum EngineError {
    /// The number of axes is 0 or more than [`MAX_AXES`].
    #[error("{0} axes: an engine has 1 to {MAX_AXES}")]
    Axes(usize),
    /// No engine of so many axes has this number of adders.
    #[error("{} adders: an engine of {} has {}", .0.adders, .0.axes_said(), .0.possible())]
    Adders(Adders),
    /// An engine with several adders cannot have several latches.
    #[error("several latches on {0} adders: an engine with several adders has at most one latch")]
    LatchesOfAdders(usize),
    /// A tick has too few clocks for the time slots of all axes.
    #[error(
        "{}, {needed} in all, but a tick of {tick_ns} ns \
         at {clock_hz} Hz has {clocks}: {}, {} or {} would do", adders.need(), tick_said(.least_tick_ns),
        clock_said(.least_hz), adders.way_out()
    )]
    Schedule {
        /// Numbers of axes and of adders.
        adders: Adders,
        /// Clocks that their time slots need.
        needed: u32,
        /// Clocks that the tick has.
        clocks: u32,
        /// Tick, ns.
        tick_ns: u64,
        /// Clock, Hz.
        clock_hz: u64,
        /// The shortest tick that suffices at this clock, ns.
        least_tick_ns: Option<u64>,
        /// The slowest clock that would do, Hz.
        least_hz: Option<u64>,
    },
    /// A phase has too few clocks to write events between two phases.
    #[error(
        "{phases} phases in the {clocks} clocks of a tick: an engine needs {MIN_CLOCKS_PER_PHASE} clocks in each; \
         {}, {} or fewer phases would do", tick_said(.least_tick_ns), clock_said(.least_hz)
    )]
    ShortPhase {
        /// Phases of a tick.
        phases: u32,
        /// Clocks of a tick.
        clocks: u32,
        /// The shortest tick that suffices at this clock, ns.
        least_tick_ns: Option<u64>,
        /// The slowest clock that would do, Hz.
        least_hz: Option<u64>,
    },
    /// A pin time is out of the range of its timer.
    #[error("axis {axis}: {name} is {clocks} clocks: from 1 to {MAX_CLOCKS} can be counted")]
    PinTiming {
        /// Number of the axis.
        axis: usize,
        /// Name of the time: step_high, step_low, dir_setup or dir_hold.
        name: &'static str,
        /// The value, in clocks.
        clocks: u32,
    },
    /// A round is not a power of two.
    #[error("a round of {0} ticks: a power of two from 2 to {MAX_ROUND} is needed")]
    Round(u32),
    /// A time of the guard is greater than its counter.
    #[error(
        "{name} of {rounds} rounds: at most {MAX_ROUNDS} can be counted; a longer round would do"
    )]
    Rounds {
        /// Name of the time: watchdog or enable.
        name: &'static str,
        /// The value, in rounds.
        rounds: u32,
    },
    /// The number of samples for the debounce is out of its range.
    #[error(
        "a debounce of {0} samples: from 1 to {MAX_DEBOUNCE_SAMPLES} can be counted; a longer round would do"
    )]
    Debounce(u32),
    /// Inputs of a row are not below the number of axes, or are active low without existing.
    #[error(
        "inputs {exist:#x} of row {row}, {low:#x} of them active low: {axes} axes have room for {:#x}",
        (1_u32 << .axes) - 1
    )]
    Inputs {
        /// The row, 2 or 3.
        row: u8,
        /// The inputs that exist, one bit each.
        exist: u8,
        /// Those that are active low.
        low: u8,
        /// Number of axes.
        axes: usize,
    },
    /// A round has too few ticks for the inputs of the rows 2 and 3.
    #[error("a round of {0} ticks: inputs need a round of 4 ticks or more")]
    RoundOfInputs(u32),
    /// There are more latches than [`MAX_LATCHES`].
    #[error("{0} latches: an engine has at most {MAX_LATCHES}")]
    Latches(usize),
    /// A latch is connected to the pin of a switch that the build does not have.
    #[error(
        "latch {number} is connected to axis {axis} of row {row}, where the build has no switch"
    )]
    LatchSource {
        /// Number of the latch.
        number: usize,
        /// The row.
        row: u8,
        /// Number of the axis.
        axis: u8,
    },
    /// The number of looks of a latch is out of range.
    #[error("a latch of {0} looks: 1 to {MAX_LOOKS} can be counted")]
    Looks(u8),
    /// The divider of the PWM is out of range.
    #[error(
        "a PWM of {0} clocks for each of its {PWM_STEPS} steps: 1 to {MAX_PWM_DIVIDER} can be counted"
    )]
    PwmDivider(u32),
    /// No queue of this depth can be built.
    #[error("a queue of {0} segments: 7, 15 and 31 can be built")]
    Queue(usize),
    /// A stop acceleration is 0 or greater than 2^62, above which the ramp could pass any speed in
    /// one tick.
    #[error(
        "the stop acceleration of axis {axis} is {units} x 2^-64 steps per tick^2: from 1 to 2^62 is needed"
    )]
    StopAcceleration {
        /// Number of the axis.
        axis: usize,
        /// The value, in 2^-64 step per tick^2.
        units: u64,
    },
    /// The number of stop accelerations differs from the number of axes.
    #[error("{found} stop accelerations for {axes} axes")]
    StopCount {
        /// Number of axes.
        axes: usize,
        /// Number of stop accelerations.
        found: usize,
    },
}

fn clock_said(least_hz: &Option<u64>) -> String {
    least_hz.map_or_else(|| "a faster clock".to_owned(), |hz| format!("a clock of {hz} Hz"))
}

fn tick_said(least_ns: &Option<u64>) -> String {
    least_ns.map_or_else(|| "a longer tick".to_owned(), |ns| format!("a tick of {ns} ns"))
}

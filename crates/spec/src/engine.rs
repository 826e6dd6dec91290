//! What the engine's two sides must agree on: its schedule, its ports, its queue.
//!
//! The engine works the axes off one after the other, a *turn* of [`TURN`] clocks each:
//!
//! ```text
//! tick     |<------------------------------ C clocks ------------------------------>|
//! turns    | axis 0 | axis 1 | axis 2 | axis 3 | axis 4 | axis 5 |   (nothing)    | |
//! strobe   ________________________________________________________________________/^
//! ```

use crate::build::{AXES, Timebase};
use crate::fault::Faults;
use thiserror::Error;

/// Clocks of one axis in each tick.
pub const TURN: u32 = 13;

/// The clock of a turn in which the axis looks at the `put` port.
pub const PUT_BEAT: u32 = 7;

/// Segments that can wait for an axis, beside the one that runs.
pub const QUEUE: usize = 7;

/// Words that make a segment: ticks less one, then V, A and J, each low half first.
pub const SEGMENT_WORDS: u8 = 7;

/// The word that commits: bit 0 of its data is `last`.
pub const COMMIT: u8 = 7;

/// A tick is too short for the turns of all axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "{axes} axes need {TURN} clocks each and one to close the tick, {needed} in all, but a tick of {tick_ns} ns at \
     {clock_hz} Hz has {clocks}: a clock of {least_hz} Hz, a longer tick or fewer axes would do"
)]
pub struct ScheduleError {
    axes: usize,
    needed: u32,
    clocks: u32,
    tick_ns: u64,
    clock_hz: u64,
    least_hz: u64,
}

/// Whether the turns of all axes fit into a tick.
///
/// # Errors
/// [`ScheduleError`] says what is needed, what there is, and the least clock that would do.
pub fn check_schedule(timebase: &Timebase) -> Result<(), ScheduleError> {
    let needed = AXES as u32 * TURN + 1;
    let clocks = timebase.clocks_per_tick();
    if clocks >= needed {
        return Ok(());
    }
    let (tick_ns, clock_hz) = (timebase.tick_ns(), timebase.clock_hz());
    // As few clocks as hold the turns and divide into phases.
    let least = u64::from(needed.next_multiple_of(timebase.phases()));
    let least_hz = (least * 1_000_000_000).div_ceil(tick_ns);
    Err(ScheduleError { axes: AXES, needed, clocks, tick_ns, clock_hz, least_hz })
}

/// One word of a segment on its way into the queue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Put {
    /// For this axis.
    pub axis: u8,
    /// Which word, or [`COMMIT`].
    pub word: u8,
    /// The word.
    pub data: u32,
}

/// What a host drives in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct EngineInputs {
    /// A word is offered; it stays until it is taken.
    pub put: Option<Put>,
    /// A start of these axes is offered; it stays until it is taken.
    pub start: Option<u8>,
    /// Resume after a fault.
    pub clear: bool,
}

/// What the engine shows in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EngineOutputs {
    /// The offered word is taken in this cycle.
    pub put_ready: bool,
    /// An offered start is taken in this cycle.
    pub start_ready: bool,
    /// STEP pins, bit i is axis i.
    pub step: u8,
    /// DIR pins, 1 is backward.
    pub dir: u8,
    /// All axes are done and no start is armed.
    pub idle: bool,
    /// No new edge rises.
    pub fault: bool,
    /// No axis is added any more.
    pub halted: bool,
    /// What is latched; which axis was too fast or ran dry is told while `halted` only.
    pub faults: Faults,
    /// Axes start at the end of this cycle.
    pub started: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_that_is_too_short_is_refused_with_the_arithmetic() {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        assert_eq!(
            check_schedule(&timebase).unwrap_err().to_string(),
            "6 axes need 13 clocks each and one to close the tick, 79 in all, but a tick of 1000 ns at 48000000 Hz \
             has 48: a clock of 80000000 Hz, a longer tick or fewer axes would do"
        );
        assert!(check_schedule(&Timebase::new(80_000_000, 1000, 16).unwrap()).is_ok());
        assert!(check_schedule(&Timebase::new(48_000_000, 2000, 16).unwrap()).is_ok());
    }
}

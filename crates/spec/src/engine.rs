//! What the engine's two sides must agree on: its schedule, its ports, its queue.
//!
//! The engine works the axes off one after the other, a *turn* of [`TURN`] clocks each:
//!
//! ```text
//! tick     |<------------------------------ C clocks ------------------------------>|
//! turns    | axis 0 | axis 1 | axis 2 | axis 3 | axis 4 | axis 5 |   (nothing)    | |
//! strobe   ________________________________________________________________________/^
//! ```

use crate::build::{MAX_CLOCKS, PinTiming, Timebase};
use crate::tick::Ticks;

mod build;
mod cause;
mod error;
mod figures;

pub use build::{EngineBuild, Guard, Limits};
pub use cause::{CAUSES, Cause};
pub use error::EngineError;
pub use figures::{Between, GuardFigures};

/// Most axes of an engine.
pub const MAX_AXES: usize = 8;

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

/// Most ticks of a round.
pub const MAX_ROUND: u32 = 1024;

/// Most of any figure of the guard that is counted in rounds.
pub const MAX_ROUNDS: u32 = (1 << 12) - 1;

/// Most looks at a limit until it is believed.
pub const MAX_LOOKS: u32 = 127;

/// Clocks that the turns of so many axes take, and the one that closes the tick.
pub const fn clocks_of_turns(axes: usize) -> u32 {
    axes as u32 * TURN + 1
}

/// Fewest clocks of a tick for so many axes in so many phases: the turns fit, and events between the phases.
pub const fn least_clocks(axes: usize, phases: u32) -> u32 {
    let (turns, events) = (clocks_of_turns(axes), phases * MIN_CLOCKS_PER_PHASE);
    if turns > events { turns } else { events }
}

/// Fewest clocks of a phase: in one its events are read, in the others more are written.
pub const MIN_CLOCKS_PER_PHASE: u32 = 2;

/// Whether the turns of all axes fit into a tick, and events between its phases.
///
/// # Errors
/// [`EngineError::Schedule`] says what is needed and what there is, [`EngineError::ShortPhase`] that phases are too many;
/// both the shortest tick and the slowest clock that would do.
pub fn check_schedule(axes: usize, timebase: &Timebase) -> Result<(), EngineError> {
    let needed = clocks_of_turns(axes);
    let (clocks, phases) = (timebase.clocks_per_tick(), timebase.phases());
    let (tick_ns, clock_hz) = (timebase.tick_ns(), timebase.clock_hz());
    let least_tick_ns = Ticks::for_engine(clock_hz, phases, axes);
    let least_hz = Ticks::clock_for_engine(tick_ns, phases, axes);
    if clocks >= needed {
        return match timebase.clocks_per_phase() {
            MIN_CLOCKS_PER_PHASE.. => Ok(()),
            _ => Err(EngineError::ShortPhase { phases, clocks, least_tick_ns, least_hz }),
        };
    }
    Err(EngineError::Schedule { axes, needed, clocks, tick_ns, clock_hz, least_tick_ns, least_hz })
}

/// Whether the timers can count what the drivers of all axes ask for.
///
/// # Errors
/// [`EngineError::PinTiming`] names the first that they cannot.
pub fn check_pins(pins: &[PinTiming]) -> Result<(), EngineError> {
    for (axis, &PinTiming { width, gap, setup, hold }) in pins.iter().enumerate() {
        for (name, clocks) in [("width", width), ("gap", gap), ("setup", setup), ("hold", hold)] {
            if !(1..=MAX_CLOCKS).contains(&clocks) {
                return Err(EngineError::PinTiming { axis, name, clocks });
            }
        }
    }
    Ok(())
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

/// What the host and the machine drive in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct EngineInputs {
    /// A word is offered; it stays until it is taken.
    pub put: Option<Put>,
    /// The axis whose room is asked for while nothing is put.
    pub room_of: u8,
    /// A start of these axes is offered; it stays until it is taken.
    pub start: Option<u8>,
    /// Resume after a stop.
    pub clear: bool,
    /// The host's controlled stop.
    pub stop: bool,
    /// The host has broken the segment protocol.
    pub broken: bool,
    /// The host says anew which axes wait for their limit.
    pub home: Option<u8>,
    /// The host was heard of.
    pub kick: bool,
    /// The host wants the drivers to be powered.
    pub enable: bool,
    /// The e-stop pin, as it is wired.
    pub estop: bool,
    /// The limit pins at the low ends, as they are wired.
    pub limit_min: u8,
    /// The limit pins at the high ends, as they are wired.
    pub limit_max: u8,
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
    /// The drivers are to be powered.
    pub enabled: bool,
    /// All axes are done and no start is armed.
    pub idle: bool,
    /// Why all axes stop, where they do, and the axes that it came from.
    pub fault: Option<(Cause, u8)>,
    /// No axis moves any more.
    pub halted: bool,
    /// A start is armed.
    pub armed: bool,
    /// The drivers have had power for long enough, and shall have it.
    pub ready: bool,
    /// The axes that wait for their limit.
    pub homing: u8,
    /// The axis that says its position because it waits for its limit.
    pub latch: Option<u8>,
    /// Segments that the axis of `put` (or of `room_of`) has room for, where it says so.
    pub room: Option<u8>,
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
            check_schedule(6, &timebase).unwrap_err().to_string(),
            "6 axes need 13 clocks each and one to close the tick, 79 in all, but a tick of 1000 ns at 48000000 Hz \
             has 48: a tick of 2000 ns, a clock of 80000000 Hz or fewer axes would do"
        );
        assert!(check_schedule(6, &Timebase::new(80_000_000, 1000, 16).unwrap()).is_ok());
        assert!(check_schedule(6, &Timebase::new(48_000_000, 2000, 16).unwrap()).is_ok());
    }

    #[test]
    fn a_phase_of_one_clock_is_refused() {
        let timebase = |phases| Timebase::new(16_000_000, 1000, phases).unwrap();
        assert_eq!(
            check_schedule(1, &timebase(16)).unwrap_err().to_string(),
            "16 phases in the 16 clocks of a tick: an engine needs 2 clocks in each; a tick of 2000 ns, a clock of \
             32000000 Hz or fewer phases would do"
        );
        assert!(check_schedule(1, &timebase(4)).is_ok());
    }
}

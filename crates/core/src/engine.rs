//! The definitions that the engine's gateware and its model share: schedule, ports and queue sizes.
//!
//! The engine computes its axes one after the other. Each axis has one time slot of
//! [`TIME_SLOT_CLOCKS`] clocks per tick. The last clock of a tick, the strobe, commits the results
//! of all time slots:
//!
//! ```text
//! tick     |<------------------------------ C clocks ------------------------------>|
//! slots    | axis 0 | axis 1 | axis 2 | axis 3 | axis 4 | axis 5 |   (nothing)    | |
//! strobe   ________________________________________________________________________/^
//! ```

use crate::build::{MAX_CLOCKS, PinTiming, Timebase};
use crate::tick::Ticks;

mod adders;
mod build;
mod cause;
mod commit;
mod error;
mod figures;
mod latch;
mod latches;
mod ports;
mod seek;
mod state;

pub use adders::{Adders, adder_counts};
pub use build::{EngineBuild, Guard, InputRow, LimitWiring};
pub use cause::{CAUSE_BITS, CAUSES, Cause, CauseFacts, StopKind};
pub use commit::{Commit, MAX_PWM_DIVIDER, Outputs, PWM_STEPS};
pub use error::EngineError;
pub use figures::{Between, GuardFigures};
pub use latch::{Latch, LatchSource};
pub use ports::{ENGINE_PORTS, MORE_LATCH_PORTS, engine_ports, is_recorded, ports_of};
pub use seek::SeekSource;
pub use state::{
    AxisStatus, STATE_AXIS_BITS, STATE_ITEM_BITS, STATUS_BITS, SWITCH_LEVEL, SWITCH_STATE,
    StateItem, StatePage, StateWord, StateWords, address as state_address, commanded_steps,
};

pub use crate::schedule::{
    MIN_CLOCKS_PER_PHASE, TIME_SLOT_CLOCKS, clocks_of_adders, clocks_of_time_slots, least_clocks,
    least_clocks_of_adders, time_slots,
};

/// Greatest number of axes of an engine.
pub const MAX_AXES: usize = 8;

/// The clock within a time slot, from 0, in which the axis samples the `put` port.
pub const PUT_BEAT: u32 = 7;

/// Numbers of segments that an axis' queue can hold, not counting the one that runs. An axis has
/// one slot more in memory, a power of two.
pub const QUEUE_DEPTHS: [usize; 3] = [7, 15, 31];

/// Data words of a segment: ticks minus one, then V, A and J, each with its low half first.
pub const SEGMENT_WORDS: u8 = 7;

/// Number of the word that commits a segment to the queue; its data is a [`Commit`].
pub const COMMIT: u8 = 7;

/// Number of a word that belongs to no segment: its data is the slot of the last segment that the
/// next cut keeps in the queue of its axis.
pub const CUT_WORD: u8 = 8;

/// Greatest length of a round, in ticks. The guard samples limits and counts time in rounds.
pub const MAX_ROUND: u32 = 1024;

/// Greatest time, in rounds, that the guard's counters hold.
pub const MAX_ROUNDS: u32 = (1 << 12) - 1;

/// Greatest number of consecutive samples that the debounce of a limit can require.
pub const MAX_DEBOUNCE_SAMPLES: u32 = 127;

/// Greatest number of latches of an engine.
pub const MAX_LATCHES: usize = 4;

/// Greatest number of consecutive ticks for which a latch can require its pin to be active.
pub const MAX_LOOKS: u8 = 16;

/// Rows of switches: limits at the low and at the high ends, and two rows of other inputs.
pub const SWITCH_ROWS: u8 = 4;

/// Checks that the time slots of all axes fit into a tick, and that each phase has room for its
/// events.
///
/// # Errors
/// [`EngineError::Schedule`] says what is needed and what there is, [`EngineError::ShortPhase`]
/// that phases are too many; both the shortest tick and the slowest clock that would do.
pub fn check_schedule(axes: usize, timebase: &Timebase) -> Result<(), EngineError> {
    check_schedule_of_adders(axes, 1, timebase)
}

/// As [`check_schedule`], for an engine with this number of adders, which must be at least 1.
///
/// # Errors
/// As [`check_schedule`].
pub fn check_schedule_of_adders(
    axes: usize,
    adders: usize,
    timebase: &Timebase,
) -> Result<(), EngineError> {
    let needed = clocks_of_adders(axes, adders);
    let (clocks, phases) = (timebase.clocks_per_tick(), timebase.phases());
    let (tick_ns, clock_hz) = (timebase.tick_ns(), timebase.clock_hz());
    let least = least_clocks_of_adders(axes, adders, phases);
    let least_tick_ns = Ticks::of(clock_hz, phases).and_then(|ticks| ticks.shortest(least));
    let least_hz = Ticks::clock_for(tick_ns, phases, least);
    if clocks >= needed {
        return match timebase.clocks_per_phase() {
            MIN_CLOCKS_PER_PHASE.. => Ok(()),
            _ => Err(EngineError::ShortPhase { phases, clocks, least_tick_ns, least_hz }),
        };
    }
    let adders = Adders { adders, axes };
    Err(EngineError::Schedule {
        adders,
        needed,
        clocks,
        tick_ns,
        clock_hz,
        least_tick_ns,
        least_hz,
    })
}

/// Checks that the pin timers can count the times of all axes, 1 to [`MAX_CLOCKS`] clocks.
///
/// # Errors
/// [`EngineError::PinTiming`] names the first time that they cannot.
pub fn check_pins(pins: &[PinTiming]) -> Result<(), EngineError> {
    for (axis, &PinTiming { step_high, step_low, dir_setup, dir_hold }) in pins.iter().enumerate() {
        for (name, clocks) in [
            ("step_high", step_high),
            ("step_low", step_low),
            ("dir_setup", dir_setup),
            ("dir_hold", dir_hold),
        ] {
            if !(1..=MAX_CLOCKS).contains(&clocks) {
                return Err(EngineError::PinTiming { axis, name, clocks });
            }
        }
    }
    Ok(())
}

/// One word of a segment on its way into an axis' queue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Put {
    /// Number of the axis.
    pub axis: u8,
    /// Number of the word, 0 to 6, or [`COMMIT`], or [`CUT_WORD`].
    pub word: u8,
    /// Value of the word.
    pub data: u32,
}

/// Input values of the engine in one clock cycle, from the host's link and from the machine's pins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct EngineInputs {
    /// The word that the host offers, held until the engine accepts it.
    pub put: Option<Put>,
    /// The axis whose free queue space is requested while no word is offered.
    pub room_of: u8,
    /// Mask of the axes whose start is offered, held until the engine accepts it.
    pub start: Option<u8>,
    /// The host requests a cut in all axes for which it has put a [`CUT_WORD`].
    pub cut: bool,
    /// Resume after a stop.
    pub clear: bool,
    /// Stop the engine and return it to its state at configuration.
    pub reset: bool,
    /// The host requests a controlled stop.
    pub stop: bool,
    /// The host has violated the segment protocol.
    pub broken: bool,
    /// New source of seeks, if the host writes one.
    pub seek_source: Option<SeekSource>,
    /// New mask of the axes that wait for the source of their seek, if the host writes one.
    pub seek: Option<u8>,
    /// Mask of the latches that the host arms; bit k is latch k.
    pub latch_arm: u8,
    /// The host requests a snapshot of the state of all axes.
    pub snapshot: bool,
    /// The host has sent a valid request; this restarts the watchdog.
    pub kick: bool,
    /// The host requests power for the drivers.
    pub enable: bool,
    /// Level of the e-stop pin.
    pub estop: bool,
    /// Levels of the limit pins at the low ends; bit i is axis i.
    pub limit_min: u8,
    /// Levels of the limit pins at the high ends; bit i is axis i.
    pub limit_max: u8,
    /// Levels of the pins of the rows 2 and 3 of switches; bit i is input i.
    pub inputs: [u8; 2],
    /// Levels of the latches' pins; bit k is latch k.
    pub latch: u8,
}

impl EngineInputs {
    /// These inputs, with the levels of the pins from `other`.
    #[must_use]
    pub const fn with_pins(self, other: &Self) -> Self {
        let Self { estop, limit_min, limit_max, inputs, latch, .. } = *other;
        Self { estop, limit_min, limit_max, inputs, latch, ..self }
    }

    /// Converts what is active at the pins into their levels, by the polarity of the guard.
    #[must_use]
    pub const fn levels(self, guard: &Guard) -> Self {
        let low = if guard.limits_low { 0xff } else { 0 };
        Self {
            estop: self.estop != guard.estop_low,
            limit_min: self.limit_min ^ low,
            limit_max: self.limit_max ^ low,
            inputs: [self.inputs[0] ^ guard.inputs[0].low, self.inputs[1] ^ guard.inputs[1].low],
            latch: self.latch ^ guard.latches_low(),
            ..self
        }
    }

    /// These levels of pins, with those of the latches that a board connects to other pins.
    #[must_use]
    pub fn with_sources(self, guard: &Guard) -> Self {
        let rows = [self.limit_min, self.limit_max, self.inputs[0], self.inputs[1]];
        let level = |(number, latch): (usize, &Latch)| {
            let level = match latch.source {
                LatchSource::Pin => self.latch >> number,
                LatchSource::Switch { row, axis } => rows[usize::from(row & 3)] >> axis,
            };
            (level & 1) << number
        };
        Self {
            latch: guard.latches.iter().enumerate().map(level).fold(0, |all, bit| all | bit),
            ..self
        }
    }
}

/// Output values of the engine in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EngineOutputs {
    /// The engine accepts the offered word in this cycle.
    pub put_ready: bool,
    /// The engine accepts an offered start in this cycle.
    pub start_ready: bool,
    /// A cut was requested and is not decided yet.
    pub cut_busy: bool,
    /// The last cut was refused.
    pub cut_refused: bool,
    /// Levels of the STEP pins; bit i is axis i.
    pub step: u8,
    /// Levels of the DIR pins; bit i is axis i, 1 is backward.
    pub dir: u8,
    /// Levels of the outputs that change with the motion; bit k is output k, 1 is active.
    pub outputs: u8,
    /// Level of the PWM's pin; true is active.
    pub pwm: bool,
    /// Level of the ENABLE output: the drivers are to have power.
    pub enabled: bool,
    /// All axes have finished and no start is armed.
    pub idle: bool,
    /// The latched stop cause and the mask of the axes that caused it; `None` while no stop is in
    /// force.
    pub fault: Option<(Cause, u8)>,
    /// The stop is complete: no axis moves any more.
    pub halted: bool,
    /// The engine is returning to its state at configuration, after `reset`.
    pub resetting: bool,
    /// A start is armed.
    pub armed: bool,
    /// The drivers have had power for the guard's `enable` time, and the host still requests it.
    pub ready: bool,
    /// Mask of the axes that wait for the source of their seek.
    pub seeking: u8,
    /// Mask of the axes that have hit the source of their seek, until the host ends the seek.
    pub hits: u8,
    /// Mask of the latches that wait for their edge; bit k is latch k.
    pub latch_armed: u8,
    /// Edges since each latch was armed that it did not latch, at most 15.
    pub latch_edges: [u8; MAX_LATCHES],
    /// Number of the record that each latch holds; 0 in a build with at most one latch.
    pub latch_records: [u8; MAX_LATCHES],
    /// The words of state that are output in this cycle, at most one of the axes of each adder.
    pub state: StateWords,
    /// The live words of all axes have been output in this tick; 1 in one cycle of it.
    pub refreshed: bool,
    /// Free queue space, in segments, of the axis of `put` (or of `room_of`), in the cycles in
    /// which that axis reports it.
    pub room: Option<u8>,
    /// Axes start at the end of this cycle.
    pub started: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::ToString as _;

    #[test]
    fn tick_too_short_for_the_time_slots_is_refused_with_the_arithmetic() {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        assert_eq!(
            check_schedule(6, &timebase).unwrap_err().to_string(),
            "6 axes need 13 clocks each and two to close the tick, 80 in all, but a tick of 1000 ns at 48000000 Hz \
             has 48: a tick of 2000 ns, a clock of 80000000 Hz or fewer axes would do"
        );
        assert!(check_schedule(6, &Timebase::new(80_000_000, 1000, 16).unwrap()).is_ok());
        assert!(check_schedule(6, &Timebase::new(48_000_000, 2000, 16).unwrap()).is_ok());
    }

    #[test]
    fn phase_of_one_clock_is_refused() {
        let timebase = |phases| Timebase::new(16_000_000, 1000, phases).unwrap();
        assert_eq!(
            check_schedule(1, &timebase(16)).unwrap_err().to_string(),
            "16 phases in the 16 clocks of a tick: an engine needs 2 clocks in each; a tick of 2000 ns, a clock of \
             32000000 Hz or fewer phases would do"
        );
        assert!(check_schedule(1, &timebase(4)).is_ok());
    }
}

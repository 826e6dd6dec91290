//! The engine with everything built in, whose mutants are those of the modules that the shipped
//! machine does not have, and its recordings.

mod cuts;
mod inputs;
mod latch;
mod outputs;
mod seeks;

use super::{SEED, Stimulus, drawn, kinds};
use crate::engine_programs;
use carrystep_core::engine::{Guard, InputRow, Latch, LimitWiring, Outputs};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_simulators::engine::{Event, Events};

/// Clocks of a round of this build.
const ROUND: u64 = 8 * super::cruise::TICK;

/// A clock in which the drivers have been powered for long enough and a first move of all axes
/// has begun.
const THEN: u64 = 9_000;

/// Number of random programs.
const BY_CHANCE: usize = 24;

/// Ticks of 2 us at 48 MHz, with outputs and a PWM, cuts, inputs in both rows with probe and
/// interlock, and the latch. Of each row and of the outputs some are missing, and some are active
/// low. Rounds are short, so that a switch is debounced in few clocks.
///
/// The pin timings are slow: a step in every other tick is held back for ever longer, until one is
/// due in the very clock in which the one before it rises. A pulse is longer than a tick, and a
/// step after a reversal comes more than two ticks late.
pub(super) fn build() -> EngineBuild {
    let timebase = Timebase::new(48_000_000, 2000, 16).expect("a fine timebase");
    let pins = std::array::from_fn(|axis| {
        let axis = axis as u32;
        PinTiming {
            step_high: 131 + 7 * axis,
            step_low: 73 - 7 * axis,
            dir_setup: 230 + 10 * axis,
            dir_hold: 60 + 11 * axis,
        }
    });
    let build = Build { timebase, phase: StartPhase::Half, pins };
    let mut build = EngineBuild::minimal(&build, 1);
    build.cuts = true;
    build.outputs = Outputs { exist: 0xb7, pwm_divider: 3, off_at_ramps: true };
    build.guard = Guard {
        round: 8,
        debounce: 3,
        enable: 2,
        limits: LimitWiring::Pair,
        inputs: [InputRow { exist: 0x37, low: 0x15 }, InputRow { exist: 0x2b, low: 0x09 }],
        latches: vec![Latch::of_pin(true, 3)],
        ..Guard::minimal((0..AXES as u64).map(|axis| (1 << 53) + (axis << 50)).collect())
    };
    build
}

/// All recordings, in the order of use.
pub(super) fn all(build: &EngineBuild) -> Vec<Stimulus> {
    let chance = drawn(&engine_programs::program(AXES), BY_CHANCE);
    let chance = (1..).zip(chance).map(|(number, (program, events))| {
        Stimulus::new(build, format!("random program {number}"), &program, &events)
    });
    let mut all = outputs::all(build);
    all.extend(cuts::all(build));
    all.extend(latch::all(build));
    all.extend(inputs::all(build));
    all.extend(seeks::all(build));
    all.extend(kinds::all(build));
    all.extend(chance);
    all
}

/// A fixed sequence of numbers without a pattern, by SplitMix64.
fn numbers() -> impl Iterator<Item = u64> {
    let mut state = SEED;
    std::iter::repeat_with(move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    })
}

/// The events in the order of their clocks.
fn sorted(mut events: Events) -> Events {
    events.sort_by_key(|(cycle, _)| *cycle);
    events
}

/// The switches of a row that are active.
const fn switches(row: u8, active: u8) -> Event {
    match row {
        0 => Event::LimitMin(active),
        1 => Event::LimitMax(active),
        2 => Event::Inputs0(active),
        _ => Event::Inputs1(active),
    }
}

//! Builds of the engine for random programs: of any number of axes, latches and adders, with a guard
//! whose times are so short that all of its functions occur.

use crate::lockstep;
use crate::programs::all;
use carrystep_core::engine::{Guard, InputRow, Latch, LimitWiring, Outputs, QUEUE_DEPTHS};
use carrystep_core::{AXES, Build, EngineBuild, StartPhase, Timebase};

/// A build with a tick of 1 us. The pin timings are as different as in the other rungs, and two of
/// them are too slow for a step in every other tick. Ramps take ten to some hundred ticks. The
/// guard's rounds are so short that all of its functions occur. The depth of the queues depends on
/// the number of axes; it is the least for three and six.
pub fn build(
    axes: usize,
    clock_hz: u64,
    phases: u32,
    phase: StartPhase,
    limits: LimitWiring,
) -> EngineBuild {
    let timebase = Timebase::new(clock_hz, 1000, phases).expect("a fine timebase");
    let mut build = Build { timebase, ..lockstep::tight_build(phases, phase) };
    build.pins[3].step_low = 237;
    build.pins[5].dir_hold = 221;
    let mut build = EngineBuild::minimal(&build, 1);
    build.pins = build.pins.iter().copied().cycle().take(axes).collect();
    let low = limits == LimitWiring::Pair;
    let all = InputRow { exist: all(axes), low: 0 };
    build.queue = QUEUE_DEPTHS[axes % QUEUE_DEPTHS.len()];
    build.cuts = true;
    // A period of the PWM has fewer clocks than a program.
    build.outputs = Outputs { exist: 0xff, pwm_divider: 2, off_at_ramps: low };
    build.guard = Guard {
        round: 4,
        inputs: [all; 2],
        latches: vec![Latch::of_pin(false, 2)],
        debounce: 3,
        watchdog: 40,
        enable: 2,
        limits,
        limit_freezes: limits == LimitWiring::Each,
        ..Guard::minimal((0..axes).map(|axis| 1 << (52 + 2 * (axis % AXES))).collect())
            .active_low(low)
    };
    build
}

/// Four sets of parameters of the engine of six axes and 16 phases, which is one text of Verilog.
/// Each differs from the first in every parameter but the second's e-stop and limits.
pub fn parameter_sets() -> [EngineBuild; 4] {
    let first = build(AXES, 80_000_000, 16, StartPhase::Half, LimitWiring::Pair);
    let second = build(AXES, 96_000_000, 16, StartPhase::Zero, LimitWiring::Pair);
    let mut third = build(AXES, 112_000_000, 16, StartPhase::Zero, LimitWiring::Each);
    third.guard = Guard {
        round: 8,
        debounce: 1,
        watchdog: 0,
        enable: 0,
        inputs: [InputRow { exist: 0x2d, low: 0x09 }, InputRow { exist: 0x33, low: 0x33 }],
        latches: vec![Latch::of_pin(true, 16)],
        ..third.guard
    };
    third.outputs = Outputs { exist: 0xa5, pwm_divider: 1, off_at_ramps: false };
    third.pins.reverse();
    third.guard.stop.reverse();
    let mut fourth = build(AXES, 128_000_000, 16, StartPhase::Zero, LimitWiring::One);
    fourth.guard = Guard {
        round: 16,
        debounce: 5,
        watchdog: 21,
        enable: 7,
        inputs: [InputRow { exist: 0x3f, low: 0x3e }, InputRow { exist: 0x01, low: 0x01 }],
        latches: vec![Latch::of_pin(true, 1)],
        ..fourth.guard
    };
    fourth.cuts = false;
    fourth.outputs = Outputs { exist: 0x00, pwm_divider: 0, off_at_ramps: true };
    fourth.pins.rotate_left(2);
    fourth.guard.stop = (1..=AXES as u64).map(|axis| (axis << 53) - 1).collect();
    [first, second, third, fourth]
}

/// The same build with this number of latches, at most four, with different looks.
pub fn with_latches(mut build: EngineBuild, count: usize) -> EngineBuild {
    let looks = [2, 2, 1, 5];
    let low = build.guard.latches.iter().any(|latch| latch.low);
    let latch = |(number, looks): (usize, &u8)| Latch::of_pin(low != (number == 2), *looks);
    build.guard.latches = looks.iter().enumerate().take(count).map(latch).collect();
    build
}

/// The same build on this number of adders.
pub fn on_adders(build: EngineBuild, adders: usize) -> EngineBuild {
    EngineBuild { adders, ..build }
}

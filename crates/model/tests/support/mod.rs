//! Random engines, and a random host that uses every input of an engine.
#![allow(dead_code, reason = "each test uses a part of it")]
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

pub mod books;
pub mod host;
pub mod random;
pub mod script;
pub mod words;

use carrystep_core::engine::{InputRow, Latch, LimitWiring};
use carrystep_core::{Build, EngineBuild, PinTiming, StartPhase, Timebase};
use random::Random;

/// An engine of one to eight axes with random pins and a random guard.
pub fn build(random: &mut Random) -> EngineBuild {
    let (clock_hz, most) = random.one_of(&[(48_000_000, 3), (80_000_000, 6), (112_000_000, 8)]);
    let timebase = Timebase::new(clock_hz, 1000, random.one_of(&[1, 4, 16])).unwrap();
    let phase = random.one_of(&[StartPhase::Half, StartPhase::Zero]);
    let build = Build { timebase, phase, pins: [PinTiming::SHORTEST; carrystep_core::AXES] };
    let mut build = EngineBuild::minimal(&build, 1);
    let axes = 1 + random.below(most) as usize;
    // Some axes have times that hold steps back, and discard some by overruns.
    let slow = random.one_of(&[1, 20, 150, 150, 700]);
    let pins = |random: &mut Random| {
        let [step_high, step_low, dir_setup, dir_hold] =
            [slow; 4].map(|most| 1 + random.below(most) as u32);
        PinTiming { step_high, step_low, dir_setup, dir_hold }
    };
    build.pins = (0..axes).map(|_| pins(random)).collect();
    let guard = &mut build.guard;
    guard.round = random.one_of(&[2, 4, 16]);
    guard.debounce = 1 + random.below(3) as u32;
    guard.watchdog = random.one_of(&[0, 0, 40]);
    guard.enable = random.below(3) as u32;
    guard.limits = random.one_of(&[
        LimitWiring::None,
        LimitWiring::Pair,
        LimitWiring::Pair,
        LimitWiring::Each,
        LimitWiring::One,
    ]);
    guard.limit_freezes = random.below(2) == 0;
    guard.estop_low = random.below(2) == 0;
    guard.limits_low = random.below(2) == 0;
    let exist = ((1_u16 << axes) - 1) as u8;
    guard.inputs = [(); 2].map(|()| {
        // A row without inputs is not sampled.
        let exist = random.next() as u8 & exist & random.one_of(&[0, u8::MAX]);
        InputRow { exist, low: random.next() as u8 & exist }
    });
    if guard.inputs != [InputRow::default(); 2] {
        guard.round = guard.round.max(4);
    }
    let latch = Latch::of_pin(random.below(2) == 0, random.one_of(&[1, 2, 5, 16]));
    guard.latches = random.one_of(&[None, Some(latch)]).into_iter().collect();
    guard.stop = (0..axes).map(|_| 1 << (54 + random.below(7))).collect();
    build.check().unwrap();
    build
}

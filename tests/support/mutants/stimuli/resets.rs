//! Stimuli with resets: in motion, during a stop, while limits and a seek are active, held for some
//! ticks, and in the middle of a segment. Further ones number the words of a segment wrongly.

use super::Stimulus;
use super::cruise::{ROUND, THEN, TICK, again, both_ways, cruise};
use carrystep_core::engine::SeekSource;
use carrystep_core::{AXES, Command, EngineBuild, Program, Segment};
use carrystep_simulators::engine::{Event, Events};

/// Samples of a limit that are enough to debounce it.
const SAMPLES: u64 = 8;

pub(super) fn all(build: &EngineBuild) -> Vec<Stimulus> {
    let mut all = vec![
        reset(build, "reset in motion", THEN, 1),
        reset(build, "reset held for some ticks", THEN + 17, 6 * TICK + 5),
        reset(build, "reset at a strobe", THEN / TICK * TICK + TICK - 1, 1),
        reset(build, "reset while segments are put", 2_011, 1),
        twice(build),
        during_a_clear(build),
        with_discarded_steps(build),
        of_a_seek(build),
        of_the_limits(build),
        of_a_count(build),
        of_silence(build),
    ];
    all.extend((0..8).flat_map(|word| [1, 2, 4].map(|mask| wrong_word(build, word, mask))));
    all
}

/// A reset in a move of all axes; then a move in the other direction.
fn reset(build: &EngineBuild, name: &str, at: u64, clocks: u64) -> Stimulus {
    let first = cruise(400, both_ways((1 << 60) + 12_345));
    let program = [first, again(30_000), again(10_000)].concat();
    Stimulus::new(build, name, &program, &pulse(at, clocks))
}

/// The input `reset` is asserted for this number of clocks.
fn pulse(at: u64, clocks: u64) -> Events {
    vec![(at, Event::Reset(true)), (at + clocks, Event::Reset(false))]
}

/// A second reset begins in each stage of the first one, with the e-stop pressed.
fn twice(build: &EngineBuild) -> Stimulus {
    let first = cruise(1_500, both_ways(1 << 58));
    let mut events = vec![(THEN - 3 * TICK, Event::EStop(true))];
    events.extend((0..8).flat_map(|place| pulse(THEN + place * (7 * TICK + 19), 1)));
    events.push((THEN + 70 * TICK, Event::EStop(false)));
    events.extend(pulse(THEN + 90 * TICK, 1));
    Stimulus::new(build, "resets one after the other", &[first, again(40_000)].concat(), &events)
}

/// Resets in the clocks in which a stop is cleared.
fn during_a_clear(build: &EngineBuild) -> Stimulus {
    let dry = Segment { ticks: 20, v: 1 << 50, a: 0, j: 0, last: false };
    let mut program = Program::new();
    for _ in 0..6 {
        program.push(Command::Segment { axis: 3, segment: dry });
        program.extend([
            Command::Start { mask: 8 },
            Command::Wait { clocks: 9_000 },
            Command::Clear,
        ]);
    }
    let quiet = Stimulus::new(build, "clears", &program, &Events::new()).recording;
    let cleared = quiet
        .outputs
        .windows(2)
        .filter(|pair| pair[0].1.fault.is_some() && pair[1].1.fault.is_none());
    let events = cleared.take(1).flat_map(|pair| pulse(pair[1].0 - TICK / 2, 1)).collect();
    Stimulus::new(build, "a reset in the tick of a clear", &program, &events)
}

/// An axis is faster than its driver allows; the reset follows the stop, and forgets the discarded
/// steps.
fn with_discarded_steps(build: &EngineBuild) -> Stimulus {
    let near = (1 << 62) - (1 << 57);
    let speeds = [near, 1 << 58, -(1 << 62), 1 << 62, -(1 << 62), 1 << 62, 0];
    let mut program = Program::new();
    for axis in 0..AXES as u8 {
        for v in speeds {
            let segment =
                Segment { ticks: if v == near { 2 } else { 1 }, v, a: 0, j: 0, last: false };
            program.push(Command::Segment { axis, segment });
        }
    }
    program.extend([Command::Start { mask: 0x3f }, Command::Wait { clocks: 20_000 }]);
    let alone = Stimulus::new(build, "overruns", &program, &Events::new()).recording;
    let stopped = alone.outputs.iter().find(|(_, outputs)| outputs.fault.is_some());
    let at = stopped.map_or(THEN, |(cycle, _)| *cycle);
    let stimulus = Stimulus::new(build, "a reset of discarded steps", &program, &pulse(at + 5, 1));
    let losses = |recording: &[[u32; 4]]| recording.iter().map(|[.., lost]| lost).sum::<u32>();
    assert!(losses(&alone.kept) > 0, "steps are discarded");
    assert_eq!(losses(&stimulus.recording.kept), 0, "the reset forgets them");
    stimulus
}

/// Axes that wait for a source when the reset comes do not wait after it.
fn of_a_seek(build: &EngineBuild) -> Stimulus {
    let program = [cruise(700, both_ways(1 << 54)), again(30_000)].concat();
    let source = SeekSource { axis: 0, row: 0, own: true, level: true };
    let mut events = vec![(THEN - 901, Event::SeekSource(source)), (THEN - 900, Event::Seek(0x2d))];
    events.extend(pulse(THEN, 1));
    events
        .extend([(THEN + 2 * TICK + 50, Event::Seek(0x3f)), (THEN + 40 * TICK, Event::Seek(0x12))]);
    events.extend(pulse(THEN + 60 * TICK, 3 * TICK));
    Stimulus::new(build, "a reset of axes that seek", &program, &events)
}

/// All limits are active, and become inactive just before the reset: the engine forgets them at
/// once, so that the axes may move towards them.
fn of_the_limits(build: &EngineBuild) -> Stimulus {
    let at = THEN + 2 * SAMPLES * ROUND;
    let mut events = vec![(1, Event::LimitMin(0x2b)), (1, Event::LimitMax(0x35))];
    events.extend([(at - 100, Event::LimitMin(0)), (at - 100, Event::LimitMax(0))]);
    events.extend(pulse(at, 1));
    let wait = vec![Command::Wait { clocks: at as u32 + 5_000 }];
    let program = [wait, cruise(300, both_ways(1 << 54)), cruise(300, both_ways(-(1 << 54)))];
    Stimulus::new(build, "a reset of active limits", &program.concat(), &events)
}

/// All limits become active some samples before the reset and stay so: after it they are counted
/// from the beginning.
fn of_a_count(build: &EngineBuild) -> Stimulus {
    let at = THEN;
    let begin = at - (SAMPLES - 3) * ROUND;
    let mut events = vec![(begin, Event::LimitMin(0x3f)), (begin, Event::LimitMax(0x3f))];
    events.extend(pulse(at, 1));
    let program = [vec![Command::Wait { clocks: at as u32 }], cruise(900, both_ways(1 << 54))];
    Stimulus::new(build, "a reset of limits that are counted", &program.concat(), &events)
}

/// The host is silent; the reset comes just before the watchdog would expire.
fn of_silence(build: &EngineBuild) -> Stimulus {
    let at = u64::from(build.guard.watchdog - 2) * ROUND;
    let segment = Segment { ticks: 9, v: 1 << 60, a: 0, j: 0, last: true };
    let wait = vec![Command::Wait { clocks: at as u32 + 9_000 }];
    let waits = vec![Command::Segment { axis: 1, segment }, Command::Wait { clocks: 90_000 }];
    Stimulus::new(build, "a reset in the silence", &[wait, waits].concat(), &pulse(at, 1))
        .only_for(&["supervisor", "resets", "engine"])
}

/// The host numbers one word of a segment wrongly; after the clear it puts the segment again.
fn wrong_word(build: &EngineBuild, word: u64, mask: u8) -> Stimulus {
    let axis = (word % AXES as u64) as u8;
    let segment = Segment { ticks: 9, v: 1 << 60, a: 0, j: 0, last: true };
    let program = [
        Command::Wait { clocks: 5 * TICK as u32 },
        Command::Segment { axis, segment },
        Command::Wait { clocks: 10 * TICK as u32 },
        Command::Clear,
        Command::Segment { axis, segment },
        Command::Wait { clocks: 10 * TICK as u32 },
    ];
    // An axis takes one word in a tick.
    let at = (5 + word) * TICK;
    let events = vec![(at, Event::WordError(mask)), (at + TICK, Event::WordError(0))];
    let name = format!("word {word} with the number {}", word as u8 ^ mask);
    let stimulus = Stimulus::new(build, name, &program.to_vec(), &events);
    let faults = stimulus.recording.outputs.iter().filter(|(_, outputs)| outputs.fault.is_some());
    assert!(faults.count() > 0, "a wrong number is a fault");
    stimulus.only_for(&["queue", "control", "engine", "stops"])
}

//! Recordings of the switches of all rows, of the interlock, and of resets while they are active.

use super::super::Stimulus;
use super::super::cruise::{TICK, both_ways, cruise};
use super::{ROUND, THEN, numbers, sorted, switches};
use carrystep_core::engine::SWITCH_ROWS;
use carrystep_core::{AXES, Command, EngineBuild, Program};
use carrystep_simulators::engine::{Event, Events};

pub(super) fn all(build: &EngineBuild) -> Vec<Stimulus> {
    vec![
        each_alone(build),
        by_chance(build),
        interlock(build),
        not_the_interlock(build),
        resets(build),
    ]
}

/// The host does nothing for so many clocks.
fn wait(clocks: u64) -> Program {
    vec![Command::Wait { clocks: clocks as u32 }]
}

/// Each switch is active alone: for one sample less than the debouncer takes, then for one more.
fn each_alone(build: &EngineBuild) -> Stimulus {
    let mut events = Events::new();
    let mut at = ROUND;
    for (row, axis) in (0..SWITCH_ROWS).flat_map(|row| (0..AXES).map(move |axis| (row, axis))) {
        for rounds in [2, 4] {
            events.push((at, switches(row, 1 << axis)));
            events.push((at + rounds * ROUND, switches(row, 0)));
            at += (rounds + 1) * ROUND;
        }
        at += 3 * ROUND;
    }
    Stimulus::new(build, "each switch", &wait(at), &sorted(events))
}

/// All switches change by chance, in any clock; most of them stay for a few rounds.
fn by_chance(build: &EngineBuild) -> Stimulus {
    let mut numbers = numbers();
    let mut next = || numbers.next().unwrap_or_default();
    let mut events = Events::new();
    for round in 1..120 {
        for row in 0..SWITCH_ROWS {
            // The interlock has its own recordings.
            let all = if row == 3 { 0x3e } else { 0x3f };
            if next() % 3 == 0 {
                events.push((round * ROUND + next() % ROUND, switches(row, next() as u8 & all)));
            }
        }
    }
    Stimulus::new(build, "switches by chance", &wait(130 * ROUND), &sorted(events))
}

/// The interlock opens for too short a time, then in a move, then while it holds a clear back, at
/// rest, and in a reset.
fn interlock(build: &EngineBuild) -> Stimulus {
    let moves = || cruise(300, both_ways(1 << 57));
    let clear = |ticks: u64| [wait(ticks * TICK), vec![Command::Clear]].concat();
    let program = [moves(), clear(200), moves(), clear(500), moves(), clear(200), moves()].concat();
    let mut events = Events::new();
    let open = |at: u64, rounds: u64| {
        [(at, Event::Inputs1(0x2b)), (at + rounds * ROUND, Event::Inputs1(0x2a))]
    };
    for (at, rounds) in [(0, 2), (5, 6), (40, 90), (190, 5), (240, 2), (250, 9), (270, 30)] {
        events.extend(open(THEN + at * ROUND, rounds));
    }
    for at in [255, 290, 305] {
        let at = THEN + at * ROUND;
        events.extend([(at, Event::Reset(true)), (at + 3 * TICK, Event::Reset(false))]);
    }
    Stimulus::new(build, "interlock", &program, &sorted(events))
}

/// Every input but the interlock becomes active in a move, and with them the limits from which the
/// axes move away: nothing stops.
fn not_the_interlock(build: &EngineBuild) -> Stimulus {
    let program = cruise(500, both_ways(1 << 57));
    let events = vec![
        (THEN, Event::Inputs0(0x3f)),
        (THEN, Event::LimitMin(0x15)),
        (THEN, Event::LimitMax(0x2a)),
        (THEN + 10 * ROUND, Event::Inputs0(0)),
        (THEN + 12 * ROUND, Event::Inputs1(0x3e)),
        (THEN + 20 * ROUND, Event::Inputs1(0)),
        (THEN + 22 * ROUND, Event::LimitMin(0)),
        (THEN + 24 * ROUND, Event::LimitMax(0)),
    ];
    let stimulus = Stimulus::new(build, "inputs that stop nothing", &program, &events);
    let stopped =
        |(_, outputs): &(u64, carrystep_core::engine::EngineOutputs)| outputs.fault.is_some();
    assert!(!stimulus.recording.outputs.iter().any(stopped), "nothing stops");
    stimulus
}

/// Resets in every tick of a round while all switches are active or are counted: they are inactive
/// after it, and their counts begin anew, whichever row was sampled when the reset came.
fn resets(build: &EngineBuild) -> Stimulus {
    let mut events = Events::new();
    for number in 0..16 {
        let at = number * 20 * ROUND + ROUND;
        let end = at + 8 * ROUND + number * (TICK + 5);
        // Every second time the switches have only been counted.
        let begins = if number % 2 == 0 { at } else { end - 2 * ROUND };
        for row in 0..SWITCH_ROWS {
            let active = if row == 3 { 0x3e } else { 0x3f };
            events.push((begins, switches(row, active)));
            // They become inactive with the reset, or stay active for some rounds.
            let ends = if number % 4 < 2 { end } else { end + 5 * ROUND };
            events.push((ends, switches(row, 0)));
        }
        let length = if number % 3 == 0 { 4 * TICK } else { 1 };
        events.extend([(end, Event::Reset(true)), (end + length, Event::Reset(false))]);
    }
    Stimulus::new(build, "resets of all switches", &wait(330 * ROUND), &sorted(events))
}

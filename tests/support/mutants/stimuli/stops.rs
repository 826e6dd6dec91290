//! Stimuli with everything that stops the engine: each cause alone, and (in [`coincidences`]) in
//! the same clock as something else.

use super::cruise::{ROUND, THEN, again, both_ways, cruise};
use super::{Stimulus, coincidences};
use carrystep_core::engine::{EngineOutputs, SeekSource};
use carrystep_core::{AXES, Command, EngineBuild, Program, Segment};
use carrystep_simulators::engine::{Event, Events};

/// The modules on the path from a limit switch to the stop.
const GUARDS: [&str; 8] = [
    "switches",
    "switch_memory",
    "seek_control",
    "edge_latch",
    "stops",
    "supervisor",
    "time_slot",
    "engine",
];

pub(super) fn all(build: &EngineBuild) -> Vec<Stimulus> {
    let mut all = vec![
        e_stop(build),
        stop(build, "stop", &[]),
        stop(
            build,
            "stop, then e-stop",
            &[(20_000, Event::EStop(true)), (24_000, Event::EStop(false))],
        ),
    ];
    all.extend((0..AXES).map(|axis| overrun(build, axis)));
    for axis in 0..AXES {
        let ends = [(false, false), (false, true), (true, false), (true, true)];
        all.extend(ends.map(|(max, others)| limit(build, axis, max, others)));
    }
    all.extend([nonsense(build), dry(build)]);
    all.extend(coincidences::starts_that_stop(build));
    all.extend(coincidences::two_causes(build));
    all.push(bounces(build));
    all.push(seeks(build));
    all.extend((0..AXES).map(|axis| coincidences::last_step(build, axis)));
    all.push(silence(build));
    all
}

/// The e-stop is pressed for less than a tick, then for longer, then again during the clear.
fn e_stop(build: &EngineBuild) -> Stimulus {
    let program =
        [cruise(400, both_ways((1 << 60) + 12_345)), again(30_000), again(10_000)].concat();
    let presses = [(60_000, 100), (62_010, 90), (THEN, 3_000), (96_000, 10_000)];
    let events = presses
        .into_iter()
        .flat_map(|(at, clocks)| [(at, Event::EStop(true)), (at + clocks, Event::EStop(false))]);
    Stimulus::new(build, "e-stop", &program, &events.collect())
}

/// The host stops all axes; the events `later` follow the given numbers of clocks after it.
fn stop(build: &EngineBuild, name: &str, later: &[(u64, Event)]) -> Stimulus {
    let program = [cruise(1_500, both_ways(1 << 55)), again(20_000)].concat();
    let mut events = vec![(THEN, Event::Stop(true)), (THEN + 1, Event::Stop(false))];
    events.extend(later.iter().map(|(clocks, event)| (THEN + clocks, *event)));
    Stimulus::new(build, name, &program, &events)
}

/// An axis reverses twice with a step in every tick, which is faster than its driver allows. A
/// driver that allows it gets two steps per tick.
fn overrun(build: &EngineBuild, axis: usize) -> Stimulus {
    let segment = |(ticks, v)| Segment { ticks, v, a: 0, j: 0, last: false };
    let near = (1 << 62) - (1 << 57);
    let turns: [(u32, i64); 7] = [
        (2, near),
        (1, 1 << 58),
        (1, -(1 << 62)),
        (1, 1 << 62),
        (1, -(1 << 62)),
        (1, 1 << 62),
        (1, 0),
    ];
    let mut program = Program::new();
    for back in [false, true] {
        for (ticks, v) in turns {
            // Backward, a step occurs just below the boundary and not at it.
            let back_to = if v == 1 << 58 { -v - 1 } else { -v };
            let segment = segment((ticks, if back { back_to } else { v }));
            program.push(Command::Segment { axis: axis as u8, segment });
        }
        program.extend([
            Command::Start { mask: 1 << axis },
            Command::Wait { clocks: 4_000 },
            Command::Clear,
        ]);
    }
    Stimulus::new(build, format!("overrun of axis {axis}"), &program, &Events::new())
}

/// An axis moves onto a switch, from which it may move back. All other axes stand on their switches
/// and move away, or have none.
fn limit(build: &EngineBuild, axis: usize, max: bool, others: bool) -> Stimulus {
    let on = if max { 1 << 54 } else { -(1 << 54) };
    let mut v = if others { [-on; AXES] } else { both_ways(1 << 54) };
    v[axis] = on;
    let program = [cruise(900, v), vec![Command::Wait { clocks: 62_000 }, Command::Clear]].concat();
    let back = if others { [-on; AXES] } else { v.map(|v| -v) };
    let program = [program, cruise(70, back)].concat();
    let switch = |mask| if max { Event::LimitMax(mask) } else { Event::LimitMin(mask) };
    let events =
        vec![(THEN, switch(if others { 0x3f } else { 1 << axis })), (THEN + 75_000, switch(0))];
    let (end, others) =
        (if max { "high" } else { "low" }, if others { ", the others' too" } else { "" });
    Stimulus::new(
        build,
        format!("limit of axis {axis} at its {end} end{others}"),
        &program,
        &events,
    )
    .only_for(&GUARDS)
}

/// All switches bounce, each time for one sample less than the debounce count. Then they become
/// active and later inactive, with bounces.
fn bounces(build: &EngineBuild) -> Stimulus {
    let mut events = Events::new();
    for (at, samples) in [(1, 7), (10, 7), (20, 4), (26, 7), (34, 12), (48, 7)] {
        let at = at * ROUND;
        events.extend([(at, Event::LimitMin(0x2d)), (at, Event::LimitMax(0x1b))]);
        events.extend([
            (at + samples * ROUND, Event::LimitMin(0)),
            (at + samples * ROUND, Event::LimitMax(0)),
        ]);
    }
    let program = [cruise(4_000, both_ways(1 << 55)), again(20_000)].concat();
    Stimulus::new(build, "limits that bounce", &program, &events).only_for(&GUARDS)
}

/// The host selects every set of axes. Then the odd axes seek their low ends and hit them one after
/// the other while segments are in their queues, and after them the even axes their high ends.
fn seeks(build: &EngineBuild) -> Stimulus {
    let mut events: Events =
        (0..64).map(|axes: u8| (100 * u64::from(axes), Event::Seek(axes))).collect();
    let source = |row| Event::SeekSource(SeekSource { axis: 0, row, own: true, level: true });
    events.extend([(6_400, source(0)), (6_500, Event::Seek(0b10_1010))]);
    let (mut low, mut high) = (0, 0);
    // A hit comes eight to ten rounds after its switch has closed. The odd axes rest before the source
    // changes: their closed switches would stop them otherwise.
    for (place, axis) in [(0, 1), (1, 3), (2, 5), (5, 0), (6, 2), (7, 4)] {
        let at = THEN + 12 * ROUND * place;
        if axis == 0 {
            events.extend([(at - ROUND, source(1)), (at - ROUND, Event::Seek(0b01_0101))]);
        }
        let end = if axis % 2 == 0 { &mut high } else { &mut low };
        *end |= 1 << axis;
        events.extend([(at, Event::LimitMin(low)), (at, Event::LimitMax(high))]);
    }
    events.extend([(120 * ROUND, Event::LimitMin(0)), (120 * ROUND, Event::LimitMax(0))]);
    // As long as the host does not end the seek, no axis that has hit can be started.
    events.push((125 * ROUND, Event::Seek(0)));
    let row = |ticks, last| {
        let segment = move |v| Segment { ticks, v, a: 0, j: 0, last };
        (0..)
            .zip(both_ways(1 << 54))
            .map(move |(axis, v)| Command::Segment { axis, segment: segment(v) })
    };
    let mut program: Program =
        row(3_000, false).chain(row(3_000, false)).chain(row(3_000, true)).collect();
    program.extend([Command::Start { mask: 0x3f }, Command::Wait { clocks: 900_000 }]);
    program.extend(cruise(40, both_ways(-(1 << 59))));
    let stimulus = Stimulus::new(build, "seeks", &program, &events);
    let met = |(_, outputs): &(u64, EngineOutputs)| outputs.seeking == 0 && outputs.fault.is_none();
    assert!(stimulus.recording.outputs.last().is_some_and(met), "all axes hit their limits");
    stimulus
}

/// Commands that a host must not send.
fn nonsense(build: &EngineBuild) -> Stimulus {
    let stray = |axis| Command::Segment {
        axis,
        segment: Segment { ticks: 1, v: 0, a: 0, j: 0, last: true },
    };
    let clear = [Command::Wait { clocks: 1_000 }, Command::Clear];
    let mut program: Program =
        [vec![stray(6)], clear.to_vec(), vec![stray(7)], clear.to_vec()].concat();
    // All queues are filled, then all axes but one are started, then each axis alone with an empty
    // queue.
    program.extend((0..7 * 6).map(|place| stray(place % 6)));
    program.extend([Command::Start { mask: 0x2f }, Command::Wait { clocks: 2_000 }]);
    for axis in [0, 1, 2, 3, 5] {
        program.extend([
            Command::Start { mask: 1 << axis },
            Command::Wait { clocks: 2_000 },
            Command::Clear,
        ]);
    }
    program.extend([Command::Start { mask: 0 }, stray(7)]);
    program.extend(clear);
    Stimulus::new(build, "nonsense", &program, &Events::new())
}

/// Each axis runs dry in its own tick, at its own speed, with an acceleration.
fn dry(build: &EngineBuild) -> Stimulus {
    let mut program = Program::new();
    for first in 0..6 {
        for axis in 0..6 {
            let v = if (axis + first) % 2 == 0 { 1 << 52 } else { -(1 << 52) };
            let ticks = if axis == first { 60 } else { 80 + u32::from(axis) };
            let segment = Segment { ticks, v, a: v >> 8, j: -(v >> 16), last: axis > first };
            program.push(Command::Segment { axis, segment });
        }
        program.extend([
            Command::Start { mask: 0x3f },
            Command::Wait { clocks: 20_000 },
            Command::Clear,
        ]);
    }
    Stimulus::new(build, "dry queues", &program, &Events::new())
}

/// The host kicks once and then falls silent while a segment waits.
fn silence(build: &EngineBuild) -> Stimulus {
    let rounds = u64::from(build.guard.watchdog);
    let heard = 3 * ROUND + 1_000;
    let missed = heard + (rounds + 3) * ROUND;
    let waits = Command::Segment {
        axis: 2,
        segment: Segment { ticks: 9, v: 1 << 60, a: 0, j: 0, last: true },
    };
    let program = vec![
        waits,
        Command::Wait { clocks: missed as u32 },
        Command::Clear,
        Command::Wait { clocks: 1_000 },
        waits,
    ];
    let program = [program, again(2_000), again(9_000)].concat();
    Stimulus::new(
        build,
        "silence",
        &program,
        &vec![(heard, Event::Kick), (missed + 8_000, Event::Kick)],
    )
    .only_for(&["supervisor"])
}

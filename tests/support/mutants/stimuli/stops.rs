//! Stimuli with everything that stops the engine: each cause alone, in the same clock as another
//! one, and in critical moments.

use super::Stimulus;
use carrystep_core::engine::EngineOutputs;
use carrystep_core::{AXES, Command, EngineBuild, Program, Segment};
use carrystep_simulators::engine::{Event, Events};

/// Clocks of a tick of the mutants' build.
pub(super) const TICK: u64 = 96;
/// Clocks between two samples of a limit.
pub(super) const ROUND: u64 = 64 * TICK;
/// A clock in which the drivers are warm and all axes cruise.
pub(super) const THEN: u64 = 64_000;

/// The modules on the path from a limit switch to the stop.
const GUARDS: [&str; 6] = ["limits", "switches", "stops", "supervisor", "time_slot", "engine"];

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
    all.extend(starts_that_stop(build));
    all.extend(coincidences(build));
    all.push(bounces(build));
    all.push(homing(build));
    all.extend((0..AXES).map(|axis| last_step(build, axis)));
    all.push(silence(build));
    all
}

/// All axes move at these speeds.
pub(super) fn cruise(ticks: u32, v: [i64; AXES]) -> Program {
    let segment = |v| Segment { ticks, v, a: 0, j: 0, last: true };
    let segments = (0..).zip(v).map(|(axis, v)| Command::Segment { axis, segment: segment(v) });
    segments.chain([Command::Start { mask: 0x3f }]).collect()
}

/// A speed for every axis, the odd ones backward.
pub(super) fn both_ways(v: i64) -> [i64; AXES] {
    std::array::from_fn(|axis| if axis % 2 == 0 { v } else { -v })
}

/// A clear, and a short move after it.
pub(super) fn again(wait: u32) -> Program {
    [vec![Command::Wait { clocks: wait }, Command::Clear], cruise(40, both_ways(-(1 << 59)))]
        .concat()
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

/// The host selects every set of axes. Then all axes wait for their limits, the odd ones for the
/// low ends, and find them one after the other while segments are in their queues.
fn homing(build: &EngineBuild) -> Stimulus {
    let mut events: Events =
        (0..64).map(|axes: u8| (100 * u64::from(axes), Event::Home(axes))).collect();
    let ends = (0..AXES as u8).map(|axis| THEN + 9 * ROUND * u64::from(axis)).zip(0..AXES as u8);
    let (mut low, mut high) = (0, 0);
    for (at, axis) in ends {
        let end = if axis % 2 == 0 { &mut high } else { &mut low };
        *end |= 1 << axis;
        events.extend([(at, Event::LimitMin(low)), (at, Event::LimitMax(high))]);
    }
    events.extend([(120 * ROUND, Event::LimitMin(0)), (120 * ROUND, Event::LimitMax(0))]);
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
    let stimulus = Stimulus::new(build, "homing", &program, &events);
    let met = |(_, outputs): &(u64, EngineOutputs)| outputs.homing == 0 && outputs.fault.is_none();
    assert!(stimulus.recording.outputs.last().is_some_and(met), "all axes meet their limits");
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

/// An armed start could take effect in the tick in which another axis runs dry, or in the clock
/// after a stop was requested.
fn starts_that_stop(build: &EngineBuild) -> [Stimulus; 2] {
    let segment = |axis, ticks, last| Command::Segment {
        axis,
        segment: Segment { ticks, v: 1 << 52, a: 0, j: 0, last },
    };
    let program = |dry: bool| {
        let mut program = vec![segment(1, 60, true), segment(1, 20, true), segment(0, 60, !dry)];
        program.extend([Command::Start { mask: 3 }, Command::Start { mask: 2 }]);
        [program, again(20_000)].concat()
    };
    let started = Stimulus::new(build, "two starts", &program(false), &Events::new()).recording;
    let second = started
        .outputs
        .iter()
        .filter(|(_, outputs)| outputs.started)
        .nth(1)
        .map_or(THEN, |(cycle, _)| *cycle);
    let stop = vec![(second - 1, Event::Stop(true)), (second, Event::Stop(false))];
    [
        Stimulus::new(
            build,
            "a start in the tick that finds an axis dry",
            &program(true),
            &Events::new(),
        ),
        Stimulus::new(build, "a start in the clock after a stop", &program(false), &stop),
    ]
}

/// Two causes in one clock.
fn coincidences(build: &EngineBuild) -> Vec<Stimulus> {
    let one = |ticks, v, a, last| Segment { ticks, v, a, j: 0, last };
    let pair = |a: Segment, b: Segment| {
        let segments = [(1, a), (4, b)].map(|(axis, segment)| Command::Segment { axis, segment });
        [segments.to_vec(), vec![Command::Start { mask: 0b1_0010 }]].concat()
    };
    let (dry, fast) = (one(9, 1 << 52, 0, false), one(30, 1 << 60, 15 << 56, true));
    let turns = [
        (2, (1_i64 << 62) - (1 << 57)),
        (1, 1 << 58),
        (1, -(1 << 62)),
        (1, 1 << 62),
        (1, -(1 << 62)),
        (1, 1 << 62),
    ];
    let late =
        turns.map(|(ticks, v)| Command::Segment { axis: 5, segment: one(ticks, v, 0, false) });
    let late = [late.to_vec(), vec![Command::Start { mask: 32 }]].concat();
    let mut all = Vec::new();
    for (name, program) in [
        ("dry", pair(dry, dry)),
        ("overspeed", pair(fast, dry)),
        ("overrun", late),
        ("no start", vec![Command::Start { mask: 4 }]),
    ] {
        let base = Stimulus::new(build, name, &program, &Events::new());
        let Some(at) = called(&base) else { continue };
        let stop = vec![(at, Event::Stop(true)), (at + 1, Event::Stop(false))];
        all.push(Stimulus::new(
            build,
            format!("{name}, with a stop"),
            &[program.clone(), again(20_000)].concat(),
            &stop,
        ));
        // The e-stop is pressed before the preceding strobe and held, so that it is called in this
        // clock if this clock is a strobe.
        let press = vec![(at - TICK - 10, Event::EStop(true)), (at + 5, Event::EStop(false))];
        all.push(Stimulus::new(
            build,
            format!("{name}, with the e-stop"),
            &[program.clone(), again(20_000)].concat(),
            &press,
        ));
        let stray = |clocks| {
            let stray = Command::Segment { axis: 7, segment: one(1, 0, 0, true) };
            [program.clone(), vec![Command::Wait { clocks }, stray]].concat()
        };
        let early = called(&Stimulus::new(build, name, &stray(1), &Events::new()));
        if let Some(clocks) =
            early.and_then(|early| u32::try_from(at + 1 - early).ok()).filter(|clocks| *clocks > 0)
        {
            all.push(Stimulus::new(
                build,
                format!("{name}, with nonsense"),
                &[stray(clocks), again(20_000)].concat(),
                &Events::new(),
            ));
        }
    }
    // A stop and the e-stop in one strobe, and each of them together with a protocol fault.
    let at = THEN / TICK * TICK + TICK - 1;
    let events = vec![
        (at - TICK - 10, Event::EStop(true)),
        (at, Event::Stop(true)),
        (at + 1, Event::Stop(false)),
        (at + 9, Event::EStop(false)),
    ];
    all.push(Stimulus::new(build, "e-stop, with a stop", &again(1), &events));
    let stray = [
        Command::Wait { clocks: at as u32 },
        Command::Segment { axis: 6, segment: one(1, 0, 0, true) },
    ];
    all.push(Stimulus::new(
        build,
        "e-stop, with nonsense",
        &[stray.to_vec(), again(5_000)].concat(),
        &events,
    ));
    all.push(Stimulus::new(
        build,
        "stop, with nonsense",
        &[stray.to_vec(), again(5_000)].concat(),
        &events[1..3].to_vec(),
    ));
    all
}

/// The clock in which the first stop is called.
fn called(stimulus: &Stimulus) -> Option<u64> {
    let first = stimulus.recording.outputs.iter().find(|(_, outputs)| outputs.fault.is_some());
    first.map(|(cycle, _)| cycle - 1)
}

/// The last step of an axis comes in the last tick of its ramp, while the host asks for a clear.
fn last_step(build: &EngineBuild, axis: usize) -> Stimulus {
    let cruise = if axis.is_multiple_of(2) { 1 << 50 } else { -(1 << 50) };
    let run = |first: i64, then: &[Command]| {
        let segment = |ticks, v, last| Segment { ticks, v, a: 0, j: 0, last };
        let segments = [segment(1, first, false), segment(500, cruise, true)];
        let mut program: Program =
            segments.map(|segment| Command::Segment { axis: axis as u8, segment }).to_vec();
        program.push(Command::Start { mask: 1 << axis });
        program.extend(then);
        let events = vec![(THEN, Event::Stop(true)), (THEN + 1, Event::Stop(false))];
        Stimulus::new(
            build,
            format!("a step of axis {axis} in the last tick of a ramp"),
            &program,
            &events,
        )
    };
    let [low, high, ..] = run(0, &[]).recording.kept[axis];
    let rests_at = u64::from(high) << 32 | u64::from(low);
    // P comes to rest just beyond the boundary.
    let aim: u64 = if cruise > 0 { 1 } else { u64::MAX - 1 };
    run(
        aim.wrapping_sub(rests_at).cast_signed(),
        &[Command::Wait { clocks: 9_000 }, Command::Clear],
    )
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

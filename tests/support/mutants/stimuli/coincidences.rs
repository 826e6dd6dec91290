//! Stimuli in which a stop meets something else in the same clock or tick: another cause, a start,
//! or the last step of a ramp.

use super::Stimulus;
use super::cruise::{THEN, TICK, again};
use carrystep_core::{Command, EngineBuild, Program, Segment};
use carrystep_simulators::engine::{Event, Events};

/// An armed start could take effect in the tick in which another axis runs dry, or in the clock
/// after a stop was requested.
pub(super) fn starts_that_stop(build: &EngineBuild) -> [Stimulus; 2] {
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
pub(super) fn two_causes(build: &EngineBuild) -> Vec<Stimulus> {
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
pub(super) fn last_step(build: &EngineBuild, axis: usize) -> Stimulus {
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

//! Recordings for kinds of mutants that an independent bench found alive: in the last tick of a
//! move, in the ramp of a seek, while a step is held back, and in a clock without power. They are
//! made for every build of which mutants are drawn.

use super::Stimulus;
use super::cruise::{TICK, both_ways, cruise};
use carrystep_core::engine::{EngineOutputs, SeekSource};
use carrystep_core::{AXES, Command, EngineBuild, Program, Segment};
use carrystep_simulators::engine::{Event, Events};

/// The modules on the way of a limit to the stop.
const LIMIT: [&str; 7] =
    ["switches", "switch_memory", "seek_control", "stops", "queue", "time_slot", "engine"];

/// The modules that hold steps back, and that wait for them.
const PINS: [&str; 11] = [
    "pulser_0",
    "pulser_1",
    "pulser_2",
    "pulser_3",
    "pulser_4",
    "pulser_5",
    "event_wheel",
    "step_counts",
    "stops",
    "resets",
    "engine",
];

/// Losses that change every bit of a count of three bits.
const LOSSES: u32 = 5;

/// All of them. In the shipped engine they take long, because it debounces for long: each is run
/// only for the modules that it is about.
pub(super) fn all(build: &EngineBuild) -> Vec<Stimulus> {
    let mut all = vec![
        without_power(build).only_for(&["supervisor", "engine"]),
        dry_in_a_seek(build).only_for(&["queue", "seek_control", "adder", "engine"]),
    ];
    for axis in 0..AXES {
        all.extend([0, 1].map(|row| stops_at_a_limit(build, axis, row).only_for(&LIMIT)));
        let mut of_pins = vec![high_at_the_clear(build, axis)];
        of_pins.extend(rests_with_a_step(build, axis));
        of_pins.extend(crowded(build, axis));
        of_pins.push(loses_steps(build, axis));
        all.extend(of_pins.into_iter().map(|stimulus| stimulus.only_for(&PINS)));
    }
    all
}

/// Clocks of a round.
fn round(build: &EngineBuild) -> u64 {
    u64::from(build.guard.round) * TICK
}

/// A clock in which the drivers have been powered for long enough and all axes have begun to move.
fn then(build: &EngineBuild) -> u64 {
    u64::from(build.guard.enable + 1) * round(build) + 60 * TICK
}

fn segment(axis: usize, ticks: u32, v: i64, last: bool) -> Command {
    Command::Segment { axis: axis as u8, segment: Segment { ticks, v, a: 0, j: 0, last } }
}

/// The first clock in which the outputs of a recording satisfy a condition.
fn first(stimulus: &Stimulus, holds: impl Fn(&EngineOutputs) -> bool) -> u64 {
    let all = &stimulus.recording.outputs;
    let found = all.iter().find(|(_, outputs)| holds(outputs));
    found.unwrap_or_else(|| panic!("{} never comes so far", stimulus.name)).0
}

/// The number of the tick that begins behind the strobe in which the axes start.
pub(super) fn first_tick(stimulus: &Stimulus) -> u64 {
    (first(stimulus, |outputs| outputs.started) + 1) / TICK
}

/// The host removes the power at rest, for one clock and then for two.
fn without_power(build: &EngineBuild) -> Stimulus {
    let warm = u64::from(build.guard.enable + 1) * round(build);
    let at = warm + 40 * TICK;
    let again = at + warm + 40 * TICK;
    let events = vec![
        (at, Event::Enable(false)),
        (at + 1, Event::Enable(true)),
        (again, Event::Enable(false)),
        (again + 2, Event::Enable(true)),
    ];
    // The start is offered in the clock without power, and is taken when the drivers are warm.
    let mut program = cruise(3, both_ways(1 << 60));
    program.push(Command::Wait { clocks: 80 * TICK as u32 });
    program.extend(cruise(3, both_ways(1 << 60)));
    Stimulus::new(build, "a clock without power", &program, &events)
}

/// In the ramp of a seek the segment of each axis ends, which is not the last of its move, and no
/// other waits: that is no underrun.
fn dry_in_a_seek(build: &EngineBuild) -> Stimulus {
    let name = "a segment ends in the ramp of a seek";
    let run = |ticks: u32| {
        let source = SeekSource { axis: 0, row: 0, own: true, level: true };
        let at = then(build);
        let events = vec![
            (at, Event::SeekSource(source)),
            (at, Event::Seek(0x3f)),
            (at, Event::LimitMin(0x3f)),
            (at + 40 * round(build), Event::LimitMin(0)),
            (at + 60 * round(build), Event::Seek(0)),
        ];
        let v = |axis| -(1_i64 << 56) - ((axis as i64) << 50);
        let mut program: Program =
            (0..AXES).map(|axis| segment(axis, ticks, v(axis), false)).collect();
        program.push(Command::Start { mask: 0x3f });
        Stimulus::new(build, name, &program, &events)
    };
    let long = run(1_000_000);
    let hits = first(&long, |outputs| outputs.hits != 0) / TICK;
    // The slowest ramp takes two ticks and a half in any build.
    let stimulus = run((hits + 3 - first_tick(&long)) as u32);
    let stopped = stimulus.recording.outputs.iter().any(|(_, outputs)| outputs.fault.is_some());
    assert!(!stopped, "the segments end in the ramps");
    stimulus
}

/// An axis moves towards a limit that is active all the time. Its last tick is the first one that
/// samples the limit.
fn stops_at_a_limit(build: &EngineBuild, axis: usize, row: u64) -> Stimulus {
    let run = |ticks| {
        let limit = if row == 0 { Event::LimitMin(0x3f) } else { Event::LimitMax(0x3f) };
        let v = if row == 0 { -(1 << 54) } else { 1 << 54 };
        let mut program = vec![Command::Wait { clocks: then(build) as u32 + 13 }];
        program.extend([segment(axis, ticks, v, true), Command::Start { mask: 1 << axis }]);
        program.extend([Command::Wait { clocks: 90 * TICK as u32 }, Command::Clear]);
        let end = if row == 0 { "low" } else { "high" };
        let name = format!("axis {axis} ends at the limit of its {end} end");
        Stimulus::new(build, name, &program, &vec![(1, limit)])
    };
    let ticks = u64::from(build.guard.round);
    let begins = first_tick(&run(1));
    let stimulus = run(((row + ticks - begins % ticks) % ticks + 1) as u32);
    let culprits = |outputs: &EngineOutputs| outputs.fault.map(|(_, axes)| axes);
    first(&stimulus, |outputs| culprits(outputs) == Some(1 << axis));
    stimulus
}

/// The last step of an axis comes at the end of the last tick of a ramp, while the host already
/// requests the clear.
fn high_at_the_clear(build: &EngineBuild, axis: usize) -> Stimulus {
    let cruise = if axis.is_multiple_of(2) { 1 << 50 } else { -(1 << 50) };
    let run = |first: i64, then_do: &[Command]| {
        let mut program = vec![segment(axis, 1, first, false), segment(axis, 500, cruise, true)];
        program.push(Command::Start { mask: 1 << axis });
        program.extend(then_do);
        let at = then(build);
        let events = vec![(at, Event::Stop(true)), (at + 1, Event::Stop(false))];
        Stimulus::new(build, format!("a pulse of axis {axis} at a clear"), &program, &events)
    };
    let alone = run(0, &[]);
    let [low, high, ..] = alone.recording.kept[axis];
    let rests_at = u64::from(high) << 32 | u64::from(low);
    let aim: u64 = if cruise > 0 { 1 } else { u64::MAX - 1 };
    // The host waits from the clock after the start was taken.
    let armed = first(&alone, |outputs| outputs.armed);
    let wait = Command::Wait { clocks: (then(build) + 9 - armed) as u32 };
    run(aim.wrapping_sub(rests_at).cast_signed(), &[wait, Command::Clear])
}

/// The last tick of a move steps in the other direction just behind a step, so that this last step
/// is held back while no axis runs and STEP is low. The same run is frozen in the clocks before it.
fn rests_with_a_step(build: &EngineBuild, axis: usize) -> Vec<Stimulus> {
    let to = |v: i64| if axis.is_multiple_of(2) { v } else { -v };
    let run = |name: &str, events: &Events| {
        // The axis goes to the boundary, crosses it in the last phase of a tick, and crosses it
        // back in the first phase of the next one.
        let v = [i64::MAX - 99, 0, 0, 200, -(1 << 60)];
        let mut program: Program =
            (1..).zip(v).map(|(place, v)| segment(axis, 1, to(v), place == 5)).collect();
        program.push(Command::Start { mask: 1 << axis });
        program.extend([Command::Wait { clocks: 30 * TICK as u32 }, Command::Clear]);
        Stimulus::new(build, format!("axis {axis} rests with a step{name}"), &program, events)
    };
    let mut all = vec![run("", &Events::new())];
    let last = last_rise(&all[0], axis).expect("the axis steps");
    for before in 1..5 {
        let events = vec![(last - before, Event::Broken)];
        all.push(run(&format!(", frozen {before} clocks before"), &events));
    }
    all
}

/// The same again and again, with a freeze that discards the step that is held back each time, until
/// every bit of the pulser's count of losses has changed.
fn loses_steps(build: &EngineBuild, axis: usize) -> Stimulus {
    let to = |v: i64| if axis.is_multiple_of(2) { v } else { -v };
    let run = |times: u32, events: &Events| {
        let v = [i64::MAX - 99, 0, 0, 200, -(1 << 60)];
        let mut program = Program::new();
        for _ in 0..times {
            program.extend((1..).zip(v).map(|(place, v)| segment(axis, 1, to(v), place == 5)));
            program.push(Command::Start { mask: 1 << axis });
            program.extend([Command::Wait { clocks: 30 * TICK as u32 }, Command::Clear]);
        }
        Stimulus::new(build, format!("axis {axis} loses steps"), &program, events)
    };
    let losses = |stimulus: &Stimulus| stimulus.recording.kept[axis][3];
    let mut events = Events::new();
    for times in 1..=LOSSES {
        let last = last_rise(&run(times, &events), axis).expect("the axis steps");
        let frozen = (1..9).map(|before| [&events[..], &[(last - before, Event::Broken)]].concat());
        let loses = |events: &Events| losses(&run(times, events)) == times;
        events = frozen.into_iter().find(loses).expect("a freeze that discards the step");
    }
    run(LOSSES, &events)
}

/// The clock in which STEP of an axis becomes high for the last time.
fn last_rise(stimulus: &Stimulus, axis: usize) -> Option<u64> {
    let step = |outputs: &EngineOutputs| outputs.step >> axis & 1 == 1;
    let pairs = stimulus.recording.outputs.windows(2);
    let rises = pairs.filter(|pair| !step(&pair[0].1) && step(&pair[1].1));
    rises.map(|pair| pair[1].0).next_back()
}

/// An axis steps in every other tick, which some drivers cannot follow: a step is held back for
/// ever longer, until the next one comes in the clock in which it rises, and after it one is late.
/// The same run ends before the late step, reverses there, or is frozen in the clocks around it.
fn crowded(build: &EngineBuild, axis: usize) -> Vec<Stimulus> {
    let run = |name: &str, ticks: u32, then_v: &[i64], events: &Events| {
        let mut program = vec![segment(axis, ticks, i64::MAX, then_v.is_empty())];
        let places = 1..=then_v.len();
        let then_v = places.zip(then_v).map(|(place, v)| (place == then_v.len(), v));
        program.extend(then_v.map(|(last, v)| segment(axis, 1, *v, last)));
        program.push(Command::Start { mask: 1 << axis });
        program.extend([Command::Wait { clocks: 90 * TICK as u32 }, Command::Clear]);
        Stimulus::new(build, format!("axis {axis} is crowded, {name}"), &program, events)
    };
    let quiet = Events::new();
    let mut all = vec![run("long", 44, &[], &quiet)];
    let fault = |(cycle, outputs): &(u64, EngineOutputs)| outputs.fault.map(|_| *cycle);
    let late = all[0].recording.outputs.iter().find_map(fault);
    let (Some(late), Some(last)) = (late, last_rise(&all[0], axis)) else { return all };
    // The freeze comes in the clock after the late step, which was found two ticks before.
    let ticks = ((late - 1) / TICK - 2 + 1 - first_tick(&all[0])) as u32;
    all.push(run("short", ticks - 1, &[], &quiet));
    // The step that comes as another rises is a backward one: two ticks behind the last forward
    // step, in the same phase.
    let back = i64::MIN + 1;
    let turn = [back + 1000, back, -(1 << 60), -(1 << 60)];
    all.push(run("back", ticks - 4, &turn, &quiet));
    for before in [1, 2, 3, 9] {
        let events = vec![(last - before, Event::Broken)];
        all.push(run(&format!("frozen {before} clocks before"), ticks, &[], &events));
    }
    all
}

//! Random programs for the engine: queues that are filled and run dry, joint moves whose axes
//! reverse and end in one tick, and all programs of the other cores. E-stop, limits, stops, seeks,
//! edges of the latch and silence of the host occur in any clock, and segments change outputs.

use crate::effort;
use crate::programs::{self, all};
use carrystep_core::engine::{MAX_AXES, QUEUE_DEPTHS, SWITCH_ROWS, SeekSource};
use carrystep_core::{AXES, Command, EngineBuild, Program, Segment};
use carrystep_simulators::engine::{Event, Events};
use carrystep_tools::kept;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use std::cell::Cell;

/// Speeds up to the greatest one, so that axes step in almost every second tick.
fn fast() -> impl Strategy<Value = i64> {
    prop_oneof![
        4 => prop_oneof![Just(i64::MAX), Just(-i64::MAX)],
        4 => -i64::MAX..i64::MAX,
        2 => (20_u32..62).prop_flat_map(|bits| -(1_i64 << bits)..(1 << bits)),
        1 => Just(0),
    ]
}

/// All axes have the same ticks, and the host is a few segments ahead of the start. Every axis
/// reverses at each boundary.
fn reversals(axes: usize) -> impl Strategy<Value = Program> {
    let row = (prop_oneof![1_u32..4, 4_u32..40], prop::collection::vec(fast(), axes));
    (prop::collection::vec(row, 1..8), any::<bool>()).prop_map(move |(rows, dry)| {
        let count = rows.len();
        let mut program = Program::new();
        for (place, (ticks, lanes)) in rows.into_iter().enumerate() {
            for (axis, v) in (0..).zip(lanes) {
                let v = if place % 2 == 0 { v } else { v.wrapping_neg() };
                let segment = Segment { ticks, v, a: 0, j: 0, last: place + 1 == count && !dry };
                program.push(Command::Segment { axis, segment });
            }
        }
        program.push(Command::Start { mask: all(axes) });
        if dry {
            program.extend([Command::Wait { clocks: 4000 }, Command::Clear]);
        }
        program
    })
}

/// V and A leave their range after some ticks, on several axes at once.
fn too_fast(axes: usize) -> impl Strategy<Value = Program> {
    let axis = (1_u32..12, fast(), fast(), fast(), any::<bool>());
    prop::collection::vec(axis, axes).prop_map(move |lanes| {
        let mut program = Program::new();
        for (axis, (ticks, v, a, j, least)) in (0..).zip(lanes) {
            let v = if least && axis % 4 == 3 { i64::MIN } else { v };
            program.push(Command::Segment {
                axis,
                segment: Segment { ticks, v, a: a / 4, j: j / 16, last: true },
            });
        }
        program.extend([
            Command::Start { mask: all(axes) },
            Command::Wait { clocks: 2500 },
            Command::Clear,
        ]);
        program
    })
}

/// Long segments at speeds that produce steps, and a clear for the case that a stop occurs.
fn cruises(axes: usize) -> impl Strategy<Value = Program> {
    let axis = (
        200_u32..600,
        prop_oneof![4 => -(1_i64 << 60)..(1 << 60), 1 => fast()],
        -(1_i64 << 50)..(1 << 50),
    );
    prop::collection::vec(axis, axes).prop_map(move |lanes| {
        let mut program = Program::new();
        for (axis, (ticks, v, a)) in (0..).zip(lanes) {
            program.push(Command::Segment {
                axis,
                segment: Segment { ticks, v, a, j: 0, last: true },
            });
        }
        program.extend([
            Command::Start { mask: all(axes) },
            Command::Wait { clocks: 12_000 },
            Command::Clear,
        ]);
        program
    })
}

/// One event that begins and ends.
fn episode(axes: usize) -> impl Strategy<Value = Events> {
    let what = prop_oneof![
        2 => Just((Event::EStop(true), Event::EStop(false))),
        5 => (0..=all(axes)).prop_map(|mask| (Event::LimitMin(mask), Event::LimitMin(0))),
        5 => (0..=all(axes)).prop_map(|mask| (Event::LimitMax(mask), Event::LimitMax(0))),
        3 => (0..=all(axes)).prop_map(|mask| (Event::Inputs0(mask), Event::Inputs0(0))),
        // Bit 0 is the interlock, which is open for too short a time in many episodes.
        2 => (0..=all(axes)).prop_map(|mask| (Event::Inputs1(mask & !1), Event::Inputs1(0))),
        5 => (0..=all(axes)).prop_map(|mask| (Event::Inputs1(mask | 1), Event::Inputs1(0))),
        4 => (pins_of_latches(), pins_of_latches())
            .prop_map(|(one, other)| (Event::Latch(one), Event::Latch(one & other))),
        3 => (latches(), latches())
            .prop_map(|(one, other)| (Event::LatchArm(one), Event::LatchArm(other))),
        6 => Just((Event::Stop(true), Event::Stop(false))),
        1 => Just((Event::Enable(false), Event::Enable(true))),
        4 => (1..=all(axes)).prop_map(|mask| (Event::Seek(mask), Event::Seek(0))),
        2 => (source(axes), source(axes))
            .prop_map(|(one, other)| (Event::SeekSource(one), Event::SeekSource(other))),
        3 => Just((Event::Snapshot, Event::Snapshot)),
        1 => Just((Event::Broken, Event::Kick)),
        2 => Just((Event::Reset(true), Event::Reset(false))),
        1 => (1_u8..8).prop_map(|mask| (Event::WordError(mask), Event::WordError(0))),
        1 => (0_u32..32).prop_map(|bit| (Event::Stray(1 << bit), Event::Stray(0))),
    ];
    let length = prop_oneof![1 => 1_u64..10, 2 => 100_u64..400, 4 => 500_u64..5000];
    (what, 0_u64..60_000, length)
        .prop_map(|((begins, ends), at, length)| vec![(at, begins), (at + length, ends)])
}

/// Latches to arm, one bit each; now and then some that a build does not have.
fn latches() -> impl Strategy<Value = u8> {
    prop_oneof![4 => Just(0x3_u8), 6 => 0_u8..0x4, 1 => 0_u8..0x10]
}

/// Pins of latches, one bit each: often those of several latches at once.
fn pins_of_latches() -> impl Strategy<Value = u8> {
    prop_oneof![1 => Just(0xf_u8), 2 => 0_u8..0x10]
}

/// The host arms latches, and their pins change some ticks later, several of them at once or one
/// after the other; then it arms others.
fn edges_of_latches() -> impl Strategy<Value = Events> {
    let later = prop_oneof![1 => 0_u64..200, 3 => 200_u64..2000];
    let turns = prop::collection::vec((0_u8..0x4, pins_of_latches(), later), 2..8);
    (0_u64..60_000, turns).prop_map(|(at, turns)| {
        let mut events = Events::new();
        let mut then = at;
        for (arm, pins, later) in turns {
            events.push((then, Event::LatchArm(arm)));
            events.push((then + later / 2, Event::Latch(pins)));
            then += later;
        }
        events.push((then + 1000, Event::Latch(0)));
        events
    })
}

/// Any source, now and then one that no engine has.
fn source(axes: usize) -> impl Strategy<Value = SeekSource> {
    let axis = prop_oneof![9 => 0..axes as u8, 1 => 0..MAX_AXES as u8];
    (axis, 0..SWITCH_ROWS, any::<bool>(), any::<bool>())
        .prop_map(|(axis, row, own, level)| SeekSource { axis, row, own, level })
}

/// The switches of a row.
fn switches(row: u8, active: u8) -> Event {
    match row {
        0 => Event::LimitMin(active),
        1 => Event::LimitMax(active),
        2 => Event::Inputs0(active),
        _ => Event::Inputs1(active),
    }
}

/// Axes seek a switch, whose row becomes active or inactive bit by bit, whichever way the axes
/// move. The latches are connected to the same switches, and the host takes snapshots meanwhile.
/// Then it ends the seek, or seeks again.
fn seeks(axes: usize) -> impl Strategy<Value = Events> {
    let later = prop_oneof![1 => Just(0_u64), 1 => 1_u64..300, 3 => 300_u64..4000];
    let masks = prop::collection::vec((0..=all(axes), later), 1..4);
    let mask = prop_oneof![3 => Just(all(axes)), 1 => 0..=all(axes)];
    let again = prop_oneof![2 => Just(0), 1 => Just(all(axes))];
    (0_u64..60_000, source(axes), mask, masks, again).prop_map(
        move |(at, source, mask, masks, again)| {
            let SeekSource { row, level, .. } = source;
            // The interlock stays closed.
            let most = if row == 3 { all(axes) & !1 } else { all(axes) };
            let levels = |reached: u8| switches(row, most & if level { reached } else { !reached });
            let mut events = vec![
                (at.saturating_sub(3000), levels(0)),
                (at, Event::SeekSource(source)),
                (at, Event::Seek(mask)),
                (at, Event::LatchArm(0x3)),
            ];
            let (mut then, mut reached) = (at, 0);
            for (mask, later) in masks {
                then += later;
                reached |= mask;
                events.push((then, levels(reached)));
                events.push((then, Event::Latch(1 | reached << 1)));
                events.push((then + later / 2, Event::Snapshot));
                events.push((then + later / 2, Event::Latch(0)));
            }
            events.push((then + 2000, Event::Seek(again)));
            events.push((then + 4000, switches(row, 0)));
            events.push((then + 6000, Event::Seek(0)));
            events
        },
    )
}

/// The same program with the start behind as many rows of segments as fit into the queues, so that
/// the host is never late.
pub fn queued_first(mut program: Program) -> Program {
    program.retain(|command| !matches!(command, Command::Start { .. }));
    let segments =
        program.iter().filter(|command| matches!(command, Command::Segment { .. })).count();
    program.insert(segments.min(QUEUE_DEPTHS[0] * AXES), Command::Start { mask: all(AXES) });
    program
}

/// Kicks of a host in regular intervals, or from a host that falls silent.
fn signs_of_life() -> impl Strategy<Value = Events> {
    let interval = prop_oneof![3 => 100_u64..5000, 1 => 5000_u64..12_000];
    (interval, prop_oneof![3 => Just(120_000_u64), 1 => 0_u64..40_000]).prop_map(
        |(interval, end)| (0..end / interval).map(|i| (i * interval, Event::Kick)).collect(),
    )
}

/// The host changes what its commits say about the outputs.
fn outputs() -> impl Strategy<Value = Events> {
    let bits = prop_oneof![
        1 => Just(0_u32),
        3 => any::<u32>(),
        1 => any::<u32>().prop_map(|bits| bits & 0x000f_fff0),
        1 => (0_u32..4096).prop_map(|duty| duty << 20 | 2),
    ];
    let change = (0_u64..60_000, bits).prop_map(|(at, bits)| (at, Event::Outputs(bits)));
    prop::collection::vec(change, 0..12)
}

/// The host names slots in some axes, which may be any, and requests a cut.
fn cuts(axes: usize) -> impl Strategy<Value = Events> {
    let slots = prop_oneof![
        3 => (0_u8..32).prop_map(move |slot| vec![slot; axes]),
        1 => prop::collection::vec(0_u8..32, axes),
    ];
    let mask = prop_oneof![2 => Just(all(axes)), 3 => (0..axes).prop_map(|axis| 1 << axis), 1 => 0..=all(axes)];
    let later = prop_oneof![4 => 600_u64..2500, 1 => 0_u64..600];
    (0_u64..60_000, slots, mask, later).prop_map(|(at, slots, mask, later)| {
        let named = (0..).zip(slots).filter(|(axis, _)| mask >> axis & 1 == 1);
        let mut events: Events = named.map(|(axis, slot)| (at, Event::Name(axis, slot))).collect();
        events.push((at + later, Event::Cut));
        events
    })
}

/// All events around a program.
fn events(axes: usize) -> impl Strategy<Value = Events> {
    let episode = prop_oneof![
        12 => episode(axes),
        2 => seeks(axes),
        2 => cuts(axes),
        2 => edges_of_latches(),
    ];
    let episodes = prop_oneof![1 => Just(Vec::new()), 2 => prop::collection::vec(episode, 1..8)];
    (episodes, signs_of_life(), outputs()).prop_map(|(episodes, life, outputs)| {
        let mut events = episodes.concat();
        events.extend(life);
        events.extend(outputs);
        events.sort_by_key(|(cycle, _)| *cycle);
        one_cut_at_a_time(&mut events);
        events
    })
}

/// Clocks after which a cut is decided in every build of these tests: two ticks of 128 clocks.
const DECIDED: u64 = 256;

/// Leaves out cuts that would be requested while another one is not decided: the contract forbids
/// them to a host, and does not specify which segments they name.
fn one_cut_at_a_time(events: &mut Events) {
    let mut free = 0;
    events.retain(|(cycle, event)| {
        let is_cut = matches!(event, Event::Cut);
        let keeps = !is_cut || *cycle >= free;
        if is_cut && keeps {
            free = cycle + DECIDED;
        }
        keeps
    });
}

/// A segment for the highest possible axis number, which usually does not exist.
const STRAY: Segment = Segment { ticks: 1, v: 0, a: 0, j: 0, last: true };

/// Programs for an engine with `axes` axes, and the events around them.
pub fn program(axes: usize) -> impl Strategy<Value = (Program, Events)> {
    let stray = vec![Command::Segment { axis: 7, segment: STRAY }, Command::Clear];
    let part = prop_oneof![
        2 => reversals(axes),
        1 => too_fast(axes),
        4 => cruises(axes),
        2 => programs::program_of(axes),
        1 => Just(stray),
    ];
    (prop::collection::vec(part, 1..5).prop_map(|parts| parts.concat()), events(axes))
}

/// The same for an engine with several latches, whose pins have many edges.
pub fn program_with_latches(axes: usize) -> impl Strategy<Value = (Program, Events)> {
    let edges = prop::collection::vec(edges_of_latches(), 1..6);
    (program(axes), edges).prop_map(|((program, mut events), edges)| {
        events.extend(edges.concat());
        events.sort_by_key(|(cycle, _)| *cycle);
        (program, events)
    })
}

/// Programs and events are made for ticks of 80 clocks. The same ones for an engine with several
/// adders, with its ticks: otherwise most events would happen long after its axes have come to
/// rest.
pub fn in_ticks_of(build: &EngineBuild, program: Program, events: Events) -> (Program, Events) {
    if build.adders == 1 {
        return (program, events);
    }
    let scaled = |clocks: u64| clocks * u64::from(build.timebase.clocks_per_tick()) / 80;
    let waits = |command| match command {
        Command::Wait { clocks } => Command::Wait { clocks: (scaled(clocks.into()) as u32).max(1) },
        other => other,
    };
    let program = program.into_iter().map(waits).collect();
    let events = events.into_iter().map(|(at, event)| (scaled(at), event)).collect();
    (program, events)
}

/// Runs random programs until they have taken the required number of clocks.
///
/// # Panics
/// Where `one`, which gives the clocks that a program took, finds a difference.
pub fn run_programs(
    build: &EngineBuild,
    usual: u64,
    one: impl Fn(&Program, &Events) -> Result<u64, TestCaseError>,
) {
    let (clocks, enough) = (Cell::new(0), effort::clocks(usual));
    let mut config = Config {
        cases: 4,
        max_shrink_time: 20_000,
        failure_persistence: None,
        ..Config::default()
    };
    while clocks.get() < enough {
        // A fixed seed is incremented, so that each round has other programs.
        if let RngSeed::Fixed(seed) = &mut config.rng_seed {
            *seed = seed.wrapping_add(1);
        }
        let programs = match build.has_several_latches() {
            true => program_with_latches(build.axes()).boxed(),
            false => program(build.axes()).boxed(),
        };
        let held = TestRunner::new(config.clone()).run(&programs, |(program, events)| {
            if clocks.get() >= enough {
                return Ok(());
            }
            let (program, events) = in_ticks_of(build, program, events);
            clocks.set(clocks.get() + one(&program, &events)?);
            Ok(())
        });
        held.unwrap_or_else(|error| panic!("{error}\n of {build:?}"));
    }
    let on = match build.adders {
        1 => String::new(),
        adders => format!("{} axes on {adders} adders: ", build.axes()),
    };
    effort::figures(&format!("{on}{} clocks, no difference", clocks.get()));
    kept::say();
}

//! Stimuli of normal work: joint moves of any curve, axes that start separately, and power switched
//! on and off.

use super::{Stimulus, drawn};
use carrystep_core::{AXES, Command, EngineBuild, Program, Segment};
use carrystep_simulators::engine::{Event, Events};
use proptest::prelude::*;

/// Speeds below 2^bits let the drivers of the mutants' build follow nearly always.
const SPEED_BITS: [u32; AXES] = [63, 62, 62, 60, 63, 61];

pub(super) fn all(build: &EngineBuild) -> Vec<Stimulus> {
    let quiet = Events::new();
    vec![
        Stimulus::new(build, "moves", &drawn(&moves(), 8).concat(), &quiet),
        Stimulus::new(build, "starts", &starts(), &quiet),
        Stimulus::new(build, "turns", &turns(), &quiet),
        Stimulus::new(build, "rests in every slot", &rests(), &quiet),
        Stimulus::new(build, "knife edges", &drawn(&knife_edges(), 20).concat(), &quiet),
        Stimulus::new(build, "crashes", &drawn(&crash(), 40).concat(), &quiet),
        Stimulus::new(build, "power", &power().0, &power().1),
    ]
}

/// V, A and J for which the speed stays below 2^bits for this many ticks.
fn curve(bits: u32, ticks: u32) -> impl Strategy<Value = (i64, i64, i64)> {
    let (most, ticks) = (i64::MAX >> (63 - bits), i64::from(ticks));
    let within = |most: i64| -most..=most;
    (within(most / 2), within(most / 4 / ticks), within(most / 4 / ticks / ticks))
}

/// Axis k comes to rest with its running segment in slot k. The memory holds values that outlast a
/// move beside it.
fn rests() -> Program {
    let segment = |axis: u8, place: u8| {
        let v = -(0x0123_4567_89ab_cdef >> (axis % 3)) - (i64::from(place) << 40);
        let segment = Segment { ticks: 200, v, a: 0, j: 0, last: place == 7 + axis };
        Command::Segment { axis, segment }
    };
    let rows = |places: std::ops::Range<u8>| {
        places.flat_map(move |place| {
            (0..6).filter(move |axis| place <= 7 + axis).map(move |axis| segment(axis, place))
        })
    };
    rows(0..7).chain([Command::Start { mask: 0x3f }]).chain(rows(7..13)).collect()
}

/// One segment for each axis.
fn row(ticks: u32) -> impl Strategy<Value = Vec<Segment>> {
    let axes: Vec<_> = SPEED_BITS.iter().map(|&bits| curve(bits, ticks)).collect();
    axes.prop_map(move |axes| {
        axes.into_iter()
            .map(|(v, a, j)| Segment { ticks, v, a, j, last: false })
            .collect::<Vec<_>>()
    })
}

/// A joint move of up to ten segments: those that fit into the queues, the start, then the others
/// as there is room.
fn moves() -> impl Strategy<Value = Program> {
    let ticks = prop_oneof![2 => 1_u32..4, 3 => 4_u32..40, 4 => 40_u32..300];
    prop::collection::vec(ticks.prop_flat_map(row), 1..=10).prop_map(|rows| {
        let count = rows.len();
        let mut program = Program::new();
        for (place, row) in rows.into_iter().enumerate() {
            for (axis, segment) in (0..).zip(row) {
                program.push(Command::Segment {
                    axis,
                    segment: Segment { last: place + 1 == count, ..segment },
                });
            }
            if place + 1 == count.min(7) {
                program.push(Command::Start { mask: 0x3f });
            }
        }
        // The clear has an effect only if the queues have run dry.
        program.extend([Command::Wait { clocks: 96 * 400 }, Command::Clear]);
        program
    })
}

/// Each axis is started separately while the others run, and again while it is running itself.
fn starts() -> Program {
    let mut program = Program::new();
    for round in 0..2 {
        for axis in 0..6 {
            let v = if (axis + round) % 2 == 0 { 1 << 59 } else { -(1 << 59) };
            let segment = Segment {
                ticks: 150 + 20 * u32::from(axis),
                v,
                a: 1 << 48,
                j: -(1 << 38),
                last: true,
            };
            program
                .extend([Command::Segment { axis, segment }, Command::Start { mask: 1 << axis }]);
        }
    }
    program
}

/// An axis rests and then steps in the other direction: DIR changes and the step waits for its
/// set-up. This covers each phase and both directions.
fn turns() -> Program {
    let mut program = Program::new();
    for (sixteenths, back) in
        (0..12).flat_map(|sixteenths| [(sixteenths, false), (sixteenths, true)])
    {
        let to = |v: i64| if back { v } else { -v };
        // The axis goes to a place near the boundary, rests a few ticks, and then crosses it.
        let beside = (sixteenths << 57) + 99;
        for (ticks, v) in [(1, i64::MAX - beside), (6, -1), (1, 1 << 61), (5, 0)] {
            let last = v == 0;
            for axis in 0..6 {
                program.push(Command::Segment {
                    axis,
                    segment: Segment { ticks, v: to(v), a: 0, j: 0, last },
                });
            }
        }
        program.push(Command::Start { mask: 0x3f });
    }
    program
}

/// Steps whose phase depends on the last bit of the bisection: P is placed so that a multiple of a
/// sixteenth of V just crosses the boundary, or just does not.
fn knife_edges() -> impl Strategy<Value = Program> {
    let axis = |bits: u32| {
        ((1_i64 << (bits - 4))..=(i64::MAX >> (63 - bits)), any::<bool>(), 1_i64..16, -2_i64..3)
    };
    let axes: Vec<_> = SPEED_BITS.iter().map(|&bits| axis(bits)).collect();
    axes.prop_map(|axes| {
        let mut program = Program::new();
        for (axis, (v, back, part, off)) in (0_u8..).zip(axes) {
            // The distance to the boundary, in the units of the bisection.
            let way = ((v >> 32) * part / 16 + off).clamp(1, (1 << 31) - 1) << 32;
            let (v, to) = if back { (-v, i64::MIN + way) } else { (v, i64::MAX - way + 1) };
            // The axis goes near the boundary, crosses it, and returns the same way.
            for (ticks, v) in [(1, to), (1, v), (8, 0), (1, -v), (1, -to)] {
                program.push(Command::Segment {
                    axis,
                    segment: Segment { ticks, v, a: 0, j: 0, last: v == -to },
                });
            }
        }
        program.push(Command::Start { mask: 0x3f });
        program
    })
}

/// Within few ticks, axes leave their range, step faster than their drivers allow, or run dry; then
/// a clear follows.
fn crash() -> impl Strategy<Value = Program> {
    let v = prop_oneof![3 => any::<i64>(), 1 => Just(i64::MIN), 3 => -(1_i64 << 60)..(1 << 60)];
    let a = prop_oneof![2 => Just(0), 1 => any::<i64>(), 1 => -(1_i64 << 60)..(1 << 60)];
    let lane = prop::collection::vec((1_u32..5, v, a), 1..3);
    (1_u8..64, prop::collection::vec(lane, AXES), 1_u32..3000, any::<bool>()).prop_map(
        |(mask, lanes, clocks, dry)| {
            // A ramp from half a step per tick would take a hundred thousand ticks.
            let calm = if dry { 9 } else { 0 };
            let mut program = Program::new();
            for (axis, lane) in (0_u8..).zip(lanes).filter(|(axis, _)| mask >> axis & 1 == 1) {
                let count = lane.len();
                for (place, (ticks, v, a)) in lane.into_iter().enumerate() {
                    let last = place + 1 == count && (!dry || ticks > 2);
                    let segment = Segment {
                        ticks,
                        v: v >> calm,
                        a: a >> calm >> calm,
                        j: a >> 1 >> calm >> calm,
                        last,
                    };
                    program.push(Command::Segment { axis, segment });
                }
            }
            program.extend([Command::Start { mask }, Command::Wait { clocks }, Command::Clear]);
            program
        },
    )
}

/// The host switches the power off during a move and at rest. A start waits until the drivers have
/// been powered for their warm-up time.
fn power() -> (Program, Events) {
    let segment = |ticks, v| Segment { ticks, v, a: 0, j: 0, last: true };
    let go = |ticks, v| {
        [Command::Segment { axis: 0, segment: segment(ticks, v) }, Command::Start { mask: 1 }]
    };
    let program = [go(300, 1 << 60), go(20, -(1 << 62)), go(20, 1 << 62)].concat();
    let events = [
        (70_000, false),
        (110_000, true),
        (110_300, false),
        (120_000, true),
        (200_000, false),
        (200_003, true),
    ];
    (program, events.map(|(at, on)| (at, Event::Enable(on))).to_vec())
}

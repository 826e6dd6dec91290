//! Random programs for the engine: queues filled and run dry, joint moves whose axes turn and end in one
//! tick, and whatever the other cores are given.

use crate::programs;
use carrystep_spec::{AXES, Command, Program, Segment};
use proptest::prelude::*;

/// Speeds up to the bound, so that axes step in almost every second tick.
fn fast() -> impl Strategy<Value = i64> {
    prop_oneof![
        4 => prop_oneof![Just(i64::MAX), Just(-i64::MAX)],
        4 => -i64::MAX..i64::MAX,
        2 => (20_u32..62).prop_flat_map(|bits| -(1_i64 << bits)..(1 << bits)),
        1 => Just(0),
    ]
}

/// All axes the same ticks, a few segments ahead of the start; every axis turns at each boundary.
fn reversals() -> impl Strategy<Value = Program> {
    let row = (prop_oneof![1_u32..4, 4_u32..40], prop::collection::vec(fast(), AXES));
    (prop::collection::vec(row, 1..8), any::<bool>()).prop_map(|(rows, dry)| {
        let count = rows.len();
        let mut program = Program::new();
        for (place, (ticks, axes)) in rows.into_iter().enumerate() {
            for (axis, v) in (0..).zip(axes) {
                let v = if place % 2 == 0 { v } else { v.wrapping_neg() };
                let segment = Segment { ticks, v, a: 0, j: 0, last: place + 1 == count && !dry };
                program.push(Command::Segment { axis, segment });
            }
        }
        program.push(Command::Start { mask: 0x3f });
        if dry {
            program.extend([Command::Wait { clocks: 4000 }, Command::Clear]);
        }
        program
    })
}

/// V and A that leave the range after some ticks, on several axes at once.
fn too_fast() -> impl Strategy<Value = Program> {
    let axis = (1_u32..12, fast(), fast(), fast(), any::<bool>());
    prop::collection::vec(axis, AXES).prop_map(|axes| {
        let mut program = Program::new();
        for (axis, (ticks, v, a, j, least)) in (0..).zip(axes) {
            let v = if least && axis == 3 { i64::MIN } else { v };
            program.push(Command::Segment { axis, segment: Segment { ticks, v, a: a / 4, j: j / 16, last: true } });
        }
        program.extend([Command::Start { mask: 0x3f }, Command::Wait { clocks: 2500 }, Command::Clear]);
        program
    })
}

/// Programs for the engine.
pub fn program() -> impl Strategy<Value = Program> {
    let part = prop_oneof![2 => reversals(), 1 => too_fast(), 2 => programs::program()];
    prop::collection::vec(part, 1..4).prop_map(|parts| parts.concat())
}

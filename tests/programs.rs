//! Random programs for lock-step: reversals, dry queues, one-tick segments, V at its bound, host
//! faults and clears.

use carrystep_spec::{AXES, Command, Program, Segment};
use proptest::prelude::*;

/// A speed: mostly such that steps come at all, sometimes at the very bound, sometimes beyond.
fn v() -> impl Strategy<Value = i64> {
    prop_oneof![
        3 => -i64::MAX..i64::MAX,
        7 => -(1_i64 << 62)..(1 << 62),
        2 => (40_u32..62).prop_flat_map(|bits| -(1_i64 << bits)..(1 << bits)),
        1 => Just(0),
        1 => prop_oneof![Just(1), Just(-1), Just(i64::MAX), Just(-i64::MAX), Just(i64::MAX - 1)],
    ]
}

/// An acceleration or jerk that turns a speed round within a few or a few hundred ticks.
fn change() -> impl Strategy<Value = i64> {
    prop_oneof![3 => Just(0), 4 => (30_u32..61).prop_flat_map(|bits| -(1_i64 << bits)..(1 << bits))]
}

/// A segment of a few ticks; `last` is set by the program.
pub fn segment() -> impl Strategy<Value = Segment> {
    let ticks = prop_oneof![2 => Just(1_u32), 4 => 2_u32..8, 2 => 8_u32..80];
    (ticks, v(), change(), change()).prop_map(|(ticks, v, a, j)| Segment { ticks, v, a, j, last: false })
}

/// Segments that a well-meaning host sends for one move of all axes: each axis the same ticks.
fn joint_move() -> impl Strategy<Value = Program> {
    prop::collection::vec((1_u32..100, prop::collection::vec((v(), change(), change()), AXES)), 1..6).prop_map(|rows| {
        let count = rows.len();
        let mut program = Program::new();
        for (row, (ticks, axes)) in rows.into_iter().enumerate() {
            for (axis, (v, a, j)) in (0..).zip(axes) {
                // Half the speed, no change that could leave the range: such a move runs to its end.
                let segment = Segment { ticks, v: v / 2, a: a >> 14, j: j >> 24, last: row + 1 == count };
                program.push(Command::Segment { axis, segment });
            }
            if row == 0 {
                program.push(Command::Start { mask: 0x3f });
            }
        }
        program
    })
}

/// A few segments for some axes, at any speed, started together; not always marked last, so that queues
/// run dry.
fn wild_move() -> impl Strategy<Value = Program> {
    let axis = (prop::collection::vec((segment(), 0_u32..24), 1..4), prop::bool::weighted(0.7));
    (1_u8..64, prop::collection::vec(axis, AXES), 0_u32..3000).prop_map(|(mask, axes, wait)| {
        let mut rows: Vec<(usize, Command)> = Vec::new();
        for (axis, (segments, last)) in (0..).zip(axes).filter(|(axis, _)| mask >> axis & 1 == 1) {
            let count = segments.len();
            for (row, (s, calm)) in segments.into_iter().enumerate() {
                let segment = Segment { a: s.a >> calm, j: s.j >> (2 * calm), last: last && row + 1 == count, ..s };
                rows.push((row, Command::Segment { axis, segment }));
            }
        }
        rows.sort_by_key(|(row, _)| *row);
        let first = rows.iter().filter(|(row, _)| *row == 0).count();
        let mut program: Program = rows.into_iter().map(|(_, command)| command).collect();
        program.insert(first, Command::Start { mask });
        program.push(Command::Wait { clocks: wait + 1 });
        program
    })
}

/// Things that a host must not do, and what it may do at any time.
fn nonsense() -> impl Strategy<Value = Program> {
    let one = prop_oneof![
        (6_u8..8, segment()).prop_map(|(axis, segment)| Command::Segment { axis, segment }),
        (0_u8..6, segment()).prop_map(|(axis, s)| Command::Segment { axis, segment: Segment { ticks: 0, ..s } }),
        (0_u8..6, segment()).prop_map(|(axis, s)| Command::Segment { axis, segment: Segment { v: i64::MIN, ..s } }),
        (0_u8..64).prop_map(|mask| Command::Start { mask }),
        Just(Command::Clear),
    ];
    (one, 1_u32..40).prop_map(|(command, clocks)| vec![command, Command::Wait { clocks }])
}

/// A whole program: proper moves, wild ones, nonsense, a clear here and there.
pub fn program() -> impl Strategy<Value = Program> {
    let part = prop_oneof![
        3 => joint_move(),
        5 => wild_move(),
        1 => nonsense(),
        3 => Just(vec![Command::Clear]),
    ];
    prop::collection::vec(part, 1..7).prop_map(|parts| parts.concat())
}

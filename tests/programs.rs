//! Random programs for lock-step: reversals, dry queues, one-tick segments, V at its bound, host
//! faults and clears.

use carrystep_spec::{AXES, Command, Program, Segment};
use proptest::prelude::*;

/// A speed: mostly such that steps come at all, sometimes at the very bound, sometimes beyond.
fn v() -> impl Strategy<Value = i64> {
    prop_oneof![
        6 => -(1_i64 << 62)..(1 << 62),
        4 => (40_u32..62).prop_flat_map(|bits| -(1_i64 << bits)..(1 << bits)),
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
    prop::collection::vec((1_u32..40, prop::collection::vec((v(), change(), change()), AXES)), 1..6).prop_map(|rows| {
        let count = rows.len();
        let mut program = Program::new();
        for (row, (ticks, axes)) in rows.into_iter().enumerate() {
            for (axis, (v, a, j)) in (0..).zip(axes) {
                // Half the speed, no change that could leave the range: such a move runs to its end.
                let segment = Segment { ticks, v: v / 4, a: a >> 14, j: j >> 24, last: row + 1 == count };
                program.push(Command::Segment { axis, segment });
            }
            if row == 0 {
                program.push(Command::Start { mask: 0x3f });
            }
        }
        program
    })
}

/// Anything that a host could do, right or wrong.
fn wild_command() -> impl Strategy<Value = Command> {
    prop_oneof![
        12 => (0_u8..6, segment(), any::<bool>()).prop_map(|(axis, s, last)| Command::Segment { axis, segment: Segment { last, ..s } }),
        4 => (1_u8..64).prop_map(|mask| Command::Start { mask }),
        4 => (1_u32..200).prop_map(|clocks| Command::Wait { clocks }),
        1 => (0_u32..4000).prop_map(|clocks| Command::Wait { clocks: clocks + 1 }),
        2 => Just(Command::Clear),
        1 => prop_oneof![
            (6_u8..8, segment()).prop_map(|(axis, segment)| Command::Segment { axis, segment }),
            (0_u8..6, segment()).prop_map(|(axis, s)| Command::Segment { axis, segment: Segment { ticks: 0, ..s } }),
            (0_u8..6, segment()).prop_map(|(axis, s)| Command::Segment { axis, segment: Segment { v: i64::MIN, ..s } }),
        ],
    ]
}

/// A whole program: proper moves, wild hosts, and both in turn. A segment offered to a full slot of an
/// axis that never starts would block for ever, so wild stretches end with a fault and a clear.
pub fn program() -> impl Strategy<Value = Program> {
    let wild = prop::collection::vec(wild_command(), 1..24).prop_map(unblocked);
    prop::collection::vec(prop_oneof![joint_move(), wild], 1..4).prop_map(|parts| parts.concat())
}

/// Drops the segments that could wait for ever (a second one for an axis without a start between), and
/// ends with a protocol fault and a clear so that what follows finds an empty core.
fn unblocked(commands: Vec<Command>) -> Program {
    let mut filled = [0_u32; 8];
    let mut program = Program::new();
    for command in commands {
        match command {
            Command::Segment { axis, .. } => {
                filled[usize::from(axis)] += 1;
                if filled[usize::from(axis)] > 1 {
                    continue;
                }
            }
            Command::Start { .. } | Command::Clear => filled = [0; 8],
            Command::Wait { .. } => {}
        }
        program.push(command);
    }
    let nonsense = Segment { ticks: 0, v: 0, a: 0, j: 0, last: true };
    program.push(Command::Segment { axis: 7, segment: nonsense });
    program.push(Command::Wait { clocks: 1 });
    program.push(Command::Clear);
    program
}

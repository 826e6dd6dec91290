//! Random programs for lock-step: reversals, queues that run dry, one-tick segments, V at its
//! limit, faults of the host, and clears.

use carrystep_core::{AXES, Command, Program, Segment};
use proptest::prelude::*;

/// A speed that usually produces steps, and sometimes equals or exceeds the limit.
fn v() -> impl Strategy<Value = i64> {
    prop_oneof![
        3 => -i64::MAX..i64::MAX,
        7 => -(1_i64 << 62)..(1 << 62),
        2 => (40_u32..62).prop_flat_map(|bits| -(1_i64 << bits)..(1 << bits)),
        1 => Just(0),
        1 => prop_oneof![Just(1), Just(-1), Just(i64::MAX), Just(-i64::MAX), Just(i64::MAX - 1)],
    ]
}

/// An acceleration or jerk that reverses a speed within a few to a few hundred ticks.
fn change() -> impl Strategy<Value = i64> {
    prop_oneof![3 => Just(0), 4 => (30_u32..61).prop_flat_map(|bits| -(1_i64 << bits)..(1 << bits))]
}

/// A segment of a few ticks; the program sets `last`.
pub fn segment() -> impl Strategy<Value = Segment> {
    let ticks = prop_oneof![2 => Just(1_u32), 4 => 2_u32..8, 2 => 8_u32..80];
    (ticks, v(), change(), change()).prop_map(|(ticks, v, a, j)| Segment {
        ticks,
        v,
        a,
        j,
        last: false,
    })
}

/// The segments that a correct host sends for one move of all axes; each axis has the same ticks.
fn joint_move(axes: usize) -> impl Strategy<Value = Program> {
    prop::collection::vec(
        (1_u32..100, prop::collection::vec((v(), change(), change()), axes)),
        1..6,
    )
    .prop_map(move |rows| {
        let count = rows.len();
        let mut program = Program::new();
        for (row, (ticks, lanes)) in rows.into_iter().enumerate() {
            for (axis, (v, a, j)) in (0..).zip(lanes) {
                // With half the speed and changes that cannot leave the range, the move runs to
                // its end.
                let segment =
                    Segment { ticks, v: v / 2, a: a >> 14, j: j >> 24, last: row + 1 == count };
                program.push(Command::Segment { axis, segment });
            }
            if row == 0 {
                program.push(Command::Start { mask: all(axes) });
            }
        }
        program
    })
}

/// A few segments for some axes at any speed, started together. Not all of them are marked last, so
/// queues may run dry.
fn wild_move(axes: usize) -> impl Strategy<Value = Program> {
    let axis = (prop::collection::vec((segment(), 0_u32..24), 1..4), prop::bool::weighted(0.7));
    (1..=all(axes), prop::collection::vec(axis, axes), 0_u32..3000).prop_map(
        |(mask, axes, wait)| {
            let mut rows: Vec<(usize, Command)> = Vec::new();
            for (axis, (segments, last)) in
                (0..).zip(axes).filter(|(axis, _)| mask >> axis & 1 == 1)
            {
                let count = segments.len();
                for (row, (s, calm)) in segments.into_iter().enumerate() {
                    let segment = Segment {
                        a: s.a >> calm,
                        j: s.j >> (2 * calm),
                        last: last && row + 1 == count,
                        ..s
                    };
                    rows.push((row, Command::Segment { axis, segment }));
                }
            }
            rows.sort_by_key(|(row, _)| *row);
            let first = rows.iter().filter(|(row, _)| *row == 0).count();
            let mut program: Program = rows.into_iter().map(|(_, command)| command).collect();
            program.insert(first, Command::Start { mask });
            program.push(Command::Wait { clocks: wait + 1 });
            program
        },
    )
}

/// Commands that a host must not send, and commands that it may send at any time.
fn nonsense(axes: usize) -> impl Strategy<Value = Program> {
    let count = axes as u8;
    let one = prop_oneof![
        (count.min(7)..8, segment()).prop_map(|(axis, segment)| Command::Segment { axis, segment }),
        (0..count, segment())
            .prop_map(|(axis, s)| Command::Segment { axis, segment: Segment { ticks: 0, ..s } }),
        (0..count, segment())
            .prop_map(|(axis, s)| Command::Segment { axis, segment: Segment { v: i64::MIN, ..s } }),
        (0..=all(axes)).prop_map(|mask| Command::Start { mask }),
        Just(Command::Clear),
    ];
    (one, 1_u32..40).prop_map(|(command, clocks)| vec![command, Command::Wait { clocks }])
}

/// The mask of all axes.
pub fn all(axes: usize) -> u8 {
    ((1_u32 << axes) - 1) as u8
}

/// A complete program for the parallel core.
pub fn program() -> impl Strategy<Value = Program> {
    program_of(AXES)
}

/// A complete program for a core of this many axes, at most 6, that also names axes which the core
/// does not have: one segment is for such an axis, and the masks of the starts have bits for them.
pub fn program_with_strangers(axes: usize) -> impl Strategy<Value = Program> {
    let stranger = (axes as u8..8, segment(), 1_u32..400, any::<prop::sample::Index>());
    (program_of(axes), stranger, any::<u8>()).prop_map(
        move |(mut program, (axis, segment, clocks, place), bits)| {
            for command in &mut program {
                if let Command::Start { mask } = command {
                    *mask |= bits & !all(axes);
                }
            }
            let place = place.index(program.len() + 1);
            let strange =
                [Command::Segment { axis, segment }, Command::Wait { clocks }, Command::Clear];
            program.splice(place..place, strange);
            program
        },
    )
}

/// A complete program for this many axes: correct moves, wild moves, protocol faults, and some
/// clears.
pub fn program_of(axes: usize) -> impl Strategy<Value = Program> {
    let part = prop_oneof![
        3 => joint_move(axes),
        5 => wild_move(axes),
        1 => nonsense(axes),
        3 => Just(vec![Command::Clear]),
    ];
    prop::collection::vec(part, 1..7).prop_map(|parts| parts.concat())
}

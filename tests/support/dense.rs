//! Random programs with many edges per clock. Each of them contains a situation that the fast
//! model's search for edges could get wrong.

use carrystep_core::{AXES, Command, Program, Segment};
use proptest::prelude::*;

/// The greatest possible speed, in 2^-64 step per tick.
const TOP: i64 = i64::MAX;

/// The motion of one axis in a row of segments of equal length. `v`, `a` and `j` are chosen
/// relative to what fits into that length.
#[derive(Debug, Clone, Copy)]
struct Course {
    v: i64,
    a: i64,
    j: i64,
}

/// A fraction from -1 to 1 of either sign and any magnitude; the extremes are more frequent than in
/// a uniform distribution.
fn part() -> impl Strategy<Value = f64> {
    prop_oneof![6 => -1.0..1.0, 2 => -0.2..0.2, 1 => Just(0.0), 1 => Just(1.0), 1 => Just(-1.0)]
}

/// Speeds that divide a step into whole ticks, so that a step ends at the end of a tick.
fn dividing() -> impl Strategy<Value = i64> {
    (2_u32..12, -1_i64..2, any::<bool>()).prop_map(|(bits, off, back)| {
        let v = (1_i64 << (64 - bits)).min(TOP - 1) + off;
        if back { -v } else { v }
    })
}

/// Speed, acceleration and jerk that change the speed by up to its full range within `ticks` ticks.
fn course(ticks: u32) -> impl Strategy<Value = Course> {
    let n = f64::from(ticks);
    let scaled = |part: f64, whole: f64| ((part * whole) as i64).max(-TOP);
    let top = TOP as f64;
    let free = (part(), part(), part()).prop_map(move |(v, a, j)| Course {
        v: scaled(v, top),
        a: scaled(a, top / n),
        j: scaled(j, top / n / n),
    });
    // Out and back: V changes its sign once or twice within the segment.
    let turning = (part(), 0.1..2.0).prop_map(move |(v, sharp)| Course {
        v: scaled(v, top),
        a: scaled(-v * 4.0 * sharp, top / n),
        j: scaled(v * 8.0 * sharp, top / n / n),
    });
    // V has its extremum within the first ticks, and a sign that lasts for one tick.
    let sharp = (1_i64 << 20..1 << 59, 0.3..3.0, -2_i64..3).prop_map(|(a, ticks, off)| Course {
        v: -a / 2 + off,
        a,
        j: -((a as f64 / ticks) as i64),
    });
    let steady = dividing().prop_map(|v| Course { v, a: 0, j: 0 });
    // V is the greatest possible speed or slightly less.
    let bound = (0_i64..3, 0_i64..3, any::<bool>()).prop_map(|(off, a, back)| {
        let sign = if back { -1 } else { 1 };
        Course { v: sign * (TOP - off), a: sign * -a, j: 0 }
    });
    let any = prop_oneof![4 => free, 4 => turning, 1 => sharp, 2 => steady, 1 => bound];
    // An overspeed ends the whole program, so it must be rare.
    (any, prop::bool::weighted(0.01))
        .prop_map(move |(course, wild)| if wild { course } else { course.tame(ticks) })
}

impl Course {
    /// Reduces the acceleration until V stays in its range for `ticks` ticks.
    fn tame(mut self, ticks: u32) -> Self {
        while !self.stays_in_range(ticks) {
            self = Self { a: self.a / 2, j: self.j / 2, ..self };
        }
        self
    }

    fn stays_in_range(self, ticks: u32) -> bool {
        let Self { mut v, mut a, j } = self;
        for _ in 0..ticks {
            match v.checked_add(a) {
                Some(next) if next != i64::MIN => v = next,
                _ => return false,
            }
            a = a.wrapping_add(j);
        }
        true
    }
}

/// The same courses, slow enough for the fast model to jump from edge to edge.
fn slower(ticks: u32) -> impl Strategy<Value = Course> {
    (course(ticks), 2_u32..8).prop_map(|(c, bits)| Course {
        v: c.v >> bits,
        a: c.a >> bits,
        j: c.j >> bits,
    })
}

fn row(ticks: impl Strategy<Value = u32>, slow: bool) -> impl Strategy<Value = (u32, Vec<Course>)> {
    ticks.prop_flat_map(move |ticks| {
        let axis = if slow { slower(ticks).boxed() } else { course(ticks).boxed() };
        (Just(ticks), prop::collection::vec(axis, AXES))
    })
}

/// Brings P from its start value to 2^63 from there, or one unit before or behind: residues of 0
/// and 2^64 - 1.
fn residue() -> impl Strategy<Value = Vec<(u32, Vec<Course>)>> {
    let steady = |v| Course { v, a: 0, j: 0 };
    let rows = move |off: Vec<i64>| {
        let all =
            |v: &dyn Fn(i64) -> i64| off.iter().map(|&off| steady(v(off))).collect::<Vec<_>>();
        vec![(2, all(&|_| 1 << 62)), (1, all(&|off| off))]
    };
    prop::collection::vec(-1_i64..2, AXES).prop_map(rows)
}

/// A joint move with a few rows of each kind, whose segments have up to four times `ticks` ticks,
/// followed by a clear in case an axis was too fast.
pub fn program(ticks: u32) -> impl Strategy<Value = Program> {
    let short =
        prop::collection::vec(row(prop_oneof![1 => Just(1_u32), 3 => 2_u32..40], false), 0..4);
    let dense = prop::collection::vec(row(ticks / 8..ticks, false), 0..4);
    let sparse = prop::collection::vec(row(ticks / 2..4 * ticks, true), 0..3);
    (prop::option::of(residue()), short, dense, sparse, any::<bool>()).prop_map(
        |(residue, short, dense, sparse, last)| {
            let rows: Vec<_> =
                residue.into_iter().flatten().chain(short).chain(dense).chain(sparse).collect();
            let count = rows.len();
            let mut program = Program::new();
            for (row, (ticks, axes)) in rows.into_iter().enumerate() {
                for (axis, Course { v, a, j }) in (0..).zip(axes) {
                    let segment = Segment { ticks, v, a, j, last: last && row + 1 == count };
                    program.push(Command::Segment { axis, segment });
                }
                if row == 0 {
                    program.push(Command::Start { mask: 0x3f });
                }
            }
            program.extend([Command::Wait { clocks: 200 }, Command::Clear]);
            program
        },
    )
}

//! Random programs with many edges a clock, each with something that an edge search can get wrong.

use carrystep_core::{AXES, Command, Program, Segment};
use proptest::prelude::*;

/// The greatest speed there is.
const TOP: i64 = i64::MAX;

/// One axis in one row of segments of the same length, as parts of what fits into that length.
#[derive(Debug, Clone, Copy)]
struct Course {
    v: i64,
    a: i64,
    j: i64,
}

/// A part of a whole: either sign, any magnitude, the ends more often than chance has them.
fn part() -> impl Strategy<Value = f64> {
    prop_oneof![6 => -1.0..1.0, 2 => -0.2..0.2, 1 => Just(0.0), 1 => Just(1.0), 1 => Just(-1.0)]
}

/// Speeds that divide a step into whole ticks, so that a step ends where a tick does.
fn dividing() -> impl Strategy<Value = i64> {
    (2_u32..12, -1_i64..2, any::<bool>()).prop_map(|(bits, off, back)| {
        let v = (1_i64 << (64 - bits)).min(TOP - 1) + off;
        if back { -v } else { v }
    })
}

/// Speed, acceleration and jerk that change a speed by about as much as there is, over `ticks`.
fn course(ticks: u32) -> impl Strategy<Value = Course> {
    let n = f64::from(ticks);
    let scaled = |part: f64, whole: f64| ((part * whole) as i64).max(-TOP);
    let top = TOP as f64;
    let free = (part(), part(), part()).prop_map(move |(v, a, j)| Course {
        v: scaled(v, top),
        a: scaled(a, top / n),
        j: scaled(j, top / n / n),
    });
    // There and back: V turns in mid-segment, once or twice.
    let turning = (part(), 0.1..2.0).prop_map(move |(v, sharp)| Course {
        v: scaled(v, top),
        a: scaled(-v * 4.0 * sharp, top / n),
        j: scaled(v * 8.0 * sharp, top / n / n),
    });
    // An extremum within the first ticks, and a sign that lasts for one.
    let sharp = (1_i64 << 20..1 << 59, 0.3..3.0, -2_i64..3).prop_map(|(a, ticks, off)| Course {
        v: -a / 2 + off,
        a,
        j: -((a as f64 / ticks) as i64),
    });
    let steady = dividing().prop_map(|v| Course { v, a: 0, j: 0 });
    // Just under the greatest speed, or on it.
    let bound = (0_i64..3, 0_i64..3, any::<bool>()).prop_map(|(off, a, back)| {
        let sign = if back { -1 } else { 1 };
        Course { v: sign * (TOP - off), a: sign * -a, j: 0 }
    });
    let any = prop_oneof![4 => free, 4 => turning, 1 => sharp, 2 => steady, 1 => bound];
    // An overspeed ends the whole program: it must be rare.
    (any, prop::bool::weighted(0.01)).prop_map(move |(course, wild)| if wild { course } else { course.tame(ticks) })
}

impl Course {
    /// With less and less acceleration until V stays in its range over `ticks`.
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

/// The same, slow enough for jumping to be worth while.
fn slower(ticks: u32) -> impl Strategy<Value = Course> {
    (course(ticks), 2_u32..8).prop_map(|(c, bits)| Course { v: c.v >> bits, a: c.a >> bits, j: c.j >> bits })
}

fn row(ticks: impl Strategy<Value = u32>, slow: bool) -> impl Strategy<Value = (u32, Vec<Course>)> {
    ticks.prop_flat_map(move |ticks| {
        let axis = if slow { slower(ticks).boxed() } else { course(ticks).boxed() };
        (Just(ticks), prop::collection::vec(axis, AXES))
    })
}

/// Brings P from its start value to 2^63 from there, one unit before or behind: residues of 0 and 2^64 - 1.
fn residue() -> impl Strategy<Value = Vec<(u32, Vec<Course>)>> {
    let steady = |v| Course { v, a: 0, j: 0 };
    let rows = move |off: Vec<i64>| {
        let all = |v: &dyn Fn(i64) -> i64| off.iter().map(|&off| steady(v(off))).collect::<Vec<_>>();
        vec![(2, all(&|_| 1 << 62)), (1, all(&|off| off))]
    };
    prop::collection::vec(-1_i64..2, AXES).prop_map(rows)
}

/// A joint move of a few rows of each kind, segments up to four times `ticks` long, and a clear behind it,
/// in case that it was too fast.
pub fn program(ticks: u32) -> impl Strategy<Value = Program> {
    let short = prop::collection::vec(row(prop_oneof![1 => Just(1_u32), 3 => 2_u32..40], false), 0..4);
    let dense = prop::collection::vec(row(ticks / 8..ticks, false), 0..4);
    let sparse = prop::collection::vec(row(ticks / 2..4 * ticks, true), 0..3);
    (prop::option::of(residue()), short, dense, sparse, any::<bool>()).prop_map(
        |(residue, short, dense, sparse, last)| {
            let rows: Vec<_> = residue.into_iter().flatten().chain(short).chain(dense).chain(sparse).collect();
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

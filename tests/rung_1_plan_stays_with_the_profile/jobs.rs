//! Programs in G-code: their segments land exactly, and keep speed, acceleration and jerk in exact
//! integers, in the rhythm of the engine's queues.

use carrystep_core::Segment;
use carrystep_files::Axis;
use carrystep_tests::gcode_job::{GcodeJob, shipped, short};
use num_bigint::BigInt;

/// Limits of speed, acceleration and jerk: a value x of the registers keeps one if x times the
/// first number is at most the second one. Exact, from the decimals of the machine file.
fn limits(axis: &Axis, tick_ns: u64) -> [(BigInt, BigInt); 3] {
    let whole = |text: String| text.parse::<BigInt>().expect("whole steps");
    let [speed, acceleration] = [&axis.speed_limit, &axis.accel_limit]
        .map(|limit| whole(limit.steps.normalized().to_plain_string()));
    // Without jerk_limit, J is A / 4 ms = 250 A.
    let jerk = &acceleration * 250;
    let mut power = 0;
    [speed, acceleration, jerk].map(|limit| {
        power += 1;
        let unit = BigInt::from(1) << 64;
        (BigInt::from(10).pow(9 * power), limit * unit * BigInt::from(tick_ns).pow(power))
    })
}

fn speed(s: &Segment, k: i128) -> i128 {
    i128::from(s.v) + k * i128::from(s.a) + k * (k - 1) / 2 * i128::from(s.j)
}

fn verified(job: &GcodeJob) {
    let tick_ns = job.machine.timebase.tick_ns();
    for (number, axis) in job.machine.axes.iter().enumerate() {
        let limits = limits(axis, tick_ns);
        let keeps = |kind: usize, value: i128| {
            let (unit, limit) = &limits[kind];
            assert!(BigInt::from(value.abs()) * unit <= *limit, "{}: {kind}: {value}", axis.name);
        };
        let (mut p, mut before) = (0, 0);
        for s in job.segments(number) {
            let (n, a, j) = (i128::from(s.ticks), i128::from(s.a), i128::from(s.j));
            let turn = if j == 0 { 0 } else { -a / j };
            for k in [0, n - 1, turn - 1, turn, turn + 1, turn + 2] {
                keeps(0, speed(&s, k.clamp(0, n - 1)));
            }
            let end = a + (n - 1) * j;
            for value in [a, end] {
                keeps(1, value);
            }
            keeps(2, j);
            // The acceleration jumps by at most 2 % of its limit.
            keeps(1, (a - before) * 50);
            before = end;
            p += n * i128::from(s.v) + n * (n - 1) / 2 * a + n * (n - 1) * (n - 2) / 6 * j;
        }
        assert_eq!(p, i128::from(job.survey.axes[number].steps()) << 64, "{}: landing", axis.name);
    }
}

#[test]
fn programs_land_within_their_limits() {
    verified(&short());
    for name in ["square_and_arc.ngc", "chords_and_star.ngc", "trochoid.ngc", "relief.ngc"] {
        verified(&shipped(name));
    }
}

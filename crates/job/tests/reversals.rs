//! Reversals within a run: DIR set-up and hold fit between the edges of STEP, wherever the reversal
//! is. The reversal is brought as near to a step's place as numbers allow.

use crate::common;
use carrystep_job::{Element, Item, Planner, Row, Tolerance, rows};

/// DIR set-up and hold of the driver, ticks.
const QUIET: i64 = 20;

const MACHINE: &str = "[machine]\nclock_hz = 80_000_000\ntick_ns = 1000\n\
    [[machine.axis]]\nname = \"x\"\nsteps_per_unit = 80\nspeed_limit = 100\naccel_limit = 1000\n\
    step_ns = 1000\ngap_ns = 1000\nsetup_ns = 20000\nhold_ns = 20000\n";

/// The rows of a way to `x` and back.
fn planned(x: f64) -> Vec<Row> {
    let machine = common::machine(MACHINE);
    let planner = Planner::new(&machine, 1, &[0.0]).unwrap();
    let to = |x: f64| {
        Item::Move(Element {
            to: vec![x],
            arc: None,
            feed: Some(50.0),
            tolerance: Tolerance { linear: 0.01, rotary: 0.01 },
            line: 1,
            block: 0,
        })
    };
    rows(planner, [to(x), to(0.0)]).collect::<Result<_, _>>().unwrap()
}

/// Runs all ticks: the greatest place, and the least ticks between an edge and a change of the sign
/// of V.
fn run(rows: &[Row]) -> (i128, i64) {
    let (mut p, mut now, mut most, mut sign) = (1_i128 << 63, 0_i64, 0_i128, 0);
    let (mut edge, mut turn, mut least) = (i64::MIN / 2, i64::MIN / 2, i64::MAX);
    for row in rows {
        let segment = &row.segments[0];
        let (mut v, mut a) = (i128::from(segment.v), i128::from(segment.a));
        for _ in 0..row.ticks {
            if v != 0 && v.signum() != sign {
                sign = v.signum();
                turn = now;
                least = least.min(turn - edge);
            }
            let before = p >> 64;
            p += v;
            if p >> 64 != before {
                edge = now;
                least = least.min(edge - turn);
            }
            most = most.max(p);
            v += a;
            a += i128::from(segment.j);
            now += 1;
        }
    }
    (most, least)
}

#[test]
fn dir_set_up_and_hold_fit_at_a_reversal_on_a_steps_place() {
    let (mut low, mut high) = (1.0, 1.0125);
    let place = |x: f64| run(&planned(x)).0 >> 64;
    let first = place(low);
    assert_eq!(place(high), first + 1, "one step's place is between them");
    for _ in 0..42 {
        let middle = (low + high) / 2.0;
        for x in [low, middle, high] {
            let (_, least) = run(&planned(x));
            assert!(least >= QUIET, "{x}: an edge {least} ticks from a reversal");
        }
        if place(middle) == first { low = middle } else { high = middle }
    }
}

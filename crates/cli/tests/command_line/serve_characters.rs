//! Real-time characters at random times, judged by the pulses: the tool stays on the path, and no
//! axis exceeds its limits, whatever came when. Run with `CARRYSTEP_CHARACTERS=N` for more of them.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::sender::{Sender, Served, is_answer};
use crate::serve_holds::SQUARE;
use crate::serve_streams::{edges, folder};
use crate::virtual_boards::Board;
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng as _, SeedableRng as _};
use std::time::Duration;

/// A side of the square, steps.
const SIDE: i64 = 4 * STEPS;

/// Of the machine of these tests: steps per mm, and mm/s2.
const STEPS: i64 = 80;
const ACCELERATION: f64 = 1000.0;
/// F1200, mm/s. The axes could move faster.
const FEED: f64 = 20.0;

/// Time between two looks at the speed, ps.
const LOOK: u64 = 20_000_000_000;

/// The places of the tool, steps, with the times at which it came there, ps.
fn places(vcd: &str) -> Vec<(u64, [i64; 2])> {
    let (mut at, mut way) = ([0, 0], [1, 1]);
    let mut places = vec![(0, at)];
    for (time, edge) in edges(vcd) {
        for (axis, letter) in [(0, "x"), (1, "y")] {
            match edge.strip_prefix(letter) {
                Some(".dir0") => way[axis] = 1,
                Some(".dir1") => way[axis] = -1,
                Some(".step1") => {
                    at[axis] += way[axis];
                    places.push((time, at));
                }
                _ => {}
            }
        }
    }
    places
}

/// The greatest distance from the square, steps.
const NEAR: i64 = 2;

/// Checks each pulse: the tool is on the square, within [`NEAR`].
fn check_path(places: &[(u64, [i64; 2])]) {
    let near = |value: i64, to: i64| (value - to).abs() <= NEAR;
    let within = |value: i64| (-NEAR..=SIDE + NEAR).contains(&value);
    for &(time, [x, y]) in places {
        let on_x = (near(x, 0) || near(x, SIDE)) && within(y);
        let on_y = (near(y, 0) || near(y, SIDE)) && within(x);
        assert!(on_x || on_y, "the tool is at {x}, {y} steps at {time} ps");
    }
}

/// Checks the speed of an axis in each time of [`LOOK`], and its change to the next one. A place is
/// known within a step.
fn check_limits(places: &[(u64, [i64; 2])], axis: usize) -> (f64, f64) {
    let (mut speeds, mut from, mut next) = (Vec::new(), places[0].1[axis], 0);
    let seconds = LOOK as f64 * 1e-12;
    let end = places.last().unwrap().0;
    for time in (LOOK..end + 2 * LOOK).step_by(LOOK as usize) {
        while places.get(next).is_some_and(|place| place.0 <= time) {
            next += 1;
        }
        let at = places[next.max(1) - 1].1[axis];
        speeds.push((at - from) as f64 / STEPS as f64 / seconds);
        from = at;
    }
    let step = 1.0 / STEPS as f64 / seconds;
    let fastest = speeds.iter().fold(0.0, |most: f64, speed| most.max(speed.abs()));
    assert!(fastest <= FEED + step, "axis {axis}: {fastest} mm/s");
    let change = |two: &[f64]| (two[1] - two[0]).abs() / seconds;
    let hardest = speeds.windows(2).map(change).fold(0.0, f64::max);
    assert!(hardest <= ACCELERATION + 2.0 * step / seconds, "axis {axis}: {hardest} mm/s2");
    (fastest, hardest)
}

/// Back to the start along the sides of the square, from a place on it, mm.
fn way_back(at: &[f64]) -> &'static str {
    let is_far = |place: f64| place > (SIDE - NEAR) as f64 / STEPS as f64;
    match (is_far(at[0]), is_far(at[1])) {
        (_, true) => "G90 G21 G61 G1 X0 F1200\nG1 Y0",
        (true, false) => "G90 G21 G61 G1 Y0 F1200\nG1 X0",
        (false, false) => "G90 G21 G61 G1 X0 Y0 F1200",
    }
}

#[test]
fn characters_at_random_times_break_no_limit() {
    let wanted = std::env::var("CARRYSTEP_CHARACTERS").map_or(6, |count| count.parse().unwrap());
    let folder = folder();
    let board = Board::new(&folder, "--fast --vcd a.vcd");
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let mut sender = Sender::tcp(&served);
    let mut random = SplitMix64::seed_from_u64(21);
    let mut below = |count: u32| random.next_u32() % count;
    for _ in 0..wanted {
        sender.send(format!("{SQUARE}\n"));
        std::thread::sleep(Duration::from_micros(u64::from(below(150_000))));
        match [b'!', 0x18, 0x85, 0x84][below(4) as usize] {
            0x18 => {
                sender.send([0x18]);
                sender.until(|line| line.starts_with("Grbl 1.1"));
                let at = sender.place();
                sender.simple(way_back(&at));
            }
            other => {
                sender.send([other]);
                std::thread::sleep(Duration::from_micros(u64::from(below(30_000))));
                let all_answered = SQUARE.lines().count();
                (0..all_answered).for_each(|_| assert_eq!(sender.until(is_answer), "ok"));
                // A resume while the axes still slow down is one, too.
                while !sender.report().starts_with("<Idle|") {
                    sender.send("~");
                    std::thread::sleep(Duration::from_millis(2));
                }
            }
        }
        assert_eq!(sender.place(), [0.0; 3]);
    }
    assert_eq!(served.interrupt().0, 0);
    board.end();
    let vcd = std::fs::read_to_string(folder.path("a.vcd")).unwrap();
    let places = places(&vcd);
    assert!(places.len() > 100 * wanted as usize, "{}", places.len());
    check_path(&places);
    let of_axes = [0, 1].map(|axis| check_limits(&places, axis));
    let fastest = of_axes.iter().fold(0.0, |most: f64, axis| most.max(axis.0));
    let hardest = of_axes.iter().fold(0.0, |most: f64, axis| most.max(axis.1));
    eprintln!(
        "FIGURES {wanted} characters, {} pulses on the path; at most {fastest:.1} mm/s and \
         {hardest:.0} mm/s2 of {FEED} and {ACCELERATION}",
        places.len() - 1
    );
}

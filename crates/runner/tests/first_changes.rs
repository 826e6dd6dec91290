//! From the request of a hold to the pulses that it changes: at most 40 ms and the round trip of the
//! line where the queues can be cut, and at most 150 ms where they cannot, in all programs of
//! `sim/jobs`, with and without an override in force.
//!
//! ```text
//! pulses   | | | | | | | | | | | |  |  |   |      |    |  |  | | | |     held
//!          | | | | | | | | | | | | | | | | | | |                          not held
//!              ^ asked        ^ last pulse as planned
//! ```
//!
//! Behind a hold, the pulses are those of before, only later, so that one run has many holds.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::jobs::{Job, PROGRAMS, Run};
use crate::support::random::Random;
use carrystep_link::{Ended, Wish};
use carrystep_model::fast::{Change, Edge};
use carrystep_runner::OverrideSetting;
use carrystep_virtual_board::SimulatedBoard as _;

/// The time between two tries of a hold that the limits forbid, as in `carrystep run`, ms.
const TRY_AGAIN: u64 = 20;

/// What the queues hold, and the time of a program from its greatest speed to its end, ms.
const REST: f64 = 400.0;

/// How much of each program is run, ms.
const MS: u64 = 3000;

/// Baud rates. With the slow one, three axes have rows of 16 ms.
const LINES: [u32; 2] = [921_600, 115_200];

/// What the line itself takes: an exchange lasts a millisecond each way, a row one more.
const ROUND_TRIP: f64 = 4.0;

/// Runs a program up to this time, ms of the board's, and holds it at random moments; returns the
/// clocks of the requests, too.
fn run(job: &Job, feed: u8, until: u64, mut random: Option<Random>) -> (Run, Vec<u64>) {
    let mut asked: Vec<u64> = Vec::new();
    let (mut stretches, mut next, mut next_try) = (0, 0, 0);
    let run = job.run_with(
        |way| {
            let wanted = OverrideSetting { feed, ..OverrideSetting::NONE };
            way.borrow_mut().set_overrides(wanted);
        },
        |end, way, progress| {
            let (now, loads) = {
                let board = &end.0.borrow().board;
                (board.cycle(), board.loads().len())
            };
            if now >= until * job.ms() {
                return Wish::Stop;
            }
            // What the stop changes is not taken for what a hold has changed.
            let is_late = now + 400 * job.ms() > until * job.ms();
            let Some(random) = random.as_mut().filter(|_| !is_late) else { return Wish::GoOn };
            if stretches != loads {
                (stretches, next) = (loads, now + (200 + random.below(200)) * job.ms());
                next_try = next;
            }
            let mut way = way.borrow_mut();
            if loads == 0 || now < next_try || way.is_held() || progress.handed_over {
                return Wish::GoOn;
            }
            if asked.last().is_none_or(|&asked| asked < next) {
                asked.push(now);
            }
            next_try = now + TRY_AGAIN * job.ms();
            match progress.queues {
                Some(queues) => way.hold_in(queues).map_or(Wish::GoOn, |keep| Wish::Cut { keep }),
                None => {
                    way.hold();
                    Wish::GoOn
                }
            }
        },
    );
    assert!(matches!(run.ended, Ok(Ended::Done | Ended::Stopped)), "{}: {:?}", job.name, run.ended);
    (run, asked)
}

/// The pulses of a run with the number of each on its axis, in their order.
fn pulses(edges: &[Edge]) -> Vec<(u64, u8, usize)> {
    let mut counts = [0; 8];
    let rises = edges.iter().filter(|edge| edge.change == Change::Rise);
    rises
        .map(|edge| {
            counts[usize::from(edge.axis)] += 1;
            (edge.clock, edge.axis, counts[usize::from(edge.axis)] - 1)
        })
        .collect()
}

/// How long after each request the last pulse came that was still as planned, ms. Where an axis has
/// pulses only now and then, the first changed one comes later than that, and none between is as
/// planned.
fn last_as_planned(job: &Job, feed: u8, seed: u64) -> Vec<f64> {
    let planned = match feed {
        100 => job.simulated(MS * 1_000_000 / job.machine.timebase.tick_ns()).edges,
        _ => run(job, feed, MS, None).0.edges,
    };
    let mut times = [const { Vec::new() }; 8];
    for (clock, axis, _) in pulses(&planned) {
        times[usize::from(axis)].push(clock);
    }
    let (held, asked) = run(job, feed, MS, Some(Random::new(seed)));
    let (seen, run_is_done) = (pulses(&held.edges), held.ended == Ok(Ended::Done));
    // By how much a pulse is later than planned.
    let late = |&(clock, axis, number): &(u64, u8, usize)| {
        let planned = times[usize::from(axis)].get(number)?;
        Some(clock.cast_signed() - planned.cast_signed())
    };
    let found = asked.iter().filter_map(|&asked| {
        let first = seen.partition_point(|&(clock, ..)| clock <= asked);
        let before = late(&seen[first.checked_sub(1)?])?;
        let rest = seen[first..].iter();
        let changed = rest.take_while(|pulse| late(pulse) == Some(before)).count();
        let last = seen[first + changed - 1].0.saturating_sub(asked) as f64 / job.ms() as f64;
        // Where the program slows down to its end with its whole acceleration, no hold is sooner.
        let ends = first + changed == seen.len() && run_is_done;
        assert!(!ends || last < REST, "{}: {last} ms to the end, and no hold", job.name);
        (!ends).then_some(last)
    });
    found.collect()
}

/// Asserts the bound for holds of these programs, and gives the number of those that were measured.
fn assert_bound(
    programs: &[(&'static str, &str)],
    (cuts, baud, feed): (bool, u32, u8),
    most: f64,
) -> usize {
    let mut holds = 0;
    for (seed, program) in (2026..).zip(programs) {
        let lines = format!("queue_depth = 31\ncuts = {cuts}\nlink.baud = {baud}\n");
        let job = Job::new(*program, &lines);
        let mut found = last_as_planned(&job, feed, seed);
        found.retain(|&ms| ms > 0.0);
        found.sort_by(f64::total_cmp);
        let name = format!("{}, cuts {cuts}, {baud} baud, {feed} %", job.name);
        eprintln!("{name}: {found:.1?} ms");
        assert!(found.iter().all(|&ms| ms <= most), "{name}: {found:?} ms, at most {most} wanted");
        holds += found.len();
    }
    holds
}

/// The programs of `sim/jobs`: without the one that waits for a tool.
fn programs() -> Vec<(&'static str, &'static str)> {
    PROGRAMS.into_iter().filter(|(name, _)| name.starts_with("jobs/")).collect()
}

#[test]
fn hold_cuts_the_queues_and_changes_the_pulses_within_40_ms() {
    let holds = assert_bound(&programs(), (true, LINES[0], 100), 40.0 + ROUND_TRIP);
    assert!(holds >= 12, "{holds} holds");
}

#[test]
fn hold_under_an_override_changes_the_pulses_within_40_ms() {
    let holds = assert_bound(&programs()[2..5], (true, LINES[0], 50), 40.0 + ROUND_TRIP);
    assert!(holds >= 8, "{holds} holds");
}

/// The queues hold 124 ms or, on the slow line, half a second, and are not filled.
#[test]
fn hold_without_cuts_changes_the_pulses_within_150_ms() {
    let holds = assert_bound(&programs(), (false, LINES[0], 100), 150.0)
        + assert_bound(&programs()[..3], (false, LINES[1], 100), 150.0);
    assert!(holds >= 12, "{holds} holds");
}

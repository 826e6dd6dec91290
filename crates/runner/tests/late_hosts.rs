//! A computer that is late by up to half the horizon changes no pulse: the host of a program is
//! delayed at many random moments, and every edge stays where it is without a delay.
//!
//! ```text
//! queues    full ...... half ....... full ......... half      each delay: half of what they hold
//! host      sends, late ------------>  sends, late -------->
//! ```
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::jobs::{Job, PROGRAMS, Run};
use crate::repeats;
use crate::support::random::Random;
use carrystep_core::engine::Cause;
use carrystep_link::{Ended, HostError, Wish};
use carrystep_runner::Horizon;
use carrystep_virtual_board::SimulatedBoard as _;

/// The programs that last less than 15 s.
const SHORT: usize = 5;

/// Queues, with and without the cuts of holds.
const QUEUES: [(u64, bool); 4] = [(7, false), (7, true), (31, false), (31, true)];

/// A program with its machine, but for these queues.
fn job(program: (&'static str, &str), (depth, cuts): (u64, bool)) -> Job {
    Job::new(program, &format!("queue_depth = {depth}\ncuts = {cuts}\n"))
}

/// Runs a program with a host that is late: `late` gives the length of a delay that begins now, ms of
/// the board's time from the first start, and the time until the next one. Returns the number of
/// delays, too.
fn run(job: &Job, mut late: impl FnMut(u64) -> Option<(u64, u64)>) -> (Run, u64) {
    let (mut delays, mut next) = (0, 0);
    let run = job.run(|end, _, progress| {
        let begun = end.0.borrow().board.loads().first().copied();
        let Some(begun) = begun.filter(|_| !progress.handed_over) else { return Wish::GoOn };
        let now = (end.0.borrow().board.cycle() - begun) / job.ms();
        if now >= next
            && let Some((delay, pause)) = late(now)
        {
            end.wait(delay);
            (delays, next) = (delays + 1, now + delay + pause);
        }
        Wish::GoOn
    });
    (run, delays)
}

/// An ordinary run takes a third of the queues, others for each program. The edges without a delay
/// are those of `simulate` (`pulses_of_simulate.rs`).
#[test]
fn host_late_by_up_to_half_the_horizon_changes_no_edge() {
    let mut random = Random::new(2026);
    for (number, program) in PROGRAMS[..SHORT].iter().enumerate() {
        let shipped = Job::new(*program, "");
        let in_time = shipped.simulated(u64::MAX);
        let some = if repeats::in_full() { 1 } else { 3 };
        for queues in QUEUES.into_iter().skip(number % some).step_by(some) {
            let job = job(*program, queues);
            let name = format!("{} with queues of {queues:?}", job.name);
            let half = Horizon::of_board(queues.0, queues.1).ms() / 2;
            // In the time between two delays, the line fills the queues again.
            let (run, delays) = run(&job, |_| {
                let delay = if random.below(2) == 0 { half } else { 1 + random.below(half) };
                Some((delay, half / 2 + random.below(2 * half)))
            });
            assert_eq!(run.ended, Ok(Ended::Done), "{name}");
            let late = job.seen(&run, u64::MAX);
            assert_eq!(late.difference(&in_time), None, "{name}: late, not late");
            assert!(delays >= 6 && late.edges.len() > 5000, "{name}: {delays} delays");
            eprintln!("{name}: {delays} delays of up to {half} ms, {} edges", late.edges.len());
        }
    }
}

/// The delays reach the board: a longer one lets the queues run dry. The watchdog is set to act
/// later.
#[test]
fn host_late_by_more_than_the_horizon_lets_the_queues_run_dry() {
    for queues in QUEUES {
        let (depth, cuts) = queues;
        let queue = format!("queue_depth = {depth}\ncuts = {cuts}\nguard.watchdog_ms = 400\n");
        let job = Job::new(PROGRAMS[0], &queue);
        // The segment that runs lasts 4 ms, and some more may be on the line.
        let delay = Horizon::of_board(queues.0, queues.1).ms() + 32;
        let (run, delays) = run(&job, |now| (now >= 1000).then_some((delay, u64::MAX / 2)));
        let Err(HostError::Fault { cause, .. }) = run.ended else { panic!("{:?}", run.ended) };
        assert_eq!((cause, delays), (Cause::Underrun as u8, 1), "{queues:?}");
    }
}

//! `run` and `simulate` make the same pulses: each edge of STEP and DIR, and each change of an
//! output, of the shipped programs on a board of models is that of the fast model, clock by clock
//! from the first start. Behind a place where the program waits, clocks are counted from the start
//! of the stretch, because a board may rest there for any time.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::jobs::{Job, PROGRAMS};
use crate::repeats;
use crate::support::asked;
use carrystep_link::{Ended, Wish};
use carrystep_virtual_board::SimulatedBoard as _;

/// How much of each program is compared in a run of repeats, seconds of the program.
const SECONDS: u64 = 8;

#[test]
fn pulses_of_run_are_those_of_simulate() {
    let seconds = asked("CARRYSTEP_PROGRAM_SECONDS", repeats::part(SECONDS, 2));
    let (mut edges, mut levels, mut ran) = (0, 0, 0.0);
    for program in PROGRAMS {
        let job = Job::new(program, "");
        let (name, clocks) = (job.name, seconds.saturating_mul(1000 * job.ms()));
        let until = seconds.saturating_mul(1_000_000_000) / job.machine.timebase.tick_ns();
        let simulated = job.simulated(until);
        let run = job.run(|end, _, _| {
            let board = &end.0.borrow().board;
            let ran = board.loads().first().map_or(0, |load| board.cycle() - load);
            if ran < clocks { Wish::GoOn } else { Wish::Stop }
        });
        let ended = matches!(run.ended, Ok(Ended::Done | Ended::Stopped));
        assert!(ended, "{name}: {:?}", run.ended);
        let seen = job.seen(&run, until);
        assert_eq!(seen.difference(&simulated), None, "{name}: run, simulate");
        // A capture of nothing would be equal, too.
        assert!(seen.edges.len() > 5000, "{name}: {} edges", seen.edges.len());
        edges += seen.edges.len();
        levels += seen.levels.len();
        ran += job.seconds().min(seconds as f64);
    }
    assert!(levels >= 8, "{levels} changes of outputs");
    eprintln!(
        "FIGURES {} programs, {ran:.0} s: {edges} edges of STEP and DIR and {levels} changes of \
         outputs, each in the clock of the fast model",
        PROGRAMS.len()
    );
}

/// The same over SPI, with cuts: a program with arcs, and in a run of repeats one that switches
/// outputs.
#[test]
fn pulses_of_run_on_an_spi_are_those_of_simulate() {
    for program in &PROGRAMS[..repeats::part(2, 2)] {
        let job = Job::new(*program, "cuts = true\n");
        let seconds = repeats::part(SECONDS, 8);
        let clocks = seconds * 1000 * job.ms();
        let until = seconds * 1_000_000_000 / job.machine.timebase.tick_ns();
        let run = job.run_on_bus(9_600_000, |bus| {
            let board = &bus.0.borrow().board;
            let ran = board.loads().first().map_or(0, |load| board.cycle() - load);
            if ran < clocks { Wish::GoOn } else { Wish::Stop }
        });
        let seen = job.seen(&run, until);
        assert_eq!(seen.difference(&job.simulated(until)), None, "{}", job.name);
        assert!(seen.edges.len() > 5000, "{}: {} edges", job.name, seen.edges.len());
    }
}

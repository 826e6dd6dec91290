//! The fast engine is the clock-by-clock one, whatever stops it.

use crate::leaps;
use carrystep_core::engine::{Cause, Guard, InputRow, LimitWiring};
use carrystep_core::{Command, EngineBuild, PinTiming, Program, Segment, StartPhase};
use carrystep_simulators::Level;
use carrystep_simulators::engine::{Event, Events};
use carrystep_tests::engine_twins::{self, Came};
use carrystep_tests::{
    dense, effort, engine_builds, engine_programs, gcode_job, lockstep, moves, repeats,
};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;

/// Compares the engines under programs with events; returns the counts.
fn engines(
    build: &EngineBuild,
    cases: u32,
    programs: impl Strategy<Value = (Program, Events)>,
) -> Came {
    let sum = Cell::new(Came::default());
    let mut runner = TestRunner::new(Config { cases, max_shrink_iters: 300, ..Config::default() });
    let held = runner.run(&(programs, leaps()), |((program, events), leaps)| {
        let (program, events) = engine_programs::in_ticks_of(build, program, events);
        let came = engine_twins::run(build, &program, &events, &leaps, 500_000)
            .map_err(TestCaseError::fail)?;
        sum.set(sum.get().and(came));
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}\n of {build:?}"));
    effort::say(&format!("{:?}", sum.get()));
    sum.get()
}

/// E-stop, limits, stops and silence of the host occur in any clock, whatever the host does.
fn stops_at_any_clock(axes: usize, clock_hz: u64, phases: u32, limits: LimitWiring, round: u32) {
    let build = engine_builds::build(axes, clock_hz, phases, StartPhase::Half, limits);
    // A round of two ticks has no room for other inputs than limits.
    let inputs = if round < 4 { [InputRow::default(); 2] } else { build.guard.inputs };
    let guard = Guard { round, watchdog: 80 / round, inputs, ..build.guard.clone() };
    let came = engines(&EngineBuild { guard, ..build }, 100, engine_programs::program(axes));
    // Not every cause must occur, because an overspeed can freeze the engine before another cause.
    let causes = came.faults.iter().filter(|count| **count > 0).count();
    assert!(came.taken > 1000, "{came:?}");
    assert!(came.leapt > came.clocks / 3 && came.edges > 1000 && causes >= 7, "{came:?}");
}

#[test]
fn an_engine_with_a_pair_of_limits_for_each_axis() {
    stops_at_any_clock(6, 80_000_000, 16, LimitWiring::Pair, 2);
}

#[test]
fn an_engine_with_many_ticks_between_samples_of_limits() {
    stops_at_any_clock(6, 80_000_000, 1, LimitWiring::Pair, 16);
}

#[test]
fn an_engine_whose_limits_freeze_the_axes() {
    stops_at_any_clock(6, 80_000_000, 16, LimitWiring::Each, 4);
}

#[test]
fn an_engine_of_eight_axes() {
    stops_at_any_clock(8, 112_000_000, 4, LimitWiring::One, 2);
}

#[test]
fn an_engine_with_several_adders() {
    for (axes, adders, clock_hz, phases, limits) in [
        (6, 6, 16_000_000, 4, LimitWiring::Pair),
        (6, 2, 42_000_000, 1, LimitWiring::Each),
        (8, 8, 48_000_000, 16, LimitWiring::One),
    ] {
        let build = engine_builds::build(axes, clock_hz, phases, StartPhase::Half, limits);
        let build = engine_builds::on_adders(build, adders);
        let came = engines(&build, 20, engine_programs::program(axes));
        assert!(came.taken > 0 && came.edges > 0, "{came:?}");
        assert!(came.leapt > came.clocks / 3, "{came:?}");
    }
}

/// The host kicks the watchdog in each clock of the ticks about the one in which it would have
/// ended; before, in and after that clock.
#[test]
fn a_kick_in_each_clock_about_the_end_of_the_watchdog() {
    for (adders, clock_hz) in [(1, 80_000_000), (6, 16_000_000)] {
        let build = engine_builds::build(6, clock_hz, 4, StartPhase::Half, LimitWiring::None);
        let guard = Guard { watchdog: 3, ..build.guard.clone() };
        let build = engine_builds::on_adders(EngineBuild { guard, ..build }, adders);
        let tick = u64::from(build.timebase.clocks_per_tick());
        let end = u64::from(build.guard.watchdog * build.guard.round) * tick;
        let segment = Segment { ticks: 200, v: 1 << 60, a: 0, j: 0, last: true };
        let program = vec![Command::Segment { axis: 0, segment }, Command::Start { mask: 1 }];
        let mut stops = 0;
        for kick in end - tick..end + 2 * tick {
            for leaps in [[1, u64::MAX], [u64::MAX, 7]] {
                let events = vec![(0, Event::Kick), (kick, Event::Kick)];
                let came = engine_twins::run(&build, &program, &events, &leaps, end + 40 * tick)
                    .unwrap_or_else(|error| panic!("{adders} adders, kick in {kick}: {error}"));
                stops += came.faults[Cause::Watchdog as usize];
            }
        }
        assert!(stops >= 6 * tick, "{stops} stops of {} runs", 6 * tick);
    }
}

#[test]
fn an_engine_with_several_latches() {
    for count in [2, 4] {
        let build = engine_builds::build(6, 80_000_000, 16, StartPhase::Half, LimitWiring::Pair);
        let build = engine_builds::with_latches(build, count);
        let came = engines(&build, repeats::part(60, 2), engine_programs::program_with_latches(6));
        assert!(came.leapt > came.clocks / 3 && came.edges > 1000, "{came:?}");
    }
}

/// Each program contains a situation that the search for edges could get wrong.
#[test]
fn an_engine_of_many_edges() {
    let build = engine_builds::build(6, 80_000_000, 16, StartPhase::Zero, LimitWiring::None);
    let guard = Guard { watchdog: 0, ..build.guard.clone() };
    let build = EngineBuild { guard, pins: vec![PinTiming::SHORTEST; 6], ..build };
    let programs = dense::program(500)
        .prop_map(|program| (engine_programs::queued_first(program), Events::new()));
    let cases = repeats::part(100, 5);
    let came = engines(&build, cases, programs);
    let underruns = came.faults[Cause::Underrun as usize];
    assert!(came.edges > 300 * u64::from(cases) && underruns > 0, "{came:?}");
}

#[test]
fn a_program_in_gcode() {
    let job = gcode_job::short();
    let program = (&job.program(), job.survey.ticks);
    lockstep::assert_engine_runs(Level::Fast, &job.engine(), program, job.steps());
}

#[test]
fn the_demo_and_every_profile() {
    for name in ["demo", "curves"] {
        lockstep::assert_engine_equals_model(Level::Fast, &moves::on_the_engine(name));
    }
}

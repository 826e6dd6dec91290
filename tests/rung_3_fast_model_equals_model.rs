//! Rung 3: the fast model is the clock-by-clock model: the same registers wherever it stops, the same edges
//! (ten million of them and more), the same outputs in every clock.

use carrystep_levels::engine::Events;
use carrystep_levels::{Job, Level};
use carrystep_spec::engine::{Cause, Guard, Limits};
use carrystep_spec::{AXES, Build, EngineBuild, PinTiming, Program, StartPhase};
use carrystep_tests::engine_twins::{self, Came};
use carrystep_tests::golden::{Case, engine_vectors};
use carrystep_tests::twins::Twins;
use carrystep_tests::{dense, effort, engine_programs, lockstep, moves, programs};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;

fn random_programs(phases: u32, phase: StartPhase, cases: u32) {
    let build = lockstep::tight_build(phases, phase);
    let mut runner = TestRunner::new(Config { cases, ..Config::default() });
    let held = runner.run(&programs::program(), |program| {
        lockstep::assert_equals_model(Level::Fast, &lockstep::job(&build, &program));
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn random_programs_at_16_phases() {
    random_programs(16, StartPhase::Half, 3000);
}

#[test]
fn random_programs_at_4_phases() {
    random_programs(4, StartPhase::Zero, 1000);
}

#[test]
fn random_programs_at_1_phase() {
    random_programs(1, StartPhase::Half, 1000);
}

#[test]
fn the_demo() {
    for plan in [moves::demo(), moves::demo_at_48_mhz()] {
        lockstep::assert_equals_model(Level::Fast, &Job::new(&plan.build, &plan.program(), plan.total_ticks()));
    }
}

#[test]
fn the_demo_and_every_profile_on_the_engine() {
    for name in ["demo", "curves"] {
        lockstep::assert_engine_equals_model(Level::Fast, &moves::on_the_engine(name));
    }
}

/// On the pins: the cases of one start phase side by side, one on each axis.
#[test]
fn golden_vectors_to_the_last_edge_and_phase() {
    let all = engine_vectors();
    for phase in [StartPhase::Half, StartPhase::Zero] {
        let cases: Vec<&Case> = all.iter().filter(|case| case.phase() == phase).collect();
        let build = lockstep::quick_build(16, phase);
        let (program, ticks) = moves::side_by_side(&cases);
        let record = lockstep::record(Level::Fast, &Job::new(&build, &program, ticks)).expect("the fast model");
        for (axis, case) in cases.iter().enumerate() {
            case.assert_edges(&lockstep::edges_on_the_pins(&build, &record, axis));
        }
    }
}

/// Lengths of leaps: to the end of what can be leapt over, and stops in any clock.
fn leaps() -> impl Strategy<Value = Vec<u64>> {
    prop_oneof![2 => Just(vec![u64::MAX]), 1 => prop::collection::vec(1_u64..5000, 1..20)]
}

/// Dense programs on a build; how many edges they made.
fn dense_programs(build: &Build, ticks: u32, cases: u32) -> u64 {
    let edges = Cell::new(0);
    let mut runner = TestRunner::new(Config { cases, max_shrink_iters: 500, ..Config::default() });
    let held = runner.run(&(dense::program(ticks), leaps()), |(program, leaps)| {
        let mut twins = Twins::new(build, leaps);
        twins.feed(&program, 300).map_err(TestCaseError::fail)?;
        edges.set(edges.get() + twins.edges);
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
    edges.get()
}

/// Pins that never delay a step: all edges of the accumulators come through.
#[test]
fn ten_million_edges_with_fast_pins() {
    let edges = dense_programs(&lockstep::quick_build(16, StartPhase::Half), 20_000, 400);
    assert!(edges >= 5_000_000, "only {edges} edges");
}

#[test]
fn ten_million_edges_from_zero_phase() {
    let edges = dense_programs(&lockstep::quick_build(4, StartPhase::Zero), 20_000, 400);
    assert!(edges >= 5_000_000, "only {edges} edges");
}

/// Pins that delay steps and turns, and overrun.
#[test]
fn registers_with_slow_pins() {
    let slow = PinTiming { width: 12, gap: 20, setup: 30, hold: 70 };
    let build = Build { pins: [slow; AXES], ..lockstep::tight_build(16, StartPhase::Half) };
    let edges = dense_programs(&build, 500, 400);
    assert!(edges >= 10_000, "only {edges} edges");
}

/// The engine under programs and what happens around them; how far they came.
fn engines(build: &EngineBuild, cases: u32, programs: impl Strategy<Value = (Program, Events)>) -> Came {
    let sum = Cell::new(Came::default());
    let mut runner = TestRunner::new(Config { cases, max_shrink_iters: 300, ..Config::default() });
    let held = runner.run(&(programs, leaps()), |((program, events), leaps)| {
        let came = engine_twins::run(build, &program, &events, &leaps, 500_000).map_err(TestCaseError::fail)?;
        sum.set(sum.get().and(came));
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}\n of {build:?}"));
    effort::say(&format!("{:?}", sum.get()));
    sum.get()
}

/// The e-stop, limits, stops and silence at any clock, whatever the host does.
fn stops_at_any_clock(axes: usize, clock_hz: u64, phases: u32, limits: Limits, round: u32) {
    let build = engine_programs::build(axes, clock_hz, phases, StartPhase::Half, limits);
    let guard = Guard { round, watchdog: 80 / round, ..build.guard.clone() };
    let came = engines(&EngineBuild { guard, ..build }, 100, engine_programs::program(axes));
    // An overspeed freezes first; promises of the rest are kept by others.
    let causes = came.faults.iter().filter(|count| **count > 0).count();
    assert!(came.leapt > came.clocks / 3 && came.edges > 1000 && causes >= 7, "{came:?}");
}

#[test]
fn an_engine_with_a_pair_of_limits_for_each_axis() {
    stops_at_any_clock(6, 80_000_000, 16, Limits::Pair, 2);
}

#[test]
fn an_engine_with_looks_far_between() {
    stops_at_any_clock(6, 79_000_000, 1, Limits::Pair, 16);
}

#[test]
fn an_engine_that_limits_freeze() {
    stops_at_any_clock(6, 80_000_000, 16, Limits::Each, 4);
}

#[test]
fn an_engine_of_eight_axes() {
    stops_at_any_clock(8, 112_000_000, 4, Limits::One, 2);
}

/// Each with something that an edge search can get wrong.
#[test]
fn an_engine_of_many_edges() {
    let build = engine_programs::build(6, 80_000_000, 16, StartPhase::Zero, Limits::None);
    let guard = Guard { watchdog: 0, ..build.guard.clone() };
    let build = EngineBuild { guard, pins: vec![PinTiming::SHORTEST; 6], ..build };
    let programs = dense::program(500).prop_map(|program| (engine_programs::queued_first(program), Events::new()));
    let came = engines(&build, 100, programs);
    let underruns = came.faults[Cause::Underrun as usize];
    assert!(came.edges > 30_000 && underruns > 0, "{came:?}");
}

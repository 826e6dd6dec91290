//! The fast parallel core is the clock-by-clock one: registers, edges and outputs.

use crate::leaps;
use carrystep_core::{AXES, Build, PinTiming, StartPhase};
use carrystep_simulators::{Job, Level};
use carrystep_tests::golden::{Case, engine_vectors};
use carrystep_tests::twins::Twins;
use carrystep_tests::{dense, effort, lockstep, moves, programs, repeats};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;

fn random_programs(phases: u32, phase: StartPhase, cases: u32) {
    let build = lockstep::tight_build(phases, phase);
    let mut runner =
        TestRunner::new(Config { cases: repeats::part(cases, 3), ..Config::default() });
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
        lockstep::assert_equals_model(
            Level::Fast,
            &Job::new(&plan.build, &plan.program(), plan.total_ticks()),
        );
    }
}

/// The cases of one start phase run side by side, one on each axis, and the edges are taken from
/// the pins.
#[test]
fn golden_vectors_to_the_last_edge_and_phase() {
    let all = engine_vectors();
    for phase in [StartPhase::Half, StartPhase::Zero] {
        let cases: Vec<&Case> = all.iter().filter(|case| case.phase() == phase).collect();
        let build = lockstep::quick_build(16, phase);
        let (program, ticks) = moves::side_by_side(&cases);
        let record = lockstep::record(Level::Fast, &Job::new(&build, &program, ticks))
            .expect("the fast model");
        for (axis, case) in cases.iter().enumerate() {
            case.assert_edges(&lockstep::edges_on_the_pins(&build, &record, axis));
        }
    }
}

/// Runs dense programs on a build; returns the number of edges.
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

/// A quarter of a million edges at least, or five million in the run of repeats.
fn many_edges(phases: u32, phase: StartPhase) {
    let cases = repeats::part(400, 20);
    let edges = dense_programs(&lockstep::quick_build(phases, phase), 20_000, cases);
    assert!(edges >= u64::from(cases) * 12_500, "only {edges} edges");
    if repeats::in_full() {
        effort::figures(&format!("{edges} edges of the fast model at {phases} phases"));
    }
}

/// The pin timings never delay a step, so all edges of the accumulators appear on the pins.
#[test]
fn many_edges_with_fast_pins() {
    many_edges(16, StartPhase::Half);
}

#[test]
fn many_edges_from_zero_phase() {
    many_edges(4, StartPhase::Zero);
}

/// The pin timings delay steps and changes of DIR, and cause overruns.
#[test]
fn registers_are_equal_with_slow_pins() {
    let slow = PinTiming { step_high: 12, step_low: 20, dir_setup: 30, dir_hold: 70 };
    let build = Build { pins: [slow; AXES], ..lockstep::tight_build(16, StartPhase::Half) };
    let edges = dense_programs(&build, 500, 400);
    assert!(edges >= 10_000, "only {edges} edges");
}

//! The Rust-HDL simulation of the parallel core equals its model in every output in every clock, on
//! random programs, the demo and every profile; that of the engine, on moves and on a program. It
//! reproduces the golden vectors to the last edge and phase.

use carrystep_core::StartPhase;
use carrystep_hdl::AxisSim;
use carrystep_plan::Plan;
use carrystep_simulators::{Job, Level};
use carrystep_tests::golden::{Case, Edge, engine_vectors};
use carrystep_tests::{gcode_job, lockstep, moves, programs, repeats};
use proptest::test_runner::{Config, TestRunner};

/// An ordinary run draws the first sixth of the cases.
fn random_programs(phases: u32, phase: StartPhase, cases: u32) {
    let build = lockstep::tight_build(phases, phase);
    let mut runner = TestRunner::new(Config {
        cases: repeats::part(cases, 6),
        max_shrink_iters: 200,
        ..Config::default()
    });
    let held = runner.run(&programs::program(), |program| {
        lockstep::assert_equals_model(Level::RustHdl, &lockstep::job(&build, &program));
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn random_programs_at_16_phases() {
    random_programs(16, StartPhase::Half, 300);
}

#[test]
fn random_programs_at_4_phases() {
    random_programs(4, StartPhase::Zero, 150);
}

#[test]
fn random_programs_at_1_phase() {
    random_programs(1, StartPhase::Half, 150);
}

#[test]
fn random_programs_on_one_axis() {
    lockstep::assert_random_programs_equal_model(Level::RustHdl, 1, 16, repeats::part(60, 3));
}

#[test]
fn random_programs_on_three_axes() {
    lockstep::assert_random_programs_equal_model(Level::RustHdl, 3, 4, repeats::part(60, 3));
}

/// Rung 5 compares the whole plan.
fn planned(plan: &Plan) {
    let program = plan.program();
    let job = Job::new(&plan.build, &program, plan.total_ticks());
    let max_clocks = repeats::part(job.max_clocks, 10);
    lockstep::assert_equals_model(Level::RustHdl, &Job { max_clocks, ..job });
}

#[test]
fn the_demo() {
    planned(&moves::demo_at_48_mhz());
}

#[test]
fn every_profile() {
    planned(&moves::curves_at_6_mhz());
}

#[test]
fn a_move_of_the_shipped_machine_on_the_engine() {
    let and_back = repeats::in_full();
    lockstep::assert_engine_equals_model(Level::RustHdl, &moves::nudge(and_back));
}

/// The outputs and the pin of the PWM are compared in every clock, as all others are.
#[test]
fn a_program_in_gcode_with_outputs_on_the_engine() {
    let job = gcode_job::switching();
    assert_eq!(job.switches(), 4, "changes at both rests and in motion");
    let program = (&job.program(), job.survey.ticks);
    lockstep::assert_engine_runs(Level::RustHdl, &job.engine(), program, job.steps());
}

/// Rung 5 compares the long cases, too.
#[test]
fn golden_vectors_to_the_last_edge_and_phase() {
    let is_run = |case: &Case| case.total_ticks <= 200_000 || repeats::in_full();
    for case in engine_vectors().into_iter().filter(is_run) {
        let (edges, p) = axis_edges(&case);
        case.assert_edges(&edges);
        assert_eq!(p, case.p_end(), "{}: P at the end", case.name);
    }
}

/// Runs the axis module alone with the shortest tick that its bisection allows, because the vectors
/// have millions of ticks.
fn axis_edges(case: &Case) -> (Vec<Edge>, u64) {
    let mut axis = AxisSim::new(16, case.phase()).expect("an axis");
    let mut segments = case.segments().into_iter();
    assert!(axis.offer(&segments.next().expect("a segment")));
    axis.tick(true); // This is the strobe that loads the segment.
    let mut edges = Vec::new();
    let mut p = 0;
    for tick in 1..=case.total_ticks {
        if !axis.waiting()
            && let Some(segment) = segments.next()
        {
            assert!(axis.offer(&segment));
        }
        let now = axis.tick(false);
        if now.crossed {
            edges.push((tick, u32::from(now.q), if now.back { -1 } else { 1 }));
        }
        p = now.p;
    }
    (edges, p)
}

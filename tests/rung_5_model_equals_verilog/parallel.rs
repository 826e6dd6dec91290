//! The exported parallel core, in Icarus and in Verilator, equals its model in every output in
//! every clock, on random programs, the demo and every profile. It reproduces the golden vectors to
//! the last edge and phase.

use carrystep_core::StartPhase;
use carrystep_plan::Plan;
use carrystep_simulators::{Job, Level};
use carrystep_tests::golden::{Case, engine_vectors};
use carrystep_tests::{axis_bench, effort, gcode_job, lockstep, moves, programs, repeats};
use carrystep_tools::kept;
use proptest::test_runner::{Config, TestRunner};

fn random_programs(level: Level, phases: u32, phase: StartPhase, cases: u32) {
    let build = lockstep::tight_build(phases, phase);
    let mut runner = TestRunner::new(Config { cases, max_shrink_iters: 100, ..Config::default() });
    let held = runner.run(&programs::program(), |program| {
        lockstep::assert_equals_model(level, &lockstep::job(&build, &program));
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
    kept::say();
}

fn planned(level: Level, plan: &Plan) {
    lockstep::assert_equals_model(
        level,
        &Job::new(&plan.build, &plan.program(), plan.total_ticks()),
    );
    kept::say();
}

/// Icarus takes minutes for what Verilator compares in seconds: it runs the first tenth.
fn planned_in_icarus(plan: &Plan) {
    let program = plan.program();
    let job = Job::new(&plan.build, &program, plan.total_ticks());
    let max_clocks = repeats::part(job.max_clocks, 10);
    lockstep::assert_equals_model(Level::Icarus, &Job { max_clocks, ..job });
    kept::say();
    if repeats::in_full() {
        effort::figures(&format!("{} ticks in Icarus", plan.total_ticks()));
    }
}

#[test]
fn random_programs_in_verilator_at_16_phases() {
    random_programs(Level::Verilator, 16, StartPhase::Half, 500);
}

#[test]
fn random_programs_in_verilator_at_4_phases() {
    random_programs(Level::Verilator, 4, StartPhase::Zero, 300);
}

#[test]
fn random_programs_in_icarus_at_16_phases() {
    random_programs(Level::Icarus, 16, StartPhase::Half, 60);
}

#[test]
fn random_programs_in_icarus_at_1_phase() {
    random_programs(Level::Icarus, 1, StartPhase::Half, 60);
}

/// The position of one axis has 32 bits, that of two axes 64, and that of three more: these are
/// three types in C++.
#[test]
fn random_programs_in_verilator_on_one_two_and_three_axes() {
    for (axes, phases) in [(1, 16), (2, 16), (3, 4)] {
        lockstep::assert_random_programs_equal_model(Level::Verilator, axes, phases, 60);
    }
}

#[test]
fn random_programs_in_icarus_on_one_and_three_axes() {
    for (axes, phases) in [(1, 16), (3, 4)] {
        lockstep::assert_random_programs_equal_model(Level::Icarus, axes, phases, 15);
    }
}

#[test]
fn the_demo_in_verilator() {
    planned(Level::Verilator, &moves::demo_at_48_mhz());
}

#[test]
fn the_demo_in_icarus() {
    planned_in_icarus(&moves::demo_at_48_mhz());
}

#[test]
fn every_profile_in_verilator() {
    planned(Level::Verilator, &moves::curves_at_6_mhz());
}

#[test]
fn every_profile_in_icarus() {
    planned_in_icarus(&moves::curves_at_6_mhz());
}

#[test]
fn the_demo_and_every_profile_on_the_engine_in_verilator() {
    for name in ["demo", "curves"] {
        lockstep::assert_engine_equals_model(Level::Verilator, &moves::on_the_engine(name));
    }
}

#[test]
fn a_program_in_gcode_on_the_engine_in_verilator() {
    let job = gcode_job::short();
    let program = (&job.program(), job.survey.ticks);
    lockstep::assert_engine_runs(Level::Verilator, &job.engine(), program, job.steps());
}

/// Rung 4 has the move back, too, and Verilator longer moves.
#[test]
fn a_move_of_the_shipped_machine_on_the_engine_in_icarus() {
    let and_back = repeats::in_full();
    lockstep::assert_engine_equals_model(Level::Icarus, &moves::nudge(and_back));
}

/// The cases of one start phase run side by side, one on each axis, and the edges are taken from
/// the pins.
#[test]
fn golden_vectors_in_verilator() {
    let all = engine_vectors();
    for phase in [StartPhase::Half, StartPhase::Zero] {
        let cases: Vec<&Case> = all.iter().filter(|case| case.phase() == phase).collect();
        let build = lockstep::quick_build(16, phase);
        let (program, ticks) = moves::side_by_side(&cases);
        let job = Job::new(&build, &program, ticks);
        let record = lockstep::assert_equals_model(Level::Verilator, &job);
        for (axis, case) in cases.iter().enumerate() {
            case.assert_edges(&lockstep::edges_on_the_pins(&build, &record, axis));
        }
    }
    kept::say();
}

/// Runs the axis alone, because Icarus would take hours for the pins in three million ticks. The
/// long cases are left to the run of repeats.
#[test]
fn golden_vectors_in_icarus() {
    let is_run = |case: &Case| case.total_ticks <= 200_000 || repeats::in_full();
    for case in engine_vectors().into_iter().filter(is_run) {
        let build = lockstep::quick_build(16, case.phase());
        let (edges, p) = axis_bench::edges_in_icarus(&build, &case.segments());
        case.assert_edges(&edges);
        assert_eq!(p, case.p_end(), "{}: P at the end", case.name);
    }
}

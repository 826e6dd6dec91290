//! Rung 3: the fast model is the model.

use carrystep_levels::{Job, Level};
use carrystep_spec::StartPhase;
use carrystep_tests::golden::{Case, engine_vectors};
use carrystep_tests::{lockstep, moves, programs};
use proptest::test_runner::{Config, TestRunner};

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
    let plan = moves::demo();
    lockstep::assert_equals_model(Level::Fast, &Job::new(&plan.build, &plan.program(), plan.total_ticks()));
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

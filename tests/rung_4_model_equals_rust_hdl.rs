//! Rung 4: the Rust-HDL simulation is the model, every output in every clock.

use carrystep_levels::Level;
use carrystep_spec::StartPhase;
use carrystep_tests::{lockstep, programs};
use proptest::test_runner::{Config, TestRunner};

fn random_programs(phases: u32, phase: StartPhase, cases: u32) {
    let build = lockstep::tight_build(phases, phase);
    let mut runner = TestRunner::new(Config { cases, max_shrink_iters: 200, ..Config::default() });
    let held = runner.run(&programs::program(), |program| {
        lockstep::assert_equals_model(Level::RustHdl, &lockstep::job(&build, &program));
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn random_programs_at_16_phases() {
    random_programs(16, StartPhase::Half, 60);
}

#[test]
fn random_programs_at_4_phases() {
    random_programs(4, StartPhase::Zero, 30);
}

#[test]
fn random_programs_at_1_phase() {
    random_programs(1, StartPhase::Half, 30);
}

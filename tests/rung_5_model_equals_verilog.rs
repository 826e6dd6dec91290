//! Rung 5: the exported Verilog, in Icarus and in Verilator, is the model, every output in every clock.

use carrystep_levels::Level;
use carrystep_spec::StartPhase;
use carrystep_tests::{lockstep, programs};
use proptest::test_runner::{Config, TestRunner};

fn random_programs(level: Level, phases: u32, phase: StartPhase, cases: u32) {
    let build = lockstep::tight_build(phases, phase);
    let mut runner = TestRunner::new(Config { cases, max_shrink_iters: 100, ..Config::default() });
    let held = runner.run(&programs::program(), |program| {
        lockstep::assert_equals_model(level, &lockstep::job(&build, &program));
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn random_programs_in_verilator_at_16_phases() {
    random_programs(Level::Verilator, 16, StartPhase::Half, 300);
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

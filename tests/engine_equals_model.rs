//! The engine is its model, every output in every clock, and its memory keeps what the model knows.

use carrystep_hdl::EngineSim;
use carrystep_levels::engine::{EngineCore, EngineHost};
use carrystep_model::Engine;
use carrystep_spec::engine::EngineInputs;
use carrystep_spec::{AXES, Build, Program, StartPhase, Timebase};
use carrystep_tests::{engine_programs, lockstep};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;

/// The fewest clocks that hold the turns; pins as different as in the other rungs.
fn build(clock_hz: u64, phases: u32, phase: StartPhase) -> Build {
    let timebase = Timebase::new(clock_hz, 1000, phases).expect("a fine timebase");
    Build { timebase, ..lockstep::tight_build(phases, phase) }
}

/// Runs both until the program is over and both are quiet; the clocks it took.
fn assert_equal(build: &Build, program: &Program) -> Result<u64, TestCaseError> {
    let mut model = Engine::new(build);
    let mut engine = EngineSim::new(build).expect("a fine build");
    let mut host = EngineHost::new(program);
    let mut fault = false;
    let mut quiet = 0;
    for cycle in 0..200_000_u64 {
        let mut inputs = host.inputs(fault);
        let mut expected = EngineCore::outputs(&mut model, &inputs);
        if expected.fault != fault {
            fault = expected.fault;
            inputs = host.inputs(fault);
            expected = EngineCore::outputs(&mut model, &inputs);
        }
        let found = engine.settle(&inputs);
        prop_assert_eq!(
            expected,
            found,
            "cycle {}, tick {}",
            cycle,
            cycle / u64::from(build.timebase.clocks_per_tick())
        );
        host.advance(&expected);
        quiet = if host.is_done() && (expected.idle || expected.fault) { quiet + 1 } else { 0 };
        if quiet > 12 * build.timebase.clocks_per_tick() {
            assert_kept(&model, &engine)?;
            return Ok(cycle);
        }
        EngineCore::clock(&mut model, &inputs);
        EngineCore::clock(&mut engine, &inputs);
    }
    Ok(200_000)
}

/// P, positions and discarded steps, when nothing moves.
fn assert_kept(model: &Engine, engine: &EngineSim) -> Result<(), TestCaseError> {
    for axis in 0..AXES {
        let shaper = model.shaper(axis);
        let p = u64::from(engine.kept(axis, 1)) << 32 | u64::from(engine.kept(axis, 0));
        prop_assert_eq!(model.fraction(axis), p, "P of axis {}", axis);
        prop_assert_eq!(shaper.position, engine.kept(axis, 2).cast_signed(), "position of axis {}", axis);
        prop_assert_eq!(shaper.discarded, engine.kept(axis, 3), "discarded steps of axis {}", axis);
    }
    Ok(())
}

fn random_programs(build: &Build, cases: u32) {
    let clocks = Cell::new(0);
    let mut runner = TestRunner::new(Config { cases, max_shrink_iters: 400, ..Config::default() });
    let held = runner.run(&engine_programs::program(), |program| {
        clocks.set(clocks.get() + assert_equal(build, &program)?);
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
    println!("{} clocks", clocks.get());
}

#[test]
fn random_programs_at_16_phases() {
    random_programs(&build(80_000_000, 16, StartPhase::Half), 60);
}

#[test]
fn random_programs_at_4_phases_with_clocks_to_spare() {
    random_programs(&build(96_000_000, 4, StartPhase::Zero), 30);
}

#[test]
fn random_programs_at_1_phase_in_the_shortest_tick() {
    random_programs(&build(79_000_000, 1, StartPhase::Half), 30);
}

#[test]
fn nothing_happens_to_an_engine_without_a_host() {
    let build = build(80_000_000, 16, StartPhase::Half);
    let mut engine = EngineSim::new(&build).expect("a fine build");
    for _ in 0..1000 {
        let outputs = engine.settle(&EngineInputs::default());
        assert!(outputs.idle && !outputs.fault && outputs.step == 0 && outputs.dir == 0);
        engine.clock();
    }
}

//! Rust-HDL's simulation of the engine is the engine's model, every output in every clock, and the
//! engine's memory holds what the model holds.

use carrystep_core::engine::{EngineInputs, LimitWiring};
use carrystep_core::{EngineBuild, Program, StartPhase};
use carrystep_hdl::EngineSim;
use carrystep_model::Engine;
use carrystep_simulators::engine::{EngineCore, EngineHost, Events};
use carrystep_tests::engine_builds::{build, on_adders, parameter_sets, with_latches};
use carrystep_tests::engine_programs::run_programs;
use carrystep_tests::repeats;
use proptest::prelude::*;

/// Runs both until the program is over and both are idle. Returns the number of clocks.
fn assert_equal(
    build: &EngineBuild,
    program: &Program,
    events: &Events,
) -> Result<u64, TestCaseError> {
    let mut model = Engine::new(build);
    let mut engine = EngineSim::new(build).expect("a fine build");
    let mut host = EngineHost::new(build, program, events);
    let mut fault = false;
    let mut quiet = 0;
    for cycle in 0..200_000_u64 {
        let mut inputs = host.inputs(fault);
        let mut expected = EngineCore::outputs(&mut model, &inputs);
        if expected.fault.is_some() != fault {
            fault = expected.fault.is_some();
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
        quiet = if host.is_done() && (expected.idle || expected.halted) { quiet + 1 } else { 0 };
        if quiet > 12 * build.timebase.clocks_per_tick() {
            assert_kept(build, &model, &engine)?;
            return Ok(cycle);
        }
        EngineCore::clock(&mut model, &inputs);
        EngineCore::clock(&mut engine, &inputs);
    }
    Ok(200_000)
}

/// Compares P, positions and discarded steps while nothing moves.
fn assert_kept(
    build: &EngineBuild,
    model: &Engine,
    engine: &EngineSim,
) -> Result<(), TestCaseError> {
    for axis in 0..build.axes() {
        let shaper = model.shaper(axis);
        let p = u64::from(engine.kept(axis, 1)) << 32 | u64::from(engine.kept(axis, 0));
        prop_assert_eq!(model.fraction(axis), p, "P of axis {}", axis);
        prop_assert_eq!(
            shaper.position,
            engine.kept(axis, 2).cast_signed(),
            "position of axis {}",
            axis
        );
        prop_assert_eq!(shaper.discarded, engine.kept(axis, 3), "discarded steps of axis {}", axis);
    }
    Ok(())
}

/// Half of these clocks, or twice as many in a run of repeats.
fn in_rust_hdl(build: &EngineBuild, clocks: u64) {
    run_programs(build, repeats::part(2 * clocks, 4), |program, events| {
        assert_equal(build, program, events)
    });
}

#[test]
fn random_programs_at_16_phases() {
    in_rust_hdl(&build(6, 80_000_000, 16, StartPhase::Half, LimitWiring::Pair), 200_000);
}

#[test]
fn random_programs_at_1_phase_in_the_shortest_tick() {
    in_rust_hdl(&build(6, 80_000_000, 1, StartPhase::Half, LimitWiring::One), 100_000);
}

#[test]
fn random_programs_of_eight_axes_at_4_phases_with_clocks_to_spare() {
    in_rust_hdl(&build(8, 120_000_000, 4, StartPhase::Zero, LimitWiring::Each), 100_000);
}

#[test]
fn random_programs_of_eight_axes_at_1_phase_in_the_shortest_tick() {
    in_rust_hdl(&build(8, 106_000_000, 1, StartPhase::Half, LimitWiring::Pair), 100_000);
}

#[test]
fn random_programs_of_one_axis_in_the_shortest_phases() {
    in_rust_hdl(&build(1, 32_000_000, 16, StartPhase::Half, LimitWiring::Pair), 50_000);
}

#[test]
fn random_programs_of_one_axis_in_the_shortest_tick() {
    in_rust_hdl(&build(1, 16_000_000, 4, StartPhase::Zero, LimitWiring::One), 50_000);
}

#[test]
fn random_programs_with_two_and_with_four_latches() {
    let two = build(3, 64_000_000, 4, StartPhase::Half, LimitWiring::Pair);
    in_rust_hdl(&with_latches(two, 2), 75_000);
    let four = build(1, 32_000_000, 4, StartPhase::Zero, LimitWiring::One);
    in_rust_hdl(&with_latches(four, 4), 75_000);
}

#[test]
fn random_programs_of_six_axes_on_six_adders_in_the_shortest_tick() {
    let six = build(6, 16_000_000, 4, StartPhase::Half, LimitWiring::Pair);
    in_rust_hdl(&on_adders(six, 6), 50_000);
}

#[test]
fn random_programs_of_six_axes_on_two_adders_in_the_shortest_tick() {
    let two = build(6, 42_000_000, 1, StartPhase::Zero, LimitWiring::Each);
    in_rust_hdl(&on_adders(two, 2), 50_000);
}

#[test]
fn random_programs_of_eight_axes_on_eight_adders_with_clocks_to_spare() {
    let eight = build(8, 48_000_000, 16, StartPhase::Half, LimitWiring::One);
    in_rust_hdl(&on_adders(eight, 8), 20_000);
}

/// Rung 5 compares the Verilog of the first set, with the parameters of each, with the same
/// programs.
#[test]
fn random_programs_with_each_set_of_parameters() {
    parameter_sets().iter().for_each(|build| in_rust_hdl(build, 50_000));
}

#[test]
fn engine_without_a_host_stays_idle() {
    let build = build(6, 80_000_000, 16, StartPhase::Half, LimitWiring::None);
    let mut engine = EngineSim::new(&build).expect("a fine build");
    for _ in 0..1000 {
        let outputs = engine.settle(&EngineInputs::default());
        assert!(
            outputs.idle
                && outputs.fault.is_none()
                && outputs.step == 0
                && outputs.dir == 0
                && !outputs.enabled
        );
        engine.clock();
    }
}

//! Slow moves, up to 10^6 s or the longest accepted time. Every edge must be within the bound, both
//! in this test's own arithmetic and on the pins of the fast model as the product's checker judges
//! them.

use crate::verify::verify;
use carrystep_core::ProfileKind;
use carrystep_files::MoveFile;
use carrystep_plan::{Plan, PlanError, plan};
use carrystep_tests::moves;
use carrystep_tests::random_moves::file;
use carrystep_tests::repeats;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;

/// One axis and one move.
#[derive(Debug, Clone)]
struct SlowMove {
    machine: String,
    profile: ProfileKind,
    steps: i64,
    seconds: f64,
}

impl SlowMove {
    fn file(&self, seconds: f64) -> MoveFile {
        let Self { machine, profile, steps, .. } = self;
        file(&format!(
            "{machine}[[move]]\nprofile = \"{profile}\"\ntime = {seconds}\nto = {{ x = {steps} }}\n"
        ))
    }
}

fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

fn slow_moves(profile: ProfileKind) -> impl Strategy<Value = SlowMove> {
    let machine = (
        prop::sample::select(&[500_u64, 1000, 4000][..]),
        prop::sample::select(&[1_u32, 4, 16, 16, 16][..]),
        prop::sample::select(&["half", "half", "zero"][..]),
        decades(1.0, 5000.0),
        decades(1.1e-3, 1e5),
        prop_oneof![Just(0.0), decades(1e-3, 1.0)],
    );
    (machine, any::<bool>(), decades(1.0, 2000.0), decades(100.0, 1e6)).prop_map(
        move |((tick_ns, phases, phase, speed, accel, start), backward, steps, seconds)| {
            let start = if profile == ProfileKind::Constant { speed } else { start };
            let machine = format!(
                "[machine]\nclock_hz = 64_000_000\ntick_ns = {tick_ns}\nphases = {phases}\nphase = \"{phase}\"\n\
                 [[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1\nstart_speed = {start:?}\nspeed_limit = {speed:?}\n\
                 accel_limit = {accel:?}\njerk_limit = {:?}\nstep_high_ns = 100\nstep_low_ns = 100\ndir_setup_ns = 100\ndir_hold_ns = 100\n",
                10.0 * accel
            );
            let steps = if backward { -(steps as i64) } else { steps as i64 };
            // Phase zero needs a time of whole ticks.
            SlowMove { machine, profile, steps, seconds: (seconds * 1e4).round() / 1e4 }
        },
    )
}

/// Applies both judges: edges computed from the integers, and pulses on the pins.
fn holds(file: &MoveFile, plan: &Plan) -> Result<(), TestCaseError> {
    verify(file, plan, Some(2e-9));
    let report = moves::check(file, plan, &plan.courses(), &plan.program(), &plan.build);
    prop_assert!(report.passed, "{report}\n{}", file.source.text);
    Ok(())
}

/// Counts of the results.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    planned: u32,
    /// Moves planned in the longest time that the refusal names.
    shortened: u32,
    /// Moves for which a limit requires more time, or no time works.
    impossible: u32,
}

fn random_moves(profile: ProfileKind) {
    let cases = repeats::part(200, 4);
    let counts = Cell::new(Counts::default());
    let mut runner =
        TestRunner::new(Config { cases, failure_persistence: None, ..Config::default() });
    let held = runner.run(&slow_moves(profile), |slow| {
        let mut now = counts.get();
        let file = slow.file(slow.seconds);
        match plan::<f64>(&file) {
            Ok(plan) => {
                now.planned += 1;
                holds(&file, &plan)?;
            }
            Err(PlanError::TooSlow { longest: Some(longest), .. }) => {
                now.shortened += 1;
                prop_assert!(longest < slow.seconds);
                let file = slow.file(longest);
                holds(
                    &file,
                    &plan::<f64>(&file).map_err(|error| TestCaseError::fail(error.to_string()))?,
                )?;
            }
            Err(PlanError::TooSlow { .. } | PlanError::Refused { .. }) => now.impossible += 1,
            Err(error) => {
                return Err(TestCaseError::fail(format!("{error}\n{}", file.source.text)));
            }
        }
        counts.set(now);
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
    let counts = counts.get();
    assert!(counts.planned > cases / 2, "{profile}: hardly anything was planned: {counts:?}");
}

#[test]
fn slow_moves_of_every_kind_keep_the_edge_bound() {
    for &kind in ProfileKind::ALL {
        random_moves(kind);
    }
}

/// 400 steps in either direction on a machine with a4988 timing.
fn four_hundred_steps_in(seconds: u32) {
    for steps in [400, -400] {
        let text = format!(
            "[machine]\n[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1\nspeed_limit = 5000\naccel_limit = 25000\n\
             driver = \"a4988\"\n[[move]]\nprofile = \"trapezoid\"\ntime = {seconds}\nto = {{ x = {steps} }}\n"
        );
        let file = file(&text);
        let plan = plan::<f64>(&file).unwrap_or_else(|error| panic!("{error}"));
        holds(&file, &plan).unwrap_or_else(|error| panic!("{error}"));
        assert!(plan.moves[0].axes[0].segments.len() < 1000);
    }
}

#[test]
fn four_hundred_steps_in_5000_s() {
    four_hundred_steps_in(5000);
}

#[test]
fn four_hundred_steps_in_10_000_s() {
    four_hundred_steps_in(10_000);
}

#[test]
fn four_hundred_steps_in_100_000_s() {
    four_hundred_steps_in(100_000);
}

#[test]
fn four_hundred_steps_in_a_million_seconds() {
    four_hundred_steps_in(1_000_000);
}

/// The last pulse is due at rest, and the ramp before it is shorter than a tick.
#[test]
fn one_step_whose_ramps_are_shorter_than_a_tick() {
    let file = file(
        "[machine]\nclock_hz = 64_000_000\ntick_ns = 500\nphases = 1\nphase = \"zero\"\n\
         [[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1\nspeed_limit = 1\naccel_limit = 67_940\n\
         step_high_ns = 100\nstep_low_ns = 100\ndir_setup_ns = 100\ndir_hold_ns = 100\n\
         [[move]]\nprofile = \"trapezoid\"\ntime = 393_000\nto = { x = 1 }\n",
    );
    let plan = plan::<f64>(&file).unwrap_or_else(|error| panic!("{error}"));
    holds(&file, &plan).unwrap_or_else(|error| panic!("{error}"));
}

/// A triangular move of a million steps in a million seconds has too many slow pulses, and none
/// that is slow enough to be planned by itself, so it would need too many segments.
#[test]
fn a_move_of_too_many_segments_is_refused_with_the_longest_time() {
    let text = |seconds: &str| {
        format!(
            "[machine]\n[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1\nspeed_limit = 5000\naccel_limit = 25000\n\
             driver = \"a4988\"\n[[move]]\nprofile = \"ranade\"\ntime = {seconds}\nto = {{ x = 1_000_000 }}\n"
        )
    };
    let error = plan::<f64>(&file(&text("1_000_000"))).unwrap_err();
    let PlanError::TooSlow { longest: Some(longest), .. } = error else { panic!("{error}") };
    let says = format!(
        "move 1, axis x: so slow that it needs over 131072 segments; at most {longest} s would do"
    );
    assert_eq!(error.to_string(), says);
    let file_of_longest = file(&text(&longest.to_string()));
    let plan_of_longest = plan::<f64>(&file_of_longest).unwrap_or_else(|error| panic!("{error}"));
    assert!(plan_of_longest.moves[0].axes[0].segments.len() <= 1 << 17);
    verify(&file_of_longest, &plan_of_longest, Some(2e-9));
    assert!(
        plan::<f64>(&file(&text(&(longest * 1.05).to_string()))).is_err(),
        "{longest} s is not the longest"
    );
}

/// Backward at less than a step per second and at the speed limit itself, the axis cannot make up
/// the distance by which it must be late.
#[test]
fn a_slow_backward_move_at_its_speed_limit_is_refused_and_a_slower_one_is_not() {
    let text = |seconds: &str| {
        format!(
            "[machine]\n[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1\nstart_speed = 0.5\nspeed_limit = 0.5\n\
             accel_limit = 25000\ndriver = \"a4988\"\n[[move]]\nprofile = \"constant\"\ntime = {seconds}\nto = {{ x = -100 }}\n"
        )
    };
    let error = plan::<f64>(&file(&text("200"))).unwrap_err();
    assert!(matches!(error, PlanError::TooSlow { longest: None, .. }), "{error}");
    let slower = file(&text("200.00001"));
    let plan = plan::<f64>(&slower).unwrap_or_else(|error| panic!("{error}"));
    holds(&slower, &plan).unwrap_or_else(|error| panic!("{error}"));
}

//! Rung 1: the integers of a plan land exactly, keep the limits, and place every edge where the
//! float profile places it, within the bound of the accuracy contract.

#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod examples;
mod jobs;
mod slow;
mod verify;

use carrystep_core::ProfileKind;
use carrystep_files::MoveFile;
use carrystep_plan::{PlanError, plan};
use carrystep_tests::random_moves::{self, Pace, RandomMoves, random_moves};
use carrystep_tests::repeats;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use verify::verify;

/// The profiles whose segments need no J. The others need one.
const LINEAR: [ProfileKind; 3] =
    [ProfileKind::Ranade, ProfileKind::Trapezoid, ProfileKind::Constant];

fn verified(case: &RandomMoves) {
    for file in case.files() {
        match plan::<f64>(&file) {
            Ok(plan) => verify(&file, &plan, Some(2e-9)),
            Err(error) => assert!(is_too_slow(&file, &error), "{error}"),
        }
    }
}

/// True if a slow move of over 10^10 ticks is refused because it needs too many segments, with a
/// shorter time that would work. `slow.rs` plans such moves in that time.
fn is_too_slow(file: &MoveFile, error: &PlanError) -> bool {
    let PlanError::TooSlow { index, longest: Some(longest), .. } = error else { return false };
    let given =
        file.moves[*index].time.as_ref().map(|time| time.to_string().parse::<f64>().unwrap());
    let least = 1e10 * file.machine.timebase.tick_seconds();
    given.is_some_and(|given| given > least && *longest < given)
}

#[test]
fn every_profile_lands_on_free_and_straight_paths() {
    let (file, curves) = carrystep_tests::moves::shipped("curves");
    verify(&file, &curves, Some(2e-9));
    // The axes x and c have a start speed, which a constant speed needs.
    let (machine, _) = file.source.text.split_once("[[move]]").unwrap();
    for (kind, path) in
        ProfileKind::ALL.iter().flat_map(|kind| [(kind, "free"), (kind, "straight")])
    {
        let moved = format!("profile = \"{kind}\"\npath = \"{path}\"\nto = {{ x = 2, c = -40 }}");
        let file = random_moves::file(&format!("{machine}[[move]]\n{moved}\n"));
        let plan = plan::<f64>(&file).unwrap_or_else(|error| panic!("{kind}, {path}: {error}"));
        verify(&file, &plan, Some(2e-9));
    }
}

#[test]
fn plans_of_each_kind_land_within_their_limits_and_the_edge_bound() {
    for kind in ProfileKind::ALL.iter().filter(|kind| !LINEAR.contains(kind)) {
        let config =
            Config { cases: repeats::part(600, 3), failure_persistence: None, ..Config::default() };
        let held = TestRunner::new(config).run(
            &random_moves(Pace::Any, std::slice::from_ref(kind)),
            |case| {
                verified(&case);
                Ok(())
            },
        );
        held.unwrap_or_else(|error| panic!("{kind}: {error}"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: repeats::part(600, 3),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn linear_plans_land_within_their_limits_and_the_edge_bound(case in random_moves(Pace::Any, &LINEAR)) {
        verified(&case);
    }

    #[test]
    fn mixed_moves_land_within_their_limits_and_the_edge_bound(case in random_moves(Pace::Any, ProfileKind::ALL)) {
        verified(&case);
    }

    #[test]
    fn plans_in_f32_land_exactly(case in random_moves(Pace::Any, ProfileKind::ALL)) {
        for file in case.files() {
            match plan::<f32>(&file) {
                Ok(plan) => verify(&file, &plan, None),
                // A time that is just sufficient in f64 may round to one that is not in f32.
                Err(PlanError::Refused { .. }) => {}
                Err(error) if is_too_slow(&file, &error) => {}
                Err(error) => {
                    // Times that f32 cannot distinguish must be refused and must never give a wrong
                    // plan.
                    let long = plan::<f64>(&file).unwrap().moves[error.move_index().unwrap()].ticks > 1 << 24;
                    assert!(long && matches!(error, PlanError::Broken { .. }), "{error}");
                }
            }
        }
    }
}

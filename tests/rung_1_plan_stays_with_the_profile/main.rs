//! Rung 1: the integers of a plan land exactly, keep the limits, and put every edge where the float
//! profile says, within the bound of the accuracy contract.

#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod examples;
mod slow;
mod verify;

use carrystep_plan::{PlanError, plan};
use carrystep_spec::ProfileKind;
use carrystep_tests::random_moves::{Pace, RandomMoves, random_moves};
use proptest::prelude::*;
use verify::verify;

/// The profiles whose segments are straight in A, and those that need a J.
const LINEAR: [ProfileKind; 3] = [ProfileKind::Ranade, ProfileKind::Trapezoid, ProfileKind::Constant];

fn verified(case: &RandomMoves) {
    for file in case.files() {
        let plan = plan::<f64>(&file).unwrap_or_else(|error| panic!("{error}"));
        verify(&file, &plan, Some(2e-9));
    }
}

#[test]
fn every_profile_free_and_straight() {
    let (file, plan) = carrystep_tests::moves::shipped("curves");
    verify(&file, &plan, Some(2e-9));
    for kind in ProfileKind::ALL {
        assert!(file.moves.iter().any(|moved| moved.profile == kind), "{kind}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn linear_plans_land_keep_their_limits_and_their_edges(case in random_moves(Pace::Any, &LINEAR)) {
        verified(&case);
    }

    #[test]
    fn scurves_land_keep_their_limits_and_their_edges(case in random_moves(Pace::Any, &[ProfileKind::Scurve])) {
        verified(&case);
    }

    #[test]
    fn sines_land_keep_their_limits_and_their_edges(case in random_moves(Pace::Any, &[ProfileKind::Sine])) {
        verified(&case);
    }

    #[test]
    fn logistics_land_keep_their_limits_and_their_edges(case in random_moves(Pace::Any, &[ProfileKind::Logistic])) {
        verified(&case);
    }

    #[test]
    fn mixed_moves_land_keep_their_limits_and_their_edges(case in random_moves(Pace::Any, &ProfileKind::ALL)) {
        verified(&case);
    }

    #[test]
    fn f32_lands_exactly_too(case in random_moves(Pace::Any, &ProfileKind::ALL)) {
        for file in case.files() {
            match plan::<f32>(&file) {
                Ok(plan) => verify(&file, &plan, None),
                // A time that is just enough may round to one that is not.
                Err(PlanError::Refused { .. }) => {}
                Err(error) => {
                    // Times that f32 cannot tell apart: then no plan is given, never a wrong one.
                    let long = plan::<f64>(&file).unwrap().moves[error.move_index().unwrap()].ticks > 1 << 24;
                    assert!(long && matches!(error, PlanError::Broken { .. }), "{error}");
                }
            }
        }
    }
}

//! Random moves from file to pins: plan, model, shapers, and the checker that `carrystep simulate` uses.
//!
//! Rung 1 compares plans with profiles in arithmetic of its own; here the product's checker judges the product's
//! pins: every edge within the bound, count and position exact, the driver's timing kept.

use carrystep_plan::{Plan, plan};
use carrystep_spec::{MoveFile, ProfileKind, Source};
use carrystep_tests::moves;
use carrystep_tests::random_moves::{RandomMove, random_move};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;

fn planned(text: &str) -> (MoveFile, Plan) {
    let file = MoveFile::from_source(Source { path: "random.toml".into(), text: text.into() });
    let file = file.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let plan = plan::<f64>(&file).unwrap_or_else(|error| panic!("{error}\n{text}"));
    (file, plan)
}

fn passes(random: &RandomMove) -> Result<u64, TestCaseError> {
    let (mut file, mut plan) = planned(&random.text(None));
    if random.is_stretched() {
        (file, plan) = planned(&random.text(Some(plan.moves[0].seconds)));
    }
    let report = moves::check(&file, &plan, &plan.lines(), &plan.program(), &plan.build);
    prop_assert!(report.passed, "{report}\n{}", file.source.text);
    Ok(report.axes.iter().map(|axis| axis.pulses_found).sum())
}

fn all_pass(profile: ProfileKind, cases: u32) {
    let pulses = Cell::new(0);
    let mut runner = TestRunner::new(Config { cases, failure_persistence: None, ..Config::default() });
    let held = runner.run(&random_move(profile), |random| {
        pulses.set(pulses.get() + passes(&random)?);
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
    assert!(pulses.get() > 100 * u64::from(cases), "hardly anything was checked");
}

#[test]
fn a_thousand_trapezoids() {
    all_pass(ProfileKind::Trapezoid, 1000);
}

#[test]
fn three_hundred_moves_of_each_other_kind() {
    for profile in [ProfileKind::Ranade, ProfileKind::Scurve, ProfileKind::Logistic, ProfileKind::Sine] {
        all_pass(profile, 300);
    }
}

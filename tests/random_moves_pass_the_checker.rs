//! Random moves from file to pins: plan, model, shapers, and the checker that `carrystep simulate` uses.
//!
//! Rung 1 compares plans with profiles in arithmetic of its own; here the product's checker judges the product's
//! pins: every edge within the bound, count and position exact, straight lines kept, the driver's timing kept.

use carrystep_plan::plan;
use carrystep_spec::ProfileKind;
use carrystep_tests::moves;
use carrystep_tests::random_moves::{Pace, RandomMoves, random_moves};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;

/// All moves, as fast as may be and in their own time; how many pulses were judged.
fn passes(random: &RandomMoves) -> Result<u64, TestCaseError> {
    let mut pulses = 0;
    for file in random.files() {
        let plan = plan::<f64>(&file).unwrap_or_else(|error| panic!("{error}\n{}", file.source.text));
        let report = moves::check(&file, &plan, &plan.lines(), &plan.program(), &plan.build);
        prop_assert!(report.passed, "{report}\n{}", file.source.text);
        pulses += report.axes.iter().map(|axis| axis.pulses_found).sum::<u64>();
    }
    Ok(pulses)
}

fn all_pass(kinds: &'static [ProfileKind], cases: u32) {
    let pulses = Cell::new(0);
    let mut runner = TestRunner::new(Config { cases, failure_persistence: None, ..Config::default() });
    let held = runner.run(&random_moves(Pace::Brisk, kinds), |random| {
        pulses.set(pulses.get() + passes(&random)?);
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
    assert!(pulses.get() > 100 * u64::from(cases), "hardly anything was checked");
}

#[test]
fn a_thousand_trapezoids() {
    all_pass(&[ProfileKind::Trapezoid], 1000);
}

#[test]
fn three_hundred_of_each_other_kind() {
    const KINDS: [ProfileKind; 4] =
        [ProfileKind::Ranade, ProfileKind::Scurve, ProfileKind::Logistic, ProfileKind::Sine];
    for kind in &KINDS {
        all_pass(std::slice::from_ref(kind), 300);
    }
}

//! Checks random moves from the file to the pins: plan, model, shapers, and the checker that
//! `carrystep simulate` uses.
//!
//! Rung 1 compares plans with profiles in its own arithmetic. Here the product's checker judges the
//! product's pins: every edge within the bound, exact count and position, straight lines, and the
//! driver's timing.

use carrystep_core::ProfileKind;
use carrystep_plan::plan;
use carrystep_tests::moves;
use carrystep_tests::random_moves::{Pace, RandomMoves, random_moves};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;

/// Counts of what was judged, because a test of too few moves would prove nothing.
#[derive(Debug, Clone, Copy, Default)]
struct Judged {
    pulses: u64,
    /// Moves with sixteen phases per tick.
    moves: usize,
}

/// Checks all moves, as fast as possible and with their own times.
fn passes(random: &RandomMoves) -> Result<Judged, TestCaseError> {
    let mut judged = Judged::default();
    for file in random.files() {
        let plan =
            plan::<f64>(&file).unwrap_or_else(|error| panic!("{error}\n{}", file.source.text));
        let report = moves::check(&file, &plan, &plan.courses(), &plan.program(), &plan.build);
        prop_assert!(report.passed, "{report}\n{}", file.source.text);
        judged.pulses += report.axes.iter().map(|axis| axis.pulses_found).sum::<u64>();
        if plan.build.timebase.phases() == 16 {
            judged.moves += plan.moves.len();
        }
    }
    Ok(judged)
}

fn all_pass(kinds: &'static [ProfileKind], cases: u32) {
    let all = Cell::new(Judged::default());
    let mut runner =
        TestRunner::new(Config { cases, failure_persistence: None, ..Config::default() });
    let held = runner.run(&random_moves(Pace::Brisk, kinds), |random| {
        let (one, so_far) = (passes(&random)?, all.get());
        all.set(Judged { pulses: so_far.pulses + one.pulses, moves: so_far.moves + one.moves });
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
    let Judged { pulses, moves } = all.get();
    assert!(
        pulses > 100 * u64::from(cases) && moves >= cases as usize,
        "hardly anything was checked: {moves}, {pulses}"
    );
}

#[test]
fn a_thousand_trapezoids_pass_the_checker() {
    all_pass(&[ProfileKind::Trapezoid], 1000);
}

#[test]
fn three_hundred_moves_of_each_other_kind_pass_the_checker() {
    // A constant speed needs a start speed on every axis.
    let others =
        |kind: &&ProfileKind| !matches!(kind, ProfileKind::Trapezoid | ProfileKind::Constant);
    for kind in ProfileKind::ALL.iter().filter(others) {
        all_pass(std::slice::from_ref(kind), 300);
    }
}

//! Bugs planted in the modules of the engine: of the kinds that an independent bench found alive,
//! and of the modules that the shipped machine does not have. The recordings of the mutants must
//! catch each of them.

use crate::engine_bugs::{Bug, KINDS, NEW, PULSER};
use carrystep_core::{EngineBuild, PinTiming};
use carrystep_simulators::engine::replay::difference_of_mutant;
use carrystep_tests::mutants::planted::{Planted, plant};
use carrystep_tests::mutants::stimuli::{self, Engine};
use carrystep_tests::{effort, jobs};
use carrystep_tools::kept;

/// The axes of the shipped machine whose drivers are so slow that the steps of a move in one
/// direction crowd. Where no step is due while another one comes, the bugs of a pulser that are
/// about it do no harm.
const SLOW: [usize; 2] = [3, 5];

/// The bugs of one axis: in its pulser, and in what `idle` and a clear wait for. Each has the text
/// that is part of the names of the recordings that are tried first.
fn of_axis(build: &EngineBuild, axis: usize) -> Vec<(Planted, String)> {
    let mut all = Vec::new();
    let PinTiming { step_high, step_low, .. } = build.pins[axis];
    for (name, module, around, right, wrong, by) in PULSER {
        // A pulser does not know its axis, but its timing.
        let wrong = format!(
            "(STEP_HIGH == 32'd{step_high} && STEP_LOW == 32'd{step_low}) ? ({wrong}) : ({right})"
        );
        let name = format!("axis {axis}: {name}");
        all.push((Planted::new(name, module, around, right, wrong), format!("axis {axis} {by}")));
    }
    for (pin, around, by) in [
        ("held_back", "| {} |", format!("axis {axis} rests with a step")),
        ("step", "| {};", format!("a pulse of axis {axis}")),
    ] {
        let name = format!("axis {axis}: rests in spite of {pin}");
        let right = format!("pulser_{axis}_{pin}");
        all.push((Planted::new(name, "engine", around, right, "1'b0"), by));
    }
    all
}

fn planted(bugs: &[Bug]) -> Vec<(Planted, String)> {
    let one = |&(name, module, around, right, wrong, by): &Bug| {
        (Planted::new(name, module, around, right, wrong), by.to_owned())
    };
    bugs.iter().map(one).collect()
}

/// The bugs that no recording catches.
fn alive(engine: &Engine, bugs: &[(Planted, String)]) -> Vec<String> {
    let Engine { built: (_, verilog), stimuli } = engine;
    let verilog = plant(verilog, &bugs.iter().map(|(bug, _)| bug.clone()).collect::<Vec<_>>());
    let differs = |number: usize, recording| {
        difference_of_mutant(&verilog, number, recording).expect("the tools").is_some()
    };
    let numbers: Vec<usize> = (1..=bugs.len()).collect();
    let found = jobs::each(&numbers, |number| {
        let (bug, by) = &bugs[number - 1];
        let (first, others): (Vec<_>, Vec<_>) =
            stimuli.iter().partition(|stimulus| stimulus.name.contains(by.as_str()));
        let mut all = first.into_iter().chain(others);
        let catcher = all.find(|stimulus| differs(*number, &stimulus.recording));
        // A recording that differs from the engine without a bug would catch everything.
        let catcher = catcher.filter(|stimulus| !differs(0, &stimulus.recording));
        let by = catcher.map_or("no recording", |stimulus| &stimulus.name);
        effort::say(&format!("{} is caught by {by}", bug.name));
        catcher.is_none().then(|| bug.name.clone())
    });
    kept::say();
    found.into_iter().flatten().collect()
}

/// True if all mutants are run, and not only a few.
fn is_long() -> bool {
    std::env::var_os("CARRYSTEP_MUTANTS").is_some()
}

/// A test run plants the bugs of the last axis, a long one those of all axes.
#[test]
fn bugs_in_the_engine_with_everything_are_caught() {
    let engine = stimuli::full();
    let build = &engine.built.0;
    let first = if is_long() { 0 } else { build.axes() - 1 };
    let of_axes = (first..build.axes()).flat_map(|axis| of_axis(build, axis));
    let bugs: Vec<_> =
        [planted(&KINDS), planted(&NEW)].concat().into_iter().chain(of_axes).collect();
    assert_eq!(alive(&engine, &bugs), [""; 0], "no recording catches these");
}

/// Only in a long run: the recordings of the shipped engine take longer.
#[test]
fn bugs_in_the_shipped_engine_are_caught() {
    if !is_long() {
        return;
    }
    let engine = stimuli::shipped();
    let of_axes = SLOW.into_iter().flat_map(|axis| of_axis(&engine.built.0, axis));
    let bugs: Vec<_> = planted(&KINDS).into_iter().chain(of_axes).collect();
    assert_eq!(alive(&engine, &bugs), [""; 0], "no recording catches these");
}

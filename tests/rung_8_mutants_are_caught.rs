//! Rung 8: of the exported engine's mutants each one is caught by lock-step with the model, or it is listed in
//! `docs/mutants.md` with the reason why it is harmless. A few in every test run, all of them in `cargo xtask mutants`.

use carrystep_tests::mutants::draw::{Sample, sample};
use carrystep_tests::mutants::stimuli::{self, Stimulus};
use carrystep_tests::mutants::survivors::{self, NO_REASON, Survivors};
use carrystep_tests::mutants::{catchers, differs};
use carrystep_tests::{effort, moves};
use std::collections::BTreeMap;

/// In every test run: the first of all.
const FEW: usize = 40;
/// With `CARRYSTEP_MUTANTS=all`, or `write`, which also writes the list of survivors anew.
const ALL: usize = 200;

#[test]
fn mutants_are_caught_or_harmless() {
    let asked = std::env::var("CARRYSTEP_MUTANTS").unwrap_or_default();
    let (few, writes) = (asked.is_empty(), asked == "write");
    assert!(few || writes || asked == "all", "CARRYSTEP_MUTANTS is all or write, not {asked}");
    let verilog = moves::root().join("hdl-out/core/carrystep_engine.v");
    let verilog = std::fs::read_to_string(verilog).expect("the exported engine");
    let sample = sample(&verilog, "carrystep_engine", if few { FEW } else { ALL });
    let stimuli = stimuli::all(&stimuli::build());
    for stimulus in stimuli.iter().filter(|_| !few) {
        assert!(!differs(&sample, 0, stimulus), "without a mutant nothing may differ: {}", stimulus.name);
    }
    let caught = catchers(&sample, &stimuli);
    effort::say(&table(&stimuli, &caught));

    let listed = survivors::read();
    let alive = survivors_of(&sample, &caught, &listed);
    if writes {
        survivors::write(&alive);
    }
    let without: Vec<&String> = alive.iter().filter(|(_, reason)| *reason == NO_REASON).map(|(name, _)| name).collect();
    assert!(without.is_empty(), "nothing catches, and nobody says why it is harmless:\n{without:#?}");
    let drawn = |name: &String| sample.mutants.iter().any(|mutant| mutant.name == *name);
    let gone: Vec<&String> = listed.keys().filter(|name| !alive.contains_key(*name) && (!few || drawn(name))).collect();
    assert!(writes || gone.is_empty(), "listed in docs/mutants.md, but caught or no longer drawn:\n{gone:#?}");
}

/// Who is not caught, and the reason that is listed.
fn survivors_of(sample: &Sample, caught: &[Option<&str>], listed: &Survivors) -> Survivors {
    let alive = sample.mutants.iter().zip(caught).filter(|(_, caught)| caught.is_none());
    let reason = |name| listed.get(name).cloned().unwrap_or_else(|| NO_REASON.to_owned());
    alive.map(|(mutant, _)| (mutant.name.clone(), reason(&mutant.name))).collect()
}

/// How many each recording is the first to catch.
fn table(stimuli: &[Stimulus], caught: &[Option<&str>]) -> String {
    let mut counts: BTreeMap<Option<&str>, usize> = BTreeMap::new();
    for catcher in caught {
        *counts.entry(*catcher).or_default() += 1;
    }
    let rows = stimuli
        .iter()
        .filter_map(|stimulus| Some((stimulus.name.as_str(), *counts.get(&Some(stimulus.name.as_str()))?)));
    let alive = counts.get(&None).copied().unwrap_or(0);
    let rows =
        rows.chain([("nothing", alive)]).map(|(name, count)| format!("{count:>4} mutants are caught by: {name}\n"));
    rows.collect()
}

//! Each mutant of the exported engine is caught by lock-step with the model or by a
//! promise, or `docs/mutants.md` lists it as proved equal to the engine or with the reason why it
//! is harmless. A test run covers a few mutants; `cargo xtask mutants` covers all of them and
//! repeats the proofs.

use carrystep_tests::mutants::draw::{Mutant, Sample, sample};
use carrystep_tests::mutants::equal::{Scope, is_proved};
use carrystep_tests::mutants::stimuli::{self, Stimulus};
use carrystep_tests::mutants::survivors::{self, NO_REASON, PROVED, Survivors};
use carrystep_tests::mutants::{Judgement, catchers, differs, judge};
use carrystep_tests::{effort, jobs};
use carrystep_tools::kept;
use std::collections::{BTreeMap, BTreeSet};

/// Number of mutants in every test run: the first ones of all.
const FEW: usize = 24;
/// Number of mutants if `CARRYSTEP_MUTANTS` is `all`, or `write`, which also rewrites the list of
/// survivors.
const ALL: usize = 200;

#[test]
fn mutants_are_caught_or_harmless() {
    let asked = std::env::var("CARRYSTEP_MUTANTS").unwrap_or_default();
    let (few, writes) = (asked.is_empty(), asked == "write");
    assert!(few || writes || asked == "all", "CARRYSTEP_MUTANTS is all or write, not {asked}");
    let sample = sample(&stimuli::verilog(), "carrystep_engine", if few { FEW } else { ALL });
    let stimuli = stimuli::all(&stimuli::build());
    for stimulus in stimuli.iter().filter(|_| !few) {
        assert!(
            !differs(&sample, 0, stimulus),
            "without a mutant nothing may differ: {}",
            stimulus.name
        );
    }
    let caught = catchers(&sample, &stimuli);
    effort::say(&table(&stimuli, &caught));

    let listed = survivors::read();
    let alive = survivors_of(&sample, &caught, &listed, few);
    if writes {
        survivors::write(&alive);
    }
    summary(&sample, &caught, &alive);
    let without: Vec<&String> =
        alive.iter().filter(|(_, reason)| *reason == NO_REASON).map(|(name, _)| name).collect();
    assert!(
        without.is_empty(),
        "nothing catches, and nobody says why it is harmless:\n{without:#?}"
    );
    let drawn = |name: &String| sample.mutants.iter().any(|mutant| mutant.name == *name);
    let gone: Vec<&String> =
        listed.keys().filter(|name| !alive.contains_key(*name) && (!few || drawn(name))).collect();
    assert!(
        writes || gone.is_empty(),
        "listed in docs/mutants.md, but caught or no longer drawn:\n{gone:#?}"
    );
    if !few && !writes {
        assert_eq!(
            alive, listed,
            "docs/mutants.md is not what is known now: run `cargo xtask mutants --write`"
        );
    }
    no_harm_is_proved_harmless(&sample, &caught);
    kept::say();
}

/// The mutants that are not caught, with the reason why they are harmless: a proof if there is one,
/// otherwise the listed reason. In a short run the listed reasons are used without a new proof.
fn survivors_of(
    sample: &Sample,
    caught: &[Option<&str>],
    listed: &Survivors,
    few: bool,
) -> Survivors {
    let is_open = |place: &usize| caught[*place].is_none();
    let (known, open): (Vec<usize>, Vec<usize>) = (0..caught.len())
        .filter(is_open)
        .partition(|place| few && listed.contains_key(&sample.mutants[*place].name));
    let name = |place: usize| sample.mutants[place].name.clone();
    let mut alive: Survivors =
        known.into_iter().map(|place| (name(place), listed[&name(place)].clone())).collect();
    for (place, judgement) in open.iter().zip(judge(sample, &open)) {
        let written = listed.get(&name(*place)).filter(|reason| !reason.starts_with(PROVED));
        let reason = match judgement {
            Judgement::Breaks(_) => continue,
            Judgement::Equal(scope) => survivors::proved(scope),
            Judgement::Open => written.cloned().unwrap_or_else(|| NO_REASON.to_owned()),
        };
        alive.insert(name(*place), reason);
    }
    alive
}

/// Checks that the proof can fail: in each module, the first mutant that a recording catches must
/// not be proved equal.
fn no_harm_is_proved_harmless(sample: &Sample, caught: &[Option<&str>]) {
    let mut modules = BTreeSet::new();
    let harmful = sample
        .mutants
        .iter()
        .zip(caught)
        .filter(|(_, caught)| caught.is_some())
        .map(|(mutant, _)| mutant);
    let first: Vec<&Mutant> = harmful.filter(|mutant| modules.insert(&mutant.module)).collect();
    let wrong: Vec<&str> =
        jobs::each(&first, |mutant| (is_proved(sample, mutant, Scope::Module), &*mutant.name))
            .into_iter()
            .filter_map(|(proved, name)| proved.then_some(name))
            .collect();
    assert!(
        wrong.is_empty() && first.len() > 4,
        "caught by a recording, and proved to be the engine: {wrong:#?}"
    );
}

/// The figures for `docs/long-runs.md`.
fn summary(sample: &Sample, caught: &[Option<&str>], alive: &Survivors) {
    let by_recordings = caught.iter().flatten().count();
    let by_promises = sample.mutants.len() - by_recordings - alive.len();
    let proved = alive.values().filter(|reason| reason.starts_with(PROVED)).count();
    effort::figures(&format!(
        "{} mutants: {by_recordings} caught by recordings, {by_promises} by promises; harmless: {proved} by proof, {} by a written reason",
        sample.mutants.len(),
        alive.len() - proved
    ));
}

/// The number of mutants that each recording is the first to catch.
fn table(stimuli: &[Stimulus], caught: &[Option<&str>]) -> String {
    let mut counts: BTreeMap<Option<&str>, usize> = BTreeMap::new();
    for catcher in caught {
        *counts.entry(*catcher).or_default() += 1;
    }
    let rows = stimuli.iter().filter_map(|stimulus| {
        Some((stimulus.name.as_str(), *counts.get(&Some(stimulus.name.as_str()))?))
    });
    let alive = counts.get(&None).copied().unwrap_or(0);
    let rows = rows
        .chain([("no recording", alive)])
        .map(|(name, count)| format!("{count:>4} mutants are caught by: {name}\n"));
    rows.collect()
}

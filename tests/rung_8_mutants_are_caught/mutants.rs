//! Each mutant of the exported engine is caught by lock-step with the model or by a
//! promise, or `docs/mutants.md` lists it as proved equal to the engine or with the reason why it
//! is harmless. A test run covers a few mutants; `cargo xtask mutants` covers all of them and
//! repeats the proofs.

use carrystep_tests::mutants::draw::{self, Mutant, Sample, sample};
use carrystep_tests::mutants::equal::{Scope, is_proved};
use carrystep_tests::mutants::stimuli::{self, Engine, Stimulus};
use carrystep_tests::mutants::survivors::{self, NO_REASON, PROVED, Survivors};
use carrystep_tests::mutants::{Judgement, catchers, differs, judge};
use carrystep_tests::{effort, jobs};
use carrystep_tools::kept;
use std::collections::{BTreeMap, BTreeSet};

/// Number of mutants of the shipped engine in every test run: the first ones of all.
const FEW: usize = 12;
/// Their number if `CARRYSTEP_MUTANTS` is `all`, or `write`, which also rewrites the lists of
/// survivors.
const ALL: usize = 200;
/// The same numbers of the modules that only the engine with everything has.
const FEW_OF_FULL: usize = 6;
const ALL_OF_FULL: usize = 60;

/// The modules of which the mutants of the engine with everything are drawn. The shipped engine
/// does not have what they do, or only a part of it.
const NEW: [&str; 10] = [
    "output_control",
    "output_words",
    "duty_words",
    "pulse_width",
    "cut_control",
    "edge_latch",
    "switches",
    "switch_memory",
    "seek_control",
    "readout",
];

/// The modules of which only those lines are drawn in which the shipped engine has no gate: the
/// cut's part of the queue, and what the engine connects.
const PARTLY_NEW: [&str; 2] = ["queue", "engine"];

/// How many mutants are wanted.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Effort {
    Few,
    All,
    /// All, and the list of survivors is rewritten.
    Write,
}

impl Effort {
    fn asked() -> Self {
        match std::env::var("CARRYSTEP_MUTANTS").unwrap_or_default().as_str() {
            "" => Self::Few,
            "all" => Self::All,
            "write" => Self::Write,
            asked => panic!("CARRYSTEP_MUTANTS is all or write, not {asked}"),
        }
    }
}

#[test]
fn mutants_of_the_shipped_engine_are_caught_or_harmless() {
    let effort = Effort::asked();
    let engine = stimuli::shipped();
    let count = if effort == Effort::Few { FEW } else { ALL };
    let sample = sample(&engine.built, count, |_| true);
    caught_or_harmless("shipped", &engine, &sample, effort);
}

#[test]
fn mutants_of_the_new_modules_are_caught_or_harmless() {
    let effort = Effort::asked();
    let engine = stimuli::full();
    let count = if effort == Effort::Few { FEW_OF_FULL } else { ALL_OF_FULL };
    let shipped = draw::places(&stimuli::shipped_engine());
    let sample = sample(&engine.built, count, |place| {
        let module = place.split(':').next().unwrap_or_default();
        NEW.contains(&module) || (PARTLY_NEW.contains(&module) && !shipped.contains(place))
    });
    caught_or_harmless("full", &engine, &sample, effort);
}

/// Runs the mutants of an engine, and judges those that no recording catches.
fn caught_or_harmless(name: &str, engine: &Engine, sample: &Sample, effort: Effort) {
    let (few, writes) = (effort == Effort::Few, effort == Effort::Write);
    let stimuli = &engine.stimuli;
    for stimulus in stimuli.iter().filter(|_| !few) {
        assert!(
            !differs(sample, 0, stimulus),
            "without a mutant nothing may differ: {}",
            stimulus.name
        );
    }
    let caught = catchers(sample, stimuli);
    effort::say(&table(stimuli, &caught));

    let listed = survivors::read(name);
    let alive = survivors_of(sample, &caught, &listed, few);
    if writes {
        survivors::write(name, &alive);
    }
    summary(name, sample, &caught, &alive);
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
    if effort == Effort::All {
        assert_eq!(
            alive, listed,
            "docs/mutants.md is not what is known now: run `cargo xtask mutants --write`"
        );
    }
    no_harm_is_proved_harmless(sample, &caught);
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
/// not be proved equal. The top module is left out: the question is then about the whole engine, and
/// ends at its time limit without a verdict.
fn no_harm_is_proved_harmless(sample: &Sample, caught: &[Option<&str>]) {
    let mut modules = BTreeSet::from(["engine"]);
    let harmful = sample
        .mutants
        .iter()
        .zip(caught)
        .filter(|(_, caught)| caught.is_some())
        .map(|(mutant, _)| mutant);
    let first: Vec<&Mutant> = harmful.filter(|mutant| modules.insert(&*mutant.module)).collect();
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
fn summary(name: &str, sample: &Sample, caught: &[Option<&str>], alive: &Survivors) {
    let by_recordings = caught.iter().flatten().count();
    let by_promises = sample.mutants.len() - by_recordings - alive.len();
    let proved = alive.values().filter(|reason| reason.starts_with(PROVED)).count();
    effort::figures(&format!(
        "{} mutants of the {name} engine: {by_recordings} caught by recordings, {by_promises} by promises; harmless: {proved} by proof, {} by a written reason",
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

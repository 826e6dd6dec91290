//! Rung 8: mutants of the exported engine against lock-step with the model; those that it does not catch are
//! put to a proof that they are the engine, and those that are not proved to the promises of rung 7.
//!
//! ```text
//! the engine's Verilog for 2 us -- yosys mutate --> one netlist that holds them all -- Verilator --> a program
//! the model -- recordings of moves, starts, stops --------------------------------------------------> is run against it
//! ```

pub mod draw;
pub mod equal;
pub mod promises;
pub mod stimuli;
pub mod survivors;

use crate::effort;
use crate::jobs::each;
use carrystep_levels::engine::replay::difference_of_mutant;
use draw::Sample;
use stimuli::Stimulus;

/// For each mutant, the first recording that it differs from.
///
/// # Panics
/// Where a tool is missing.
pub fn catchers<'a>(sample: &Sample, stimuli: &'a [Stimulus]) -> Vec<Option<&'a str>> {
    let places: Vec<usize> = (0..sample.mutants.len()).collect();
    each(&places, |place| {
        let mutant = &sample.mutants[*place];
        let mut fitting = stimuli.iter().filter(|stimulus| stimulus.is_for(&mutant.module));
        let catcher = fitting.find(|stimulus| differs(sample, place + 1, stimulus)).map(|s| s.name.as_str());
        effort::say(&format!("{} is caught by {}: {}", place + 1, catcher.unwrap_or("no recording"), mutant.name));
        catcher
    })
}

/// What is known of a mutant that lock-step does not catch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Judgement {
    /// It is proved to be the engine.
    Equal(equal::Scope),
    /// It breaks a promise of this module.
    Breaks(&'static str),
    /// Neither: a person has to say why it is harmless.
    Open,
}

/// Asks the other judges about mutants, by their places.
///
/// # Panics
/// Where a tool is missing.
pub fn judge(sample: &Sample, places: &[usize]) -> Vec<Judgement> {
    each(places, |place| {
        let mutant = &sample.mutants[*place];
        let judgement = match equal::proved(sample, mutant) {
            Some(scope) => Judgement::Equal(scope),
            None => promises::broken(sample, mutant).map_or(Judgement::Open, Judgement::Breaks),
        };
        effort::say(&format!("{}: {judgement:?}: {}", place + 1, mutant.name));
        judgement
    })
}

/// Whether a mutant (0: the engine as it is) is not the model.
///
/// # Panics
/// Where a tool is missing.
pub fn differs(sample: &Sample, mutant: usize, stimulus: &Stimulus) -> bool {
    difference_of_mutant(&sample.verilog, mutant, &stimulus.recording).expect("the tools").is_some()
}

//! Rung 8: runs mutants of the exported engine in lock-step with the model. A mutant that no
//! recording catches goes to a proof that it equals the engine. A mutant that is not proved equal
//! goes to the promises of rung 7.
//!
//! ```text
//! an engine's Verilog for 2 us -- yosys mutate --> one netlist of all -- Verilator --> a program
//! the model -- recordings of moves, starts, stops ------------------------------------> runs it
//! ```

pub mod draw;
pub mod equal;
pub mod planted;
pub mod promises;
pub mod stimuli;
pub mod survivors;

use crate::effort;
use crate::jobs::each;
use carrystep_simulators::engine::replay::difference_of_mutant;
use draw::Sample;
use stimuli::Stimulus;

/// For each mutant, the name of the first recording from which it differs.
///
/// # Panics If a tool is missing.
pub fn catchers<'a>(sample: &Sample, stimuli: &'a [Stimulus]) -> Vec<Option<&'a str>> {
    let places: Vec<usize> = (0..sample.mutants.len()).collect();
    each(&places, |place| {
        let mutant = &sample.mutants[*place];
        let mut fitting = stimuli.iter().filter(|stimulus| stimulus.is_for(&mutant.module));
        let catcher =
            fitting.find(|stimulus| differs(sample, place + 1, stimulus)).map(|s| s.name.as_str());
        effort::say(&format!(
            "{} is caught by {}: {}",
            place + 1,
            catcher.unwrap_or("no recording"),
            mutant.name
        ));
        catcher
    })
}

/// The judgement on a mutant that lock-step does not catch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Judgement {
    /// The mutant is proved equal to the engine.
    Equal(equal::Scope),
    /// The mutant breaks a promise of this module.
    Breaks(&'static str),
    /// Neither; a person must find out why it is harmless.
    Open,
}

/// Judges the mutants with these indices: first by a proof of equality, then by the promises.
///
/// # Panics If a tool is missing.
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

/// True if a mutant (0: the unchanged engine) differs from the model.
///
/// # Panics If a tool is missing.
pub fn differs(sample: &Sample, mutant: usize, stimulus: &Stimulus) -> bool {
    difference_of_mutant(&sample.verilog, mutant, &stimulus.recording).expect("the tools").is_some()
}

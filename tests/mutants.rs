//! Rung 8: mutants of the exported engine against lock-step with the model.
//!
//! ```text
//! hdl-out/core/carrystep_engine.v -- yosys mutate --> one netlist that holds them all -- Verilator --> a program
//! the model -- recordings of moves, starts, stops --------------------------------------------------> is run against it
//! ```

pub mod draw;
pub mod stimuli;
pub mod survivors;

use crate::effort;
use carrystep_levels::engine::replay::difference_of_mutant;
use draw::Sample;
use std::sync::atomic::{AtomicUsize, Ordering};
use stimuli::Stimulus;

/// Simulations at a time.
const JOBS: usize = 2;

/// For each mutant, the first recording that it differs from.
///
/// # Panics
/// Where a tool is missing.
pub fn catchers<'a>(sample: &Sample, stimuli: &'a [Stimulus]) -> Vec<Option<&'a str>> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut found = Vec::new();
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(mutant) = sample.mutants.get(place) else { return found };
            let mut fitting = stimuli.iter().filter(|stimulus| stimulus.is_for(&mutant.module));
            let catcher = fitting.find(|stimulus| differs(sample, place + 1, stimulus)).map(|s| s.name.as_str());
            effort::say(&format!("{} is caught by {}: {}", place + 1, catcher.unwrap_or("NOTHING"), mutant.name));
            found.push((place, catcher));
        }
    };
    let mut found = std::thread::scope(|scope| {
        let jobs: Vec<_> = (0..JOBS).map(|_| scope.spawn(work)).collect();
        jobs.into_iter().flat_map(|job| job.join().expect("the tools")).collect::<Vec<_>>()
    });
    found.sort_by_key(|(place, _)| *place);
    found.into_iter().map(|(_, catcher)| catcher).collect()
}

/// Whether a mutant (0: the engine as it is) is not the model.
///
/// # Panics
/// Where a tool is missing.
pub fn differs(sample: &Sample, mutant: usize, stimulus: &Stimulus) -> bool {
    difference_of_mutant(&sample.verilog, mutant, &stimulus.recording).expect("the tools").is_some()
}

//! The engines of which mutants are drawn, and the stimuli of these mutants: the model's recordings
//! of normal work, of all kinds of stops, and of what only one of the engines has.

mod coincidences;
mod cruise;
mod full;
mod kinds;
mod resets;
mod stops;
mod work;

use crate::moves::root;
use crate::proofs::builds::BuiltEngine;
use carrystep_core::{EngineBuild, Program};
use carrystep_files::{Machine, SourceText};
use carrystep_simulators::engine::Events;
use carrystep_simulators::engine::replay::Recording;
use proptest::strategy::{Strategy, ValueTree as _};
use proptest::test_runner::{Config, RngSeed, TestRunner};
use std::sync::Arc;

/// The seed of the random programs, so that every run has the same ones.
const SEED: u64 = 2009;

/// More clocks than any program takes.
const MOST_CLOCKS: u64 = 20_000_000;

/// A recording and its description.
#[derive(Clone)]
pub struct Stimulus {
    /// Description for a person.
    pub name: String,
    /// The model's recording.
    pub recording: Recording,
    /// The modules whose mutants run against this recording; empty means all. Long recordings are
    /// restricted, so that a surviving mutant takes only seconds.
    modules: &'static [&'static str],
}

/// An engine of which mutants are drawn.
pub struct Engine {
    /// Its build and its Verilog.
    pub built: BuiltEngine,
    /// All recordings in the order of use: those that catch many mutants in few clocks come first.
    pub stimuli: Vec<Stimulus>,
}

/// The shipped machine with ticks of 2 us at 48 MHz, that of the slower boards: the times of its
/// recordings are written for it.
pub fn shipped_engine() -> BuiltEngine {
    let path = root().join("sim/six-axis.toml");
    let text = std::fs::read_to_string(&path).expect("the shipped machine");
    let shipped = "clock_hz = 80_000_000\ntick_ns = 1000\n";
    assert!(text.contains(shipped), "the shipped machine has another clock or tick");
    let text = text.replace(shipped, "clock_hz = 48_000_000\ntick_ns = 2000\n");
    let source = SourceText { path, text: text.into() };
    let build = Machine::from_source(&source).expect("a fine machine").engine();
    let verilog = verilog(&build);
    (build, verilog)
}

/// The same with its recordings.
pub fn shipped() -> Engine {
    let built = shipped_engine();
    let build = &built.0;
    let stimuli = [work::all(build), stops::all(build), resets::all(build), kinds::all(build)];
    Engine { stimuli: stimuli.concat(), built }
}

/// The engine that has everything built in.
pub fn full() -> Engine {
    let build = full::build();
    Engine { stimuli: full::all(&build), built: (build.clone(), verilog(&build)) }
}

fn verilog(build: &EngineBuild) -> Arc<str> {
    carrystep_verilog::engine_verilog(build, "the mutants").expect("a fine build").into()
}

impl Stimulus {
    fn new(
        build: &EngineBuild,
        name: impl Into<String>,
        program: &Program,
        events: &Events,
    ) -> Self {
        Self {
            name: name.into(),
            recording: Recording::new(build, program, events, MOST_CLOCKS),
            modules: &[],
        }
    }

    fn only_for(self, modules: &'static [&'static str]) -> Self {
        Self { modules, ..self }
    }

    /// True if the mutants of a module run against this recording.
    pub fn is_for(&self, module: &str) -> bool {
        self.modules.is_empty() || self.modules.contains(&module)
    }
}

/// Draws `count` programs with the fixed seed.
fn drawn<T>(strategy: &impl Strategy<Value = T>, count: usize) -> Vec<T> {
    let config =
        Config { rng_seed: RngSeed::Fixed(SEED), failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new(config);
    (0..count).map(|_| strategy.new_tree(&mut runner).expect("a program").current()).collect()
}

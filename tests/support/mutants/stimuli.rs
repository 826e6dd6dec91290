//! The stimuli of the mutants: the model's recordings of the shipped machine in normal work and in
//! all kinds of stops.

mod coincidences;
mod cruise;
mod resets;
mod stops;
mod work;

use crate::moves::root;
use carrystep_core::{EngineBuild, Program};
use carrystep_files::{Machine, SourceText};
use carrystep_simulators::engine::Events;
use carrystep_simulators::engine::replay::Recording;
use proptest::strategy::{Strategy, ValueTree as _};
use proptest::test_runner::{Config, RngSeed, TestRunner};

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

/// The shipped machine with ticks of 2 us at 48 MHz, that of the slower boards: the times of all
/// recordings are written for it.
pub fn build() -> EngineBuild {
    let path = root().join("sim/six-axis.toml");
    let text = std::fs::read_to_string(&path).expect("the shipped machine");
    let shipped = "clock_hz = 80_000_000\ntick_ns = 1000\n";
    assert!(text.contains(shipped), "the shipped machine has another clock or tick");
    let text = text.replace(shipped, "clock_hz = 48_000_000\ntick_ns = 2000\n");
    Machine::from_source(&SourceText { path, text: text.into() }).expect("a fine machine").engine()
}

/// The Verilog that is exported for it.
pub fn verilog() -> String {
    carrystep_verilog::engine_verilog(&build(), "the mutants").expect("a fine build")
}

/// All recordings in the order of use: those that catch many mutants in few clocks come first.
pub fn all(build: &EngineBuild) -> Vec<Stimulus> {
    [work::all(build), stops::all(build), resets::all(build)].concat()
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

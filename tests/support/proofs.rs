//! Rung 7: the promises as proofs by induction on the exported Verilog.
//!
//! The `promises.sv` of a module stands beside its Rust source. It instantiates the exported module
//! and states the promises as assertions on its ports, together with the invariants that make them
//! inductive. Each case of a proof (a set of build parameters) consists of three questions to the
//! solver, and each planted bug is one more:
//!
//! ```text
//! base       promises and invariants hold from configuration on for the depth of the induction
//! induction  if they held for this depth, they hold one clock later, and therefore for ever
//! covers     the situations of the promises occur: some run reaches each cover (first case only)
//! bug        on Verilog with one text changed, the promise fails in a run from configuration on
//! ```
//!
//! To add a module, write its `promises.sv`, add a file in `proofs/` that lists its cases and bugs,
//! and add a line to [`all`].

mod adder;
mod axis;
pub(crate) mod builds;
mod cut_control;
mod edge;
mod edge_latch;
mod engine;
pub mod equivalence;
mod event_wheel;
mod findings;
pub mod independence;
mod lane_seek;
mod lane_slots;
mod latch_bank;
mod modules;
mod output_control;
mod parallel_core;
mod promises;
mod pulse_width;
mod pulser;
mod queue;
mod readout;
mod resets;
mod seek_control;
mod sequencer;
mod shaper;
mod solver;
mod step_counts;
mod stops;
mod supervisor;
mod switches;
mod table;
mod tick;
mod time_slot;
mod wide;

pub use promises::Promises;
pub use solver::{ProofError, Question, ask, tools};
pub use table::table;

use std::sync::Arc;

/// The proof of one module.
pub struct Proof {
    /// The module, named as its folder in `crates/hdl/src`.
    pub module: &'static str,
    /// Its `promises.sv`.
    pub promises: Promises,
    /// The cases for which it is proved; covers and bugs use the first one.
    pub cases: Vec<Case>,
    /// Depth k of the induction, in clocks.
    pub depth: u32,
    /// Number of clocks within which every cover is reached and every bug is detected.
    pub reach: u32,
    /// The planted bugs.
    pub bugs: &'static [Bug],
}

/// Build parameters, and the Verilog that was exported for them.
#[derive(Clone)]
pub struct Case {
    /// Description for a person.
    pub name: String,
    /// The name of the exported module.
    pub dut: String,
    /// The module's parameters with the values that replace those of the text.
    pub parameters: Vec<(&'static str, u32)>,
    /// The whole exported text.
    pub verilog: Arc<str>,
    /// The numbers that `promises.sv` takes as parameters.
    pub numbers: Vec<(&'static str, String)>,
}

/// A change of the exported module, and the promise that it breaks.
pub struct Bug {
    /// Label of the assertion in `promises.sv` that must fail.
    pub breaks: &'static str,
    /// The original text, which occurs in the module exactly once.
    pub text: &'static str,
    /// The replacement.
    pub becomes: &'static str,
}

impl Case {
    /// Number of axes for which a star in `promises.sv` stands: the parameter `AXES`.
    pub fn axes(&self) -> usize {
        self.number("AXES")
    }

    /// Number of lanes, for which a `#` stands there: the parameter `LANES`.
    pub fn lanes(&self) -> usize {
        self.number("LANES")
    }

    /// A parameter of `promises.sv`; 1 if there is none of this name.
    fn number(&self, wanted: &str) -> usize {
        let mut numbers = self.numbers.iter();
        let found = numbers.find(|(name, _)| *name == wanted);
        found.and_then(|(_, number)| number.parse().ok()).unwrap_or(1)
    }

    /// The same Verilog with a bug planted.
    ///
    /// # Panics
    /// If the text does not occur in the module exactly once; the bug must then be rewritten.
    pub fn with(&self, bug: &Bug) -> Self {
        let begins =
            [" (", " #("].map(|head| self.verilog.find(&format!("module {}{head}\n", self.dut)));
        let start = begins.into_iter().flatten().next().expect("the module is in its Verilog");
        let end = start + self.verilog[start..].find("endmodule").expect("the module ends");
        let module = &self.verilog[start..end];
        let found = module.matches(bug.text).count();
        assert_eq!(
            found, 1,
            "{}: '{}' stands {found} times in {}, not once",
            bug.breaks, bug.text, self.dut
        );
        let changed = module.replace(bug.text, bug.becomes);
        let verilog = [&self.verilog[..start], &changed, &self.verilog[end..]].concat();
        Self { verilog: verilog.into(), ..self.clone() }
    }
}

/// Every proof, the slowest ones first, of the committed Verilog and of small and extreme builds.
pub fn all() -> Vec<Proof> {
    let mut all = all_with(&builds::shipped_engine());
    all.extend(of_several_adders());
    all
}

/// Those of the modules that only engines with several adders have.
fn of_several_adders() -> [Proof; 4] {
    [wide::proof(), lane_seek::proof(), lane_slots::proof(), findings::proof()]
}

/// Those of the modules of an engine with one adder, with another one in the place of the committed
/// one.
pub fn all_with(engine: &builds::BuiltEngine) -> Vec<Proof> {
    vec![
        shaper::proof(),
        axis::proof(),
        sequencer::proof(),
        tick::proof(),
        edge::proof(),
        parallel_core::proof(),
        pulser::proof(engine),
        stops::proof(engine),
        supervisor::proof(engine),
        queue::proof(engine),
        step_counts::proof(engine),
        readout::proof(engine),
        switches::proof(engine),
        seek_control::proof(engine),
        edge_latch::proof(engine),
        latch_bank::proof(),
        resets::proof(engine),
        cut_control::proof(engine),
        output_control::proof(engine),
        pulse_width::proof(engine),
        time_slot::proof(engine),
        event_wheel::proof(engine),
        adder::proof(engine),
        engine::proof(engine),
    ]
}

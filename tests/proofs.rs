//! Rung 7: the promises as proofs, by induction on the exported Verilog as it stands.
//!
//! A module's `promises.sv` stands beside its Rust source: it instantiates the exported module, says the
//! promises as assertions on its ports, and the invariants that make them inductive. Each case of a proof
//! (a set of build parameters) is three questions to the solver, and a planted bug is one more:
//!
//! ```text
//! base       promises and invariants hold from configuration on, as far as the induction is deep
//! induction  where they held, they hold one clock later: so they hold for ever
//! covers     what the promises speak of does happen, each cover in some run (the first case)
//! bug        the promise alone, from configuration, on Verilog with one text changed: must fail
//! ```
//!
//! To add a module: its `promises.sv`, a file in `proofs/` that lists its cases and bugs, a line in [`all`].

mod adder;
mod axis;
pub(crate) mod builds;
mod edge;
mod engine;
pub mod equivalence;
mod homes;
mod limits;
mod promises;
mod pulser;
mod queue;
mod sequencer;
mod shaper;
mod six_axis;
mod solver;
mod stops;
mod table;
mod tick;
mod turn;
mod watch;
mod wheel;

pub use promises::Promises;
pub use solver::{ProofError, Question, ask, tools};
pub use table::table;

use std::sync::Arc;

/// One module's proof.
pub struct Proof {
    /// The module, named as its folder in `crates/hdl/src`.
    pub module: &'static str,
    /// Its `promises.sv`.
    pub promises: Promises,
    /// What it is proved for; covers and bugs take the first.
    pub cases: Vec<Case>,
    /// Depth k of the induction.
    pub depth: u32,
    /// Clocks within which every cover is reached, and every bug is seen.
    pub reach: u32,
    /// What must not go unnoticed.
    pub bugs: &'static [Bug],
}

/// Build parameters, and the Verilog that was exported for them.
#[derive(Clone)]
pub struct Case {
    /// For a person.
    pub name: String,
    /// The exported module.
    pub dut: String,
    /// The exported text, whole.
    pub verilog: Arc<str>,
    /// What `promises.sv` takes from outside.
    pub numbers: Vec<(&'static str, String)>,
}

/// A change of the exported module, and the promise that it breaks.
pub struct Bug {
    /// Label of the assertion in `promises.sv` that must fail.
    pub breaks: &'static str,
    /// The text; it stands in the module exactly once.
    pub text: &'static str,
    /// What it becomes.
    pub becomes: &'static str,
}

impl Case {
    /// How many axes a star in `promises.sv` stands for: the number `AXES`.
    pub fn axes(&self) -> usize {
        self.numbers.iter().find(|(name, _)| *name == "AXES").and_then(|(_, axes)| axes.parse().ok()).unwrap_or(1)
    }

    /// The same Verilog with a bug planted.
    ///
    /// # Panics
    /// Where the text is not in the module exactly once: then the bug has to be written anew.
    pub fn with(&self, bug: &Bug) -> Self {
        let start = self.verilog.find(&format!("module {} (", self.dut)).expect("the module is in its Verilog");
        let end = start + self.verilog[start..].find("endmodule").expect("the module ends");
        let module = &self.verilog[start..end];
        let found = module.matches(bug.text).count();
        assert_eq!(found, 1, "{}: '{}' stands {found} times in {}, not once", bug.breaks, bug.text, self.dut);
        let changed = module.replace(bug.text, bug.becomes);
        let verilog = [&self.verilog[..start], &changed, &self.verilog[end..]].concat();
        Self { verilog: verilog.into(), ..self.clone() }
    }
}

/// Every proof, the slowest first, of the committed Verilog and of small and extreme builds.
pub fn all() -> Vec<Proof> {
    all_with(&builds::shipped_engine())
}

/// The same with another engine in the place of the committed one.
pub fn all_with(engine: &builds::BuiltEngine) -> Vec<Proof> {
    vec![
        shaper::proof(),
        axis::proof(),
        sequencer::proof(),
        tick::proof(),
        edge::proof(),
        six_axis::proof(),
        pulser::proof(engine),
        stops::proof(engine),
        watch::proof(engine),
        queue::proof(engine),
        limits::proof(engine),
        homes::proof(engine),
        turn::proof(engine),
        wheel::proof(engine),
        adder::proof(engine),
        engine::proof(engine),
    ]
}

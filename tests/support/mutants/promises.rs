//! The last judge of a mutant: the promises of rung 7 for the mutant's module.
//!
//! Only a run from configuration on that breaks a promise counts, found clock by clock. A failing
//! induction proves nothing.

use super::draw::{Mutant, Sample};
use crate::proofs::builds::pin_parameters;
use crate::proofs::{self, Case, Proof, ProofError, Question};

/// The module whose promises a mutant breaks. A promise that the engine itself breaks in this form
/// cannot judge.
///
/// # Panics If a tool is missing or fails.
pub fn broken(sample: &Sample, mutant: &Mutant) -> Option<&'static str> {
    let built = &sample.built;
    let dut = format!("carrystep_{}", mutant.module);
    // A pulser is named after its axis. All are one module in the exported text, but not in the
    // netlist.
    let axis = mutant.module.strip_prefix("pulser_").and_then(|axis| axis.parse::<usize>().ok());
    let pins = axis.map(|axis| pin_parameters(&built.0.pins[axis]));
    let is_own = |case: &Case| match &pins {
        Some(pins) => case.dut == "carrystep_pulser" && case.parameters == *pins,
        None => case.dut == dut,
    };
    let breaks = |proof: &Proof, mutant: Option<&Mutant>| {
        let mut cases = proof.cases.iter().filter(|case| is_own(case) && case.verilog == built.1);
        let verilog = sample.alone(mutant);
        cases.any(|case| {
            // The mutant's netlist has no parameters.
            let case = Case {
                verilog: verilog.as_str().into(),
                dut: dut.clone(),
                parameters: Vec::new(),
                ..case.clone()
            };
            match proofs::ask(&proof.promises, &case, Question::Broken(proof.reach)) {
                Ok(()) => true,
                Err(ProofError::Refuted(_)) => false,
                // A promise may refer to an internal wire that the mutant's netlist no longer has.
                Err(ProofError::Tool { said, .. }) if said.contains("Failed to parse set rhs") => {
                    false
                }
                Err(error) => panic!("{dut}: {error}"),
            }
        })
    };
    let proof = proofs::all_with(built).into_iter().find(|proof| breaks(proof, Some(mutant)))?;
    assert!(!breaks(&proof, None), "{dut} breaks its promises without a mutant");
    Some(proof.module)
}

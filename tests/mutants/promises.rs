//! The last judge: the promises of rung 7, asked of a mutant's module.
//!
//! Only a run that breaks a promise counts: one that is found, clock by clock, from configuration on. An induction that fails would say nothing.

use super::draw::{Mutant, Sample};
use super::stimuli;
use crate::proofs::builds::BuiltEngine;
use crate::proofs::{self, Case, Proof, ProofError, Question};

/// The module whose promises a mutant breaks. Promises that the engine breaks as it was taken apart would be no judge.
///
/// # Panics
/// Where a tool is missing or fails.
pub fn broken(sample: &Sample, mutant: &Mutant) -> Option<&'static str> {
    let built: BuiltEngine = (stimuli::build(), stimuli::verilog().into());
    let dut = format!("carrystep_{}", mutant.module);
    let breaks = |proof: &Proof, mutant: Option<&Mutant>| {
        let mut cases = proof.cases.iter().filter(|case| case.dut == dut && case.verilog == built.1);
        let verilog = sample.alone(mutant);
        cases.any(|case| {
            let case = Case { verilog: verilog.as_str().into(), ..case.clone() };
            match proofs::ask(&proof.promises, &case, Question::Broken(proof.reach)) {
                Ok(()) => true,
                Err(ProofError::Refuted(_)) => false,
                // A promise that looks inside may look for a wire that a mutant's netlist has no more.
                Err(ProofError::Tool { said, .. }) if said.contains("Failed to parse set rhs") => false,
                Err(error) => panic!("{dut}: {error}"),
            }
        })
    };
    let proof = proofs::all_with(&built).into_iter().find(|proof| breaks(proof, Some(mutant)))?;
    assert!(!breaks(&proof, None), "{dut} breaks its promises without a mutant");
    Some(proof.module)
}

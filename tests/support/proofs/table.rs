//! The table of what is proved: one row per promise and module.

use super::promises::number;
use super::{Proof, all};

/// The table that `cargo xtask prove` prints.
pub fn table() -> String {
    let mut rows: Vec<(u32, String)> = all().iter().flat_map(rows).collect();
    rows.sort();
    let head = "promise  module     assertions  cases  method               planted bugs caught\n";
    rows.into_iter().fold(head.to_owned(), |table, (_, row)| table + &row)
}

fn rows(proof: &Proof) -> Vec<(u32, String)> {
    let of = |promise: u32, labels: &mut dyn Iterator<Item = &'static str>| {
        labels.filter(|label| number(label) == Some(promise)).count()
    };
    let row = |promise: u32| {
        let assertions = of(promise, &mut proof.promises.labels().into_iter());
        let bugs = of(promise, &mut proof.bugs.iter().map(|bug| bug.breaks));
        format!(
            "{promise:>7}  {:<9}  {assertions:>10}  {:>5}  {:<19}  {bugs:>19}\n",
            proof.module,
            proof.cases.len(),
            format!("induction, k = {}", proof.depth),
        )
    };
    proof.promises.numbers().into_iter().map(|promise| (promise, row(promise))).collect()
}

//! The table of what is proved: one row per promise and module.

use super::promises::number;
use super::{Proof, all, independence};

/// The table that `cargo xtask prove` prints.
pub fn table() -> String {
    let mut rows: Vec<(u32, String)> = all().iter().flat_map(rows).collect();
    let (cases, bugs) = (independence::cases().len(), independence::BUGS.len());
    rows.push((
        independence::PROMISE,
        row(independence::PROMISE, "engine", 1, cases, "no path", bugs),
    ));
    rows.sort();
    let head = "promise  module     assertions  cases  method               planted bugs caught\n";
    rows.into_iter().fold(head.to_owned(), |table, (_, row)| table + &row)
}

fn rows(proof: &Proof) -> Vec<(u32, String)> {
    let of = |promise: u32, labels: &mut dyn Iterator<Item = &'static str>| {
        labels.filter(|label| number(label) == Some(promise)).count()
    };
    let method = format!("induction, k = {}", proof.depth);
    let row_of = |promise: u32| {
        let assertions = of(promise, &mut proof.promises.labels().into_iter());
        let bugs = of(promise, &mut proof.bugs.iter().map(|bug| bug.breaks));
        row(promise, proof.module, assertions, proof.cases.len(), &method, bugs)
    };
    proof.promises.numbers().into_iter().map(|promise| (promise, row_of(promise))).collect()
}

fn row(
    promise: u32,
    module: &str,
    assertions: usize,
    cases: usize,
    method: &str,
    bugs: usize,
) -> String {
    format!("{promise:>7}  {module:<9}  {assertions:>10}  {cases:>5}  {method:<19}  {bugs:>19}\n")
}

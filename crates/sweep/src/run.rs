//! The cases of a shard over all processors.

use crate::file::{Case, SweepFile};
use crate::report::{CaseVerdict, SweepReport};
use crate::shard::Shard;
use rayon::prelude::*;

/// Runs each case of a shard; a case that fails does not keep the others from running. `done` hears
/// of every case that is over. `core` names the gateware on which cases are judged.
pub fn run(
    sweep: &SweepFile,
    shard: Shard,
    core: &str,
    judge: impl Fn(&Case) -> CaseVerdict + Sync,
    done: impl Fn() + Sync,
) -> SweepReport {
    let one = |number: u64| {
        let case = sweep.case(number);
        let verdict = match &case.file {
            Ok(_) => judge(&case),
            Err(error) => CaseVerdict::Failed(error.to_string()),
        };
        let mut report = SweepReport::new(sweep, shard, core);
        report.add(number, &case.values, verdict);
        done();
        report
    };
    let cases: Vec<u64> = shard.cases(sweep.cases()).collect();
    cases
        .into_par_iter()
        .map(one)
        .reduce(|| SweepReport::new(sweep, shard, core), SweepReport::with)
}

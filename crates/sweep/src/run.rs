//! Runs the cases of a shard on all cores.

use crate::file::{Case, SweepFile};
use crate::report::{Report, Verdict};
use crate::shard::Shard;
use rayon::prelude::*;

/// Runs each case of a shard. A case that fails does not stop the others. `done` is called after
/// every case.
pub fn run(sweep: &SweepFile, shard: Shard, judge: impl Fn(&Case) -> Verdict + Sync, done: impl Fn() + Sync) -> Report {
    let one = |number: u64| {
        let case = sweep.case(number);
        let verdict = match &case.file {
            Ok(_) => judge(&case),
            Err(error) => Verdict::Failed(error.to_string()),
        };
        let mut report = Report::new(sweep, shard);
        report.add(number, &case.values, verdict);
        done();
        report
    };
    let cases: Vec<u64> = shard.cases(sweep.cases()).collect();
    cases.into_par_iter().map(one).reduce(|| Report::new(sweep, shard), Report::with)
}

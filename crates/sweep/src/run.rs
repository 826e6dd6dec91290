//! The cases of a shard over all processors.

use crate::error::SweepError;
use crate::file::{Case, SweepFile};
use crate::progress::Progress;
use crate::report::CaseVerdict;
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

/// Judges each case that is missing in `progress`; a case that fails does not keep the others from
/// running. `judge` may end the run by [`ControlFlow::Break`]; the result is then incomplete.
/// `after` gets the progress after each case.
///
/// # Errors
/// The first error of `after`, or a machine file that was changed during the run.
pub fn run(
    sweep: &SweepFile,
    progress: Progress,
    judge: impl Fn(&Case) -> ControlFlow<(), CaseVerdict> + Sync,
    after: impl FnMut(&Progress) -> Result<(), SweepError> + Send,
) -> Result<Progress, SweepError> {
    let shard = progress.shard();
    let remaining = progress.remaining();
    let state = Mutex::new((progress, after));
    let one = |place: u64| {
        let case = sweep.case(shard.case(place));
        let verdict = match &case.file {
            Ok(_) => judge(&case),
            Err(error) => ControlFlow::Continue(CaseVerdict::Failed(error.to_string())),
        };
        let ControlFlow::Continue(verdict) = verdict else { return Err(None) };
        let mut state = state.lock().unwrap_or_else(PoisonError::into_inner);
        let (progress, after) = &mut *state;
        progress.add(place, &case, verdict).and_then(|()| after(progress)).map_err(Some)
    };
    let result =
        remaining.into_par_iter().flat_map(IntoParallelIterator::into_par_iter).try_for_each(one);
    let (progress, _) = state.into_inner().unwrap_or_else(PoisonError::into_inner);
    match result {
        Ok(()) | Err(None) => Ok(progress),
        Err(Some(error)) => Err(error),
    }
}

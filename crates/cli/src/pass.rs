//! The commands of a plan, for a simulator that runs it.

use carrystep_core::Command;
use carrystep_plan::{PlannedMove, Survey};
use carrystep_profile::Reader;
use carrystep_simulators::Commands;
use std::sync::{Arc, Mutex, PoisonError};

/// The commands of a plan. They are those of a pass of their own, so that nothing is kept, or of a
/// pass that others read too.
#[derive(Debug)]
pub struct PlanCommands<'a> {
    survey: &'a Survey,
    /// The moves of a pass that others read.
    shared: Mutex<Option<Reader<Arc<PlannedMove>>>>,
}

impl<'a> PlanCommands<'a> {
    /// The commands of this plan.
    pub fn new(survey: &'a Survey) -> Self {
        Self { survey, shared: Mutex::new(None) }
    }

    /// The next run takes these moves, which others read too.
    pub fn share(&self, moves: Reader<Arc<PlannedMove>>) {
        *self.shared.lock().unwrap_or_else(PoisonError::into_inner) = Some(moves);
    }
}

impl Commands for PlanCommands<'_> {
    fn commands(&self) -> Box<dyn Iterator<Item = Command> + '_> {
        let shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner).take();
        let moves = shared.unwrap_or_else(|| self.survey.begin().moves);
        Box::new(moves.flat_map(|planned| planned.commands()))
    }

    fn segments(&self) -> u64 {
        self.survey.totals().segments()
    }
}

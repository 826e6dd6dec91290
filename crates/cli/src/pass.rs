//! The commands of a plan of moves for a simulator that runs it, and rows of programs that are
//! planned ahead of their reader.

use crate::failure::Failure;
use crate::interrupt;
use carrystep_core::Command;
use carrystep_plan::{self as plan, PlannedMove};
use carrystep_profile::Reader;
use carrystep_program::{ProgramError, Row};
use carrystep_simulators::Commands;
use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

/// The commands of a plan. They are those of a pass of their own, so that nothing is kept, or of a
/// pass that others read too.
#[derive(Debug)]
pub struct PlanCommands<'a> {
    survey: &'a plan::Survey,
    /// The moves of a pass that others read.
    shared: Mutex<Option<Reader<Arc<PlannedMove>>>>,
}

impl<'a> PlanCommands<'a> {
    /// The commands of this plan.
    pub fn new(survey: &'a plan::Survey) -> Self {
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

/// The first error of the passes over a program that feed a run. Each pass ends at its error, and
/// the run is then judged by it.
#[derive(Debug, Default)]
pub struct Kept(Mutex<Option<Failure>>);

impl Kept {
    /// What comes before the first error, which is kept.
    pub fn until_an_error<T, E: Into<Failure>>(
        &self,
        from: impl Iterator<Item = Result<T, E>>,
    ) -> impl Iterator<Item = T> {
        from.map_while(|one| match one {
            Ok(one) => Some(one),
            Err(error) => {
                self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error.into());
                None
            }
        })
    }

    /// Fails if there was an error.
    pub fn error(&self) -> Result<(), Failure> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take().map_or(Ok(()), Err)
    }
}

/// A batch of rows, or of the error that ends them.
type Batch = Vec<Result<Row, ProgramError>>;

/// Rows that are planned in a thread of their own, a little ahead of their reader.
pub struct RowsAhead<R> {
    batches: Option<Receiver<Batch>>,
    batch: std::vec::IntoIter<Result<Row, ProgramError>>,
    planner: Option<JoinHandle<R>>,
    /// The planner, after its last row.
    ended: Option<R>,
}

impl<R> RowsAhead<R> {
    /// Rows of a batch, and batches that may wait.
    const BATCH: usize = 256;
    const WAITING: usize = 4;
}

impl<R: Iterator<Item = Result<Row, ProgramError>> + Send + 'static> RowsAhead<R> {
    /// Begins to plan; ends early after a signal that ends programs.
    pub fn new(rows: R) -> Self {
        Self::until(rows, interrupt::is_asked)
    }

    /// Begins to plan; ends early where `ends` returns true.
    pub fn until(mut rows: R, ends: fn() -> bool) -> Self {
        let (sender, receiver) = sync_channel(Self::WAITING);
        let planner = std::thread::spawn(move || {
            loop {
                let batch: Batch = rows.by_ref().take(Self::BATCH).collect();
                // Nobody listens where a run has ended early.
                if batch.is_empty() || ends() || sender.send(batch).is_err() {
                    return rows;
                }
            }
        });
        let batch = Vec::new().into_iter();
        Self { batches: Some(receiver), batch, planner: Some(planner), ended: None }
    }

    /// Plans what is left, and returns the planner.
    pub fn finish(mut self) -> Option<R> {
        self.by_ref().for_each(drop);
        self.ended.take()
    }
}

impl<R> Iterator for RowsAhead<R> {
    type Item = Result<Row, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(row) = self.batch.next() {
                return Some(row);
            }
            match self.batches.as_ref()?.recv() {
                Ok(batch) => self.batch = batch.into_iter(),
                Err(_) => {
                    self.batches = None;
                    let ended = self.planner.take()?.join();
                    self.ended = Some(ended.unwrap_or_else(|panic| resume_unwind(panic)));
                    return None;
                }
            }
        }
    }
}

impl<R> Drop for RowsAhead<R> {
    fn drop(&mut self) {
        self.batches = None;
        // A panic of the planner has been passed on above, or the run has ended before it.
        let _ = self.planner.take().map(JoinHandle::join);
    }
}

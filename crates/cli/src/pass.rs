//! The commands of a plan of moves or of a program, for a simulator that runs it.

use carrystep_core::Command;
use carrystep_plan::{self as plan, PlannedMove};
use carrystep_profile::Reader;
use carrystep_program::{ProgramError, ProgramFile, Row, Rows, Survey};
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
pub struct Kept(Mutex<Option<ProgramError>>);

impl Kept {
    /// What comes before the first error, which is kept.
    pub fn until_an_error<T>(
        &self,
        from: impl Iterator<Item = Result<T, ProgramError>>,
    ) -> impl Iterator<Item = T> {
        from.map_while(|one| match one {
            Ok(one) => Some(one),
            Err(error) => {
                self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                None
            }
        })
    }

    /// Fails if there was an error.
    pub fn error(&self) -> Result<(), ProgramError> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take().map_or(Ok(()), Err)
    }
}

/// Rows that are planned in a thread of their own, a little ahead of their reader.
pub struct RowsAhead {
    batches: Option<Receiver<Vec<Result<Row, ProgramError>>>>,
    batch: std::vec::IntoIter<Result<Row, ProgramError>>,
    planner: Option<JoinHandle<()>>,
}

impl RowsAhead {
    /// Rows of a batch, and batches that may wait.
    const BATCH: usize = 256;
    const WAITING: usize = 4;

    /// Begins to plan.
    pub fn new(mut rows: Rows) -> Self {
        let (sender, receiver) = sync_channel(Self::WAITING);
        let planner = std::thread::spawn(move || {
            loop {
                let batch: Vec<_> = rows.by_ref().take(Self::BATCH).collect();
                // Nobody listens where a run has ended early.
                if batch.is_empty() || sender.send(batch).is_err() {
                    return;
                }
            }
        });
        let batch = Vec::new().into_iter();
        Self { batches: Some(receiver), batch, planner: Some(planner) }
    }
}

impl Iterator for RowsAhead {
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
                    return ended.map_or_else(|panic| resume_unwind(panic), |()| None);
                }
            }
        }
    }
}

impl Drop for RowsAhead {
    fn drop(&mut self) {
        self.batches = None;
        // A panic of the planner has been passed on above, or the run has ended before it.
        let _ = self.planner.take().map(JoinHandle::join);
    }
}

/// The commands of a planned program, which is planned anew for each run.
#[derive(Debug)]
pub struct RowCommands<'a> {
    file: &'a ProgramFile,
    survey: &'a Survey,
    kept: &'a Kept,
}

impl<'a> RowCommands<'a> {
    /// The commands of this program; `kept` gets the error that ends them early.
    pub fn new(file: &'a ProgramFile, survey: &'a Survey, kept: &'a Kept) -> Self {
        Self { file, survey, kept }
    }
}

impl Commands for RowCommands<'_> {
    fn commands(&self) -> Box<dyn Iterator<Item = Command> + '_> {
        let (rows, error) = match Rows::new(self.file) {
            Ok(rows) => (Some(RowsAhead::new(rows)), None),
            Err(error) => (None, Some(Err(error))),
        };
        let rows = rows.into_iter().flatten().chain(error);
        let mut begun = false;
        Box::new(self.kept.until_an_error(rows).flat_map(move |row| {
            let count = row.segments.len();
            let segment = |(axis, segment)| Command::Segment { axis, segment };
            let segments = (0..).zip(row.segments).map(segment);
            // All axes start when each has its first segment.
            let first = !std::mem::replace(&mut begun, true);
            segments.chain(first.then(|| Command::Start { mask: ((1_u16 << count) - 1) as u8 }))
        }))
    }

    fn segments(&self) -> u64 {
        self.survey.rows * self.survey.axes.len() as u64
    }
}

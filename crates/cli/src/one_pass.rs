//! A program that is planned once, in a thread of its own. The search for the first start looks at
//! the first rows, the run takes all rows, and the figures of each row are added up before either
//! gets it.
//!
//! ```text
//! planner's thread         read ahead                 taken
//! rows, figures  ------->  first rows, kept  ------>  the run
//!                            '-> search for the start, which only looks at them
//! ```

use crate::failure::Failure;
use crate::job;
use crate::pass::{Kept, RowsAhead};
use crate::recorded::{Recorded, RecordedRows};
use carrystep_check::DueChange;
use carrystep_core::{Command, Timebase};
use carrystep_program::{ProgramFile, Row, RowOutputs, Survey};
use carrystep_report::Detail;
use carrystep_simulators::Commands;
use carrystep_simulators::engine::run::TICKS_TO_SEND;
use std::collections::VecDeque;
use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Rows that are planned before anything is written: 16 s of motion or more.
const FIRST: usize = 4096;

/// The one pass over a program. As commands, it gives each row once.
pub struct OnePass<'a> {
    kept: &'a Kept,
    timebase: Timebase,
    /// The outputs before the first row.
    outputs: RowOutputs,
    pulled: Mutex<Pulled>,
    /// [`OnePass::clocks`].
    clocks: AtomicU64,
    /// Number of segments; 0 if it is not known.
    segments: u64,
    /// [`OnePass::next_due`] and [`OnePass::next_duty`].
    due: Mutex<VecDeque<DueChange>>,
    duties: Mutex<VecDeque<(u64, u16)>>,
}

/// The rows, as far as they have been read.
struct Pulled {
    ahead: RowsAhead<RecordedRows>,
    /// Rows that have been looked at and not taken.
    seen: VecDeque<Row>,
    /// Ticks of the rows that have been read, and of those that have been taken.
    ticks: u64,
    taken: u64,
    /// The outputs behind the rows that have been taken.
    outputs: RowOutputs,
}

impl<'a> OnePass<'a> {
    /// Begins to plan. `kept` receives the error that ends the pass early. `segments` is the number
    /// of segments if an earlier pass has counted them, else 0.
    pub fn new(
        file: &ProgramFile,
        detail: Detail,
        segments: u64,
        kept: &'a Kept,
    ) -> Result<Self, Failure> {
        let ahead = RowsAhead::new(RecordedRows::new(file, detail)?);
        let (seen, outputs) = (VecDeque::new(), file.row_outputs());
        let pulled = Pulled { ahead, seen, ticks: 0, taken: 0, outputs: outputs.clone() };
        Ok(Self {
            kept,
            timebase: file.machine().timebase,
            outputs,
            pulled: Mutex::new(pulled),
            clocks: AtomicU64::new(0),
            segments,
            due: Mutex::new(VecDeque::new()),
            duties: Mutex::new(VecDeque::new()),
        })
    }

    /// Looks at the first rows, so that a mistake of a short program is found before anything is
    /// written.
    pub fn begin(&self) -> Result<(), Failure> {
        self.look(FIRST - 1).transpose().map(drop)
    }

    /// The number of clocks that a run needs at most for the rows that have been read so far.
    pub fn clocks(&self) -> &AtomicU64 {
        &self.clocks
    }

    /// The same commands from the first row that has not been taken, which stays in its place.
    pub fn looked_at(&self) -> LookedAt<'_> {
        LookedAt(self)
    }

    /// Returns the changes of outputs in the rows that the run has taken, one after the other. Their
    /// times are in ps from the beginning of the first row.
    pub fn next_due(&self) -> Option<DueChange> {
        self.due.lock().unwrap_or_else(PoisonError::into_inner).pop_front()
    }

    /// The same of the duties that the rows set.
    pub fn next_duty(&self) -> Option<(u64, u16)> {
        self.duties.lock().unwrap_or_else(PoisonError::into_inner).pop_front()
    }

    /// Plans what is left, and returns the figures.
    pub fn finish(self, file: &ProgramFile) -> Result<(Survey, Recorded), Failure> {
        let Pulled { ahead, .. } = self.pulled.into_inner().unwrap_or_else(PoisonError::into_inner);
        let rows = ahead.finish();
        rows.map(|rows| rows.finish(file)).ok_or_else(|| Failure::Run("no plan".into()))
    }

    fn lock(&self) -> MutexGuard<'_, Pulled> {
        self.pulled.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reads the next row from the planner.
    fn pull(&self, pulled: &mut Pulled) -> Option<Result<Row, Failure>> {
        let row = match pulled.ahead.next()? {
            Ok(row) => row,
            Err(error) => return Some(Err(error.into())),
        };
        pulled.ticks = pulled.ticks.saturating_add(row.ticks.into());
        if job::fits_into_a_capture(pulled.ticks, &self.timebase).is_err() {
            return Some(Err(self.too_long(pulled)));
        }
        let send = TICKS_TO_SEND * row.segments.len() as u64;
        let clocks = (u64::from(row.ticks) + send) * u64::from(self.timebase.clocks_per_tick());
        self.clocks.fetch_add(clocks, Ordering::Relaxed);
        Some(Ok(row))
    }

    /// Plans the rest of a job that is too long, and tells how long it is.
    fn too_long(&self, pulled: &mut Pulled) -> Failure {
        for row in pulled.ahead.by_ref() {
            match row {
                Ok(row) => pulled.ticks = pulled.ticks.saturating_add(row.ticks.into()),
                Err(error) => return error.into(),
            }
        }
        let fits = job::fits_into_a_capture(pulled.ticks, &self.timebase);
        fits.err().unwrap_or_else(|| Failure::Run("the job is too long".into()))
    }

    /// Takes the next row.
    fn take(&self) -> Option<Result<Row, Failure>> {
        let mut pulled = self.lock();
        let row = pulled.seen.pop_front().map(Ok).or_else(|| self.pull(&mut pulled))?;
        if let Ok(row) = &row {
            let change = pulled.outputs.change(row);
            if !change.is_none() {
                let tick_ps = self.timebase.tick_ns() * 1000;
                let ps = pulled.taken.saturating_mul(tick_ps);
                let mut due = self.due.lock().unwrap_or_else(PoisonError::into_inner);
                due.push_back(DueChange { ps, change });
                if let Some(duty) = change.duty {
                    let mut duties = self.duties.lock().unwrap_or_else(PoisonError::into_inner);
                    duties.push_back((ps, duty));
                }
            }
            pulled.taken = pulled.taken.saturating_add(row.ticks.into());
        }
        Some(row)
    }

    /// Looks at a row, counted from the first that has not been taken.
    fn look(&self, number: usize) -> Option<Result<Row, Failure>> {
        let mut pulled = self.lock();
        while pulled.seen.len() <= number {
            match self.pull(&mut pulled)? {
                Ok(row) => pulled.seen.push_back(row),
                Err(error) => return Some(Err(error)),
            }
        }
        pulled.seen.get(number).cloned().map(Ok)
    }
}

impl fmt::Debug for OnePass<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OnePass").field("clocks", &self.clocks).finish_non_exhaustive()
    }
}

impl Commands for OnePass<'_> {
    fn commands(&self) -> Box<dyn Iterator<Item = Command> + '_> {
        let rows = std::iter::from_fn(|| self.take());
        Box::new(commands(self.kept.until_an_error(rows), self.outputs.clone()))
    }

    fn segments(&self) -> u64 {
        self.segments
    }
}

/// The commands of a pass, whose rows stay for the run.
#[derive(Debug, Clone, Copy)]
pub struct LookedAt<'a>(&'a OnePass<'a>);

impl Commands for LookedAt<'_> {
    fn commands(&self) -> Box<dyn Iterator<Item = Command> + '_> {
        let rows = (0..).map_while(|number| self.0.look(number));
        Box::new(commands(self.0.kept.until_an_error(rows), self.0.outputs.clone()))
    }

    fn segments(&self) -> u64 {
        self.0.segments
    }
}

/// What a host sends for rows.
fn commands<'r>(
    rows: impl Iterator<Item = Row> + 'r,
    mut outputs: RowOutputs,
) -> impl Iterator<Item = Command> + 'r {
    let mut begun = false;
    rows.flat_map(move |row| {
        let count = row.segments.len();
        let segment = |(axis, segment)| Command::Segment { axis, segment };
        let change = Some(outputs.change(&row)).filter(|change| !change.is_none());
        let segments =
            change.map(Command::Outputs).into_iter().chain((0..).zip(row.segments).map(segment));
        // All axes start when each has its first segment.
        let first = !std::mem::replace(&mut begun, true);
        segments.chain(first.then(|| Command::Start { mask: ((1_u16 << count) - 1) as u8 }))
    })
}

//! Rows of lines that come one after the other.
//!
//! ```text
//! lines    l0 l1 l2 l3 . . . . l4 l5      l3 is the last one for a while
//! batch    |---- first ----|   |-- second
//! rest     ^               ^   ^
//! ```
//!
//! The lines of a batch are planned together, in a thread of their own. The plan of a batch ends at
//! rest. A line can end the batch (M0, M2). Otherwise the last line that has come ends it, as soon as
//! no line waits and few planned rows are left to send. So a sender that is late makes the machine
//! rest on its path, and no queue of the board runs dry.

use crate::first_ways::directions;
use carrystep_job::{Item, JobError, Planner};
use carrystep_program::{LineBreak, PlannedLine, Row};
use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Lines that may wait to be planned.
pub const LINES: usize = 1024;

/// Rows that may wait for the board, at least two seconds of motion.
const MOST_ROWS: usize = 512;
/// Rows with which a batch begins while lines still come, at least 0.7 s.
const READY: usize = 192;
/// Rows from which on a batch waits for more lines, at least 0.35 s of motion.
const FEW: usize = 96;
/// Time without a line after which a batch that has not begun ends with the last one.
const QUIET: Duration = Duration::from_millis(20);
/// The same for a batch that has begun and whose rows get few.
const SHORT: Duration = Duration::from_millis(5);
/// Longest time in which a batch gathers lines before it begins.
const GATHERING: Duration = Duration::from_millis(250);
/// Time between two looks at the clock.
const LOOK: Duration = Duration::from_millis(2);

/// What refuses motion: it is given the direction, 1, -1 or 0, in which each letter moves for the
/// first time in a batch, in the order of their first motors, and returns why one must not.
pub type MotionGuard = Box<dyn Fn(&[i8]) -> Result<(), String> + Send>;

/// How a batch has ended.
#[derive(Debug, Clone, PartialEq)]
pub struct BatchEnd {
    /// What the last line of the batch says about it; `None` if no further line had come.
    pub at: Option<LineBreak>,
    /// Where the motion ends: the coordinates of the axes.
    pub place: Vec<f64>,
    /// Why the lines cannot be planned. The rows break off.
    pub error: Option<JobError>,
    /// Why the line that comes next must not be executed. Nothing of the batch has moved.
    pub refused: Option<String>,
}

/// The present batch.
#[derive(Debug)]
struct Batch {
    rows: VecDeque<Row>,
    /// Whether rows are taken.
    has_begun: bool,
    since: Instant,
    end: Option<BatchEnd>,
}

#[derive(Debug)]
struct Shared {
    /// The lines that wait, with what is left of each.
    lines: VecDeque<VecDeque<PlannedLine>>,
    /// When the last one came.
    came: Instant,
    batch: Option<Batch>,
    /// Number of batches so far: the thread of an earlier one ends.
    number: u64,
}

/// Lines that wait, and the batch that is planned of them.
#[derive(Debug, Clone)]
pub struct Growing {
    shared: Arc<(Mutex<Shared>, Condvar)>,
}

impl Default for Growing {
    fn default() -> Self {
        let (lines, came, batch, number) = (VecDeque::new(), Instant::now(), None, 0);
        let shared = Shared { lines, came, batch, number };
        Self { shared: Arc::new((Mutex::new(shared), Condvar::new())) }
    }
}

impl Growing {
    fn lock(&self) -> MutexGuard<'_, Shared> {
        self.shared.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Number of lines that may still be added; none is refused if more are.
    pub fn free(&self) -> usize {
        LINES.saturating_sub(self.lock().lines.len())
    }

    /// Whether lines wait.
    pub fn waits(&self) -> bool {
        !self.lock().lines.is_empty()
    }

    /// Adds what a line does.
    pub fn add(&self, line: Vec<PlannedLine>) {
        if line.is_empty() {
            return;
        }
        let mut shared = self.lock();
        shared.lines.push_back(line.into());
        shared.came = Instant::now();
        self.shared.1.notify_all();
    }

    /// Begins to plan the lines that wait and those that come, from this place on: the coordinates
    /// of the axes. A batch that has not ended is dropped.
    pub fn begin(&self, planner: Planner, place: Vec<f64>) {
        self.begin_guarded(planner, place, None);
    }

    /// The same with a guard. The batch ends before a line that the guard refuses; if nothing moves
    /// before that line, the batch says so.
    pub fn begin_guarded(&self, planner: Planner, place: Vec<f64>, guard: Option<MotionGuard>) {
        let mut shared = self.lock();
        let since = Instant::now();
        shared.batch = Some(Batch { rows: VecDeque::new(), has_begun: false, since, end: None });
        shared.number += 1;
        let (growing, number, moved) = (self.clone(), shared.number, vec![false; place.len()]);
        let work = Work { growing, number, place, at: None, guard, moved };
        std::thread::spawn(move || work.plan(planner));
    }

    /// Whether the batch may be taken: some of its rows are planned, or all.
    pub fn is_ready(&self) -> bool {
        let ready = |batch: &Batch| batch.end.is_some() || batch.rows.len() >= READY;
        self.lock().batch.as_ref().is_some_and(ready)
    }

    /// Whether there is a batch.
    pub fn is_planned(&self) -> bool {
        self.lock().batch.is_some()
    }

    /// The rows of the batch. They block their reader only until a row is planned.
    pub fn rows(&self) -> GrowingRows {
        GrowingRows { growing: self.clone(), number: self.lock().number }
    }

    /// Ends the batch, of which all rows were taken. `None` if it goes on.
    pub fn take_end(&self) -> Option<BatchEnd> {
        let mut shared = self.lock();
        let end = shared.batch.as_mut()?.end.take()?;
        shared.batch = None;
        Some(end)
    }

    /// Drops all lines and the batch.
    pub fn clear(&self) {
        let mut shared = self.lock();
        (shared.batch, shared.number) = (None, shared.number + 1);
        shared.lines.clear();
        self.shared.1.notify_all();
    }
}

/// The rows of a batch.
#[derive(Debug)]
pub struct GrowingRows {
    growing: Growing,
    number: u64,
}

impl Iterator for GrowingRows {
    type Item = Row;

    fn next(&mut self) -> Option<Row> {
        let mut shared = self.growing.lock();
        loop {
            if shared.number != self.number {
                return None;
            }
            let batch = shared.batch.as_mut()?;
            batch.has_begun = true;
            let row = batch.rows.pop_front();
            if row.is_some() || batch.end.is_some() {
                self.growing.shared.1.notify_all();
                return row;
            }
            shared = self.growing.shared.1.wait(shared).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// What the thread of a batch works on.
struct Work {
    growing: Growing,
    number: u64,
    place: Vec<f64>,
    /// Why the batch ends.
    at: Option<LineBreak>,
    guard: Option<MotionGuard>,
    /// The letters that have moved in the batch.
    moved: Vec<bool>,
}

impl Work {
    fn plan(mut self, mut planner: Planner) {
        let (mut ends, mut refused) = (false, None);
        let error = loop {
            match planner.next_row() {
                Ok(Some(row)) => {
                    if !self.give(row) {
                        return;
                    }
                    continue;
                }
                Ok(None) if ends => break None,
                Ok(None) => {}
                Err(error) => break Some(error),
            }
            let Some(mut items) = self.next() else { return };
            let mut is_last = items.is_empty();
            let mut pushed = Ok(());
            while let Some(item) = items.pop_front().filter(|_| pushed.is_ok()) {
                if let Err(why) = self.guarded(&item) {
                    refused = Some(why).filter(|_| !self.moved.contains(&true));
                    is_last = true;
                    items.push_front(item);
                    self.give_back(items);
                    break;
                }
                pushed = self.push(&mut planner, &item);
            }
            if is_last && pushed.is_ok() {
                ends = true;
                pushed = planner.finish();
            }
            if let Err(error) = pushed {
                break Some(error);
            }
        };
        let mut shared = self.growing.lock();
        if shared.number == self.number
            && let Some(batch) = &mut shared.batch
        {
            batch.end = Some(BatchEnd { at: self.at, place: self.place, error, refused });
            self.growing.shared.1.notify_all();
        }
    }

    /// Asks the guard for the letters that the next item moves and that have not moved before.
    fn guarded(&mut self, item: &Item) -> Result<(), String> {
        let (Some(guard), Item::Move(element)) = (&self.guard, item) else { return Ok(()) };
        let directions = directions(&self.place, element);
        let first: Vec<i8> = directions
            .iter()
            .zip(&self.moved)
            .map(|(way, moved)| if *moved { 0 } else { *way })
            .collect();
        guard(&first)?;
        for (moved, way) in self.moved.iter_mut().zip(directions) {
            *moved |= way != 0;
        }
        Ok(())
    }

    /// These items of a line were not planned, and come first again.
    fn give_back(&self, items: VecDeque<Item>) {
        let mut shared = self.growing.lock();
        if shared.number == self.number {
            shared.lines.push_front(items.into_iter().map(PlannedLine::Item).collect());
        }
    }

    fn push(&mut self, planner: &mut Planner, item: &Item) -> Result<(), JobError> {
        planner.push(item)?;
        if let Item::Move(element) = item {
            self.place.clone_from(&element.to);
        }
        Ok(())
    }

    /// Gives a row as soon as there is room; false if the batch was dropped.
    fn give(&self, row: Row) -> bool {
        let mut shared = self.growing.lock();
        loop {
            if shared.number != self.number {
                return false;
            }
            let Some(batch) = &mut shared.batch else { return false };
            if batch.rows.len() < MOST_ROWS {
                batch.rows.push_back(row);
                self.growing.shared.1.notify_all();
                return true;
            }
            shared = self.growing.shared.1.wait(shared).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// The items of the next line; none if the batch ends. `None` if it was dropped.
    fn next(&mut self) -> Option<VecDeque<Item>> {
        let mut shared = self.growing.lock();
        loop {
            if shared.number != self.number {
                return None;
            }
            if let Some(line) = shared.lines.front_mut() {
                let mut items = VecDeque::new();
                while let Some(part) = line.pop_front() {
                    match part {
                        PlannedLine::Item(item) => items.push_back(item),
                        PlannedLine::Break(_) if !items.is_empty() => {
                            line.push_front(part);
                            return Some(items);
                        }
                        PlannedLine::Break(at) => {
                            self.at = Some(at);
                            break;
                        }
                    }
                }
                if line.is_empty() {
                    shared.lines.pop_front();
                }
                if self.at.is_some() || !items.is_empty() {
                    return Some(items);
                }
                continue;
            }
            let quiet = shared.came.elapsed();
            let batch = shared.batch.as_ref()?;
            let late = match batch.has_begun {
                true => quiet >= SHORT && batch.rows.len() < FEW,
                false => {
                    quiet >= QUIET || batch.rows.len() < READY && batch.since.elapsed() >= GATHERING
                }
            };
            if late {
                return Some(VecDeque::new());
            }
            let waited = self.growing.shared.1.wait_timeout(shared, LOOK);
            shared = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

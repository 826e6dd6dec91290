//! Plans moves while they are used, so that a plan of any length takes little memory.
//!
//! ```text
//!  move file -> all moves are planned once: a refusal, or the totals         (Survey)
//!  move file -> planned again, a move at a time, when a reader needs it      (Pass)
//!                 |-> moves: commands of the simulator, segments of the waveform
//!                 |-> legs of each axis: checker, waveform, CSV, plot
//!                 '-> courses of all axes: checker
//! ```
//!
//! The plan of a short file is kept, and is not made again.

use crate::error::PlanError;
use crate::plan::{Plan, PlannedMove};
use crate::planner::Planner;
use crate::totals::Totals;
use carrystep_core::Build;
use carrystep_files::{InputError, Machine, MoveSource, Moves};
use carrystep_profile::{Course, Leg, ListEnd, Reader, Source, Timeline};
use std::borrow::Cow;
use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The greatest number of moves whose plan is kept.
const KEPT: usize = 1 << 12;

/// The moves of a source, planned once from the first to the last.
#[derive(Debug)]
pub struct Survey {
    source: MoveSource,
    build: Build,
    totals: Totals,
    /// All moves, if there are few.
    kept: Option<Arc<[Arc<PlannedMove>]>>,
    /// The first error of a later pass.
    failed: Arc<Mutex<Option<InputError>>>,
}

/// One way through a plan, in lists that grow while they are read. What all readers have passed is
/// freed; a reader that is not dropped keeps everything from its place on.
#[derive(Debug)]
pub struct Pass {
    /// The moves in order.
    pub moves: Reader<Arc<PlannedMove>>,
    /// The float reference of each axis.
    pub timelines: Vec<Timeline>,
    /// The courses of all moves; `None` if no move is along a straight line.
    pub courses: Option<Reader<Course>>,
}

impl Survey {
    /// Plans all moves and keeps their totals. `watch` is told each move and may end the survey.
    ///
    /// # Errors
    /// An [`InputError`] at the first move that cannot be read or planned, or that of `watch`.
    pub fn new<E: From<InputError>>(
        source: MoveSource,
        mut watch: impl FnMut(&PlannedMove) -> Result<(), E>,
    ) -> Result<Self, E> {
        let planning = Planning::new(&source)?;
        let (mut totals, mut kept) = (Totals::default(), Some(Vec::new()));
        let build = planning.planner.build.clone();
        for planned in planning {
            let planned = planned?;
            watch(&planned)?;
            totals.add(&planned);
            kept = kept.filter(|kept| kept.len() < KEPT);
            if let Some(kept) = &mut kept {
                kept.push(Arc::new(planned));
            }
        }
        let (kept, failed) = (kept.map(Arc::from), Arc::default());
        Ok(Self { source, build, totals, kept, failed })
    }

    /// The survey of a source that has been planned.
    pub fn of(source: MoveSource, plan: Plan) -> Self {
        let totals = plan.moves.iter().collect();
        let kept = plan.moves.into_iter().map(Arc::new).collect();
        Self { source, build: plan.build, totals, kept: Some(kept), failed: Arc::default() }
    }

    /// The machine.
    pub fn machine(&self) -> &Machine {
        &self.source.machine
    }

    /// The moves that are planned.
    pub fn source(&self) -> &MoveSource {
        &self.source
    }

    /// The build of the gateware that the plan is for.
    pub fn build(&self) -> &Build {
        &self.build
    }

    /// The sums and greatest values of all moves.
    pub fn totals(&self) -> &Totals {
        &self.totals
    }

    /// Begins a pass. If a move cannot be read again, the lists end there, and [`Self::whole`]
    /// tells the error.
    pub fn begin(&self) -> Pass {
        let timebase = self.build.timebase;
        let legs: Vec<ListEnd<Leg>> = self.totals.axes.iter().map(|_| ListEnd::default()).collect();
        let (moves, courses) = (ListEnd::default(), ListEnd::default());
        let planned: Box<dyn Iterator<Item = Result<Arc<PlannedMove>, InputError>> + Send> =
            match &self.kept {
                Some(kept) => {
                    let kept = kept.clone();
                    Box::new((0..kept.len()).map(move |at| Ok(kept[at].clone())))
                }
                None => match Planning::new(&self.source) {
                    Ok(planning) => Box::new(planning.map(|planned| planned.map(Arc::new))),
                    Err(error) => Box::new(std::iter::once(Err(error))),
                },
            };
        let source = Arc::new(Growing {
            straight: self.totals.straight,
            build: self.build.clone(),
            failed: self.failed.clone(),
            known_to: AtomicU64::new(0),
            lists: Mutex::new(None),
        });
        let reader = source.clone();
        let timeline =
            |end: &ListEnd<Leg>| Timeline::new(timebase.tick_seconds(), end.reader(reader.clone()));
        let pass = Pass {
            moves: moves.reader(source.clone()),
            timelines: legs.iter().map(timeline).collect(),
            courses: self.totals.straight.then(|| courses.reader(source.clone())),
        };
        *locked(&source.lists) = Some(Lists { planned, moves, legs, courses });
        pass
    }

    /// Whether every pass so far could read all moves again.
    ///
    /// # Errors
    /// The [`InputError`] of the first pass that could not.
    pub fn whole(&self) -> Result<(), InputError> {
        locked(&self.failed).take().map_or(Ok(()), Err)
    }
}

/// The moves of a source, each with its plan.
struct Planning {
    source: MoveSource,
    moves: Moves,
    planner: Planner<'static, f64>,
}

impl Planning {
    fn new(source: &MoveSource) -> Result<Self, InputError> {
        let refused = |error: PlanError| InputError::new(error.to_string());
        Ok(Self {
            planner: Planner::new(Cow::Owned(source.machine.clone())).map_err(refused)?,
            moves: source.moves()?,
            source: source.clone(),
        })
    }
}

impl Iterator for Planning {
    type Item = Result<PlannedMove, InputError>;

    fn next(&mut self) -> Option<Self::Item> {
        Some(self.moves.next()?.and_then(|moved| {
            let refused = |error: PlanError| self.source.move_error(&moved, error.to_string());
            self.planner.plan(&moved).map_err(refused)
        }))
    }
}

/// The source of the lists of a pass.
struct Growing {
    straight: bool,
    build: Build,
    failed: Arc<Mutex<Option<InputError>>>,
    known_to: AtomicU64,
    /// `None` when everything has been planned.
    lists: Mutex<Option<Lists>>,
}

struct Lists {
    planned: Box<dyn Iterator<Item = Result<Arc<PlannedMove>, InputError>> + Send>,
    moves: ListEnd<Arc<PlannedMove>>,
    legs: Vec<ListEnd<Leg>>,
    courses: ListEnd<Course>,
}

impl fmt::Debug for Growing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Growing").field("known_to", &self.known_to).finish_non_exhaustive()
    }
}

impl Source for Growing {
    fn grow(&self) {
        let mut here = locked(&self.lists);
        let Some(lists) = &mut *here else { return };
        match lists.planned.next() {
            Some(Ok(planned)) => {
                for (axis, end) in lists.legs.iter_mut().enumerate() {
                    planned.leg(axis).into_iter().for_each(|leg| end.push(leg));
                }
                if self.straight {
                    lists.courses.push(planned.course(&self.build.timebase));
                }
                // The next move begins at the end of this one, or later.
                let known_to = planned.start_tick + planned.ticks;
                lists.moves.push(planned);
                self.known_to.store(known_to, Ordering::Release);
            }
            ended => {
                if let Some(Err(error)) = ended {
                    locked(&self.failed).get_or_insert(error);
                }
                lists.moves.close();
                lists.legs.iter().for_each(ListEnd::close);
                lists.courses.close();
                *here = None;
                self.known_to.store(u64::MAX, Ordering::Release);
            }
        }
    }

    fn known_to(&self) -> u64 {
        self.known_to.load(Ordering::Acquire)
    }
}

/// A thread that panicked while it held the lock has left whole lists behind.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

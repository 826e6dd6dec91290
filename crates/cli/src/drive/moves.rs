//! The moves of a file as a board is driven through them.

use super::itinerary::{Itinerary, Plan};
use super::place::point_at;
use crate::failure::Failure;
use crate::job;
use crate::work::{self, OffsetWish};
use carrystep_core::Segment;
use carrystep_files::MoveSource;
use carrystep_link::supply::Supply;
use carrystep_link::{Command, SegmentSource, Status};
use carrystep_plan::{AxisTotals, PlannedMove, Survey};
use carrystep_profile::Reader;
use carrystep_program::{Letters, Offsets};
use carrystep_runner::Wait;
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::sync::Arc;

/// What sees each planned move.
type See<'a> = dyn FnMut(&PlannedMove) -> Result<(), Failure> + 'a;

/// The moves of a file, which the link can send.
pub struct Moves {
    survey: Survey,
    seconds: f64,
    /// Direction of the first motion of each axis: 1, -1, or 0 if it does not move. On crossed belts it
    /// is that of the axis' letter.
    first: Vec<i8>,
}

impl Moves {
    /// Plans all moves.
    ///
    /// # Errors
    /// A move cannot be made, or the machine's line is too slow to keep the queues full.
    pub fn new(source: MoveSource) -> Result<Self, Failure> {
        Self::planned(source, |source, see| job::survey(source, see))
    }

    /// The same, whatever signals have come before: while a program waits, they concern the
    /// program.
    ///
    /// # Errors
    /// As [`Moves::new`].
    pub fn unwatched(source: MoveSource) -> Result<Self, Failure> {
        Self::planned(source, |source, see| Survey::new(source, see))
    }

    fn planned(
        source: MoveSource,
        survey: impl FnOnce(MoveSource, &mut See<'_>) -> Result<Survey, Failure>,
    ) -> Result<Self, Failure> {
        let (machine, path) = (&source.machine, source.path.display().to_string());
        let axes = machine.axes.len() as u8;
        let mut supply = Some(Supply::new(axes, machine.timebase, machine.queue, machine.baud));
        // A move that cannot be made is told before a line that is too slow.
        let mut starved = None;
        let belts = machine.clone();
        let mut letters = vec![0; machine.axes.len()];
        let survey = survey(source, &mut |planned: &PlannedMove| {
            for command in planned.commands().iter().filter_map(Command::of) {
                if let Some(Err(error)) = supply.as_mut().map(|supply| supply.add(&command)) {
                    starved = Some(error);
                    supply = None;
                }
            }
            let steps: Vec<f64> = planned.axes.iter().map(|axis| axis.steps as f64).collect();
            for (axis, way) in letters.iter_mut().enumerate().filter(|(_, way)| **way == 0) {
                let steps = belts.letter_steps(axis, &steps);
                *way = if steps == 0.0 { 0 } else { steps.signum() as i8 };
            }
            Ok(())
        })?;
        let starved = starved.or_else(|| supply.and_then(|supply| supply.finish().err()));
        if let Some(error) = starved {
            return Err(Failure::input(format!("{path}: {error}")));
        }
        let first = |totals: &AxisTotals| {
            totals.travel.first.as_ref().map_or(0, |leg| leg.forward().signum() as i8)
        };
        let first = survey.totals().axes.iter().map(first).enumerate();
        let is_crossed = |axis: usize| survey.machine().is_crossed(axis);
        let first =
            first.map(|(axis, own)| if is_crossed(axis) { letters[axis] } else { own }).collect();
        let seconds = survey.totals().ticks as f64 * survey.build().timebase.tick_seconds();
        Ok(Self { survey, seconds, first })
    }

    /// What the board is to do.
    pub fn plan(&self) -> Plan<'_> {
        let totals = self.survey.totals();
        Plan {
            machine: self.survey.machine(),
            seconds: self.seconds,
            first: &self.first,
            steps: totals.axes.iter().map(|axis| axis.travel.position).collect(),
            program: None,
        }
    }

    /// The way there, which is planned again while it is sent.
    pub fn itinerary(&self) -> MovesOnce<'_> {
        let moves = RefCell::new(PlannedMoves::new(&self.survey));
        MovesOnce { survey: &self.survey, begun: Cell::new(false), moves, sets: None }
    }

    /// The same, and where it ends an offset is set.
    pub fn itinerary_and(&self, sets: Option<OffsetAtEnd>) -> MovesOnce<'_> {
        MovesOnce { sets, ..self.itinerary() }
    }
}

/// A work offset that is set where moves end.
pub struct OffsetAtEnd {
    /// What is wanted.
    pub wish: OffsetWish,
    /// The offsets before.
    pub before: Offsets,
    /// The letters of the machine's axes.
    pub letters: Letters,
    /// Of each axis, the machine place of its register's zero in steps.
    pub zero: Vec<i64>,
}

impl OffsetAtEnd {
    /// The offsets if the moves end at these positions.
    ///
    /// # Errors
    /// An offset beyond what a program may have.
    pub fn at(&self, positions: &[i32]) -> Result<Offsets, Failure> {
        let positions: Vec<f64> = positions.iter().map(|&at| at.into()).collect();
        work::set(&self.before, point_at(&self.letters, &self.zero, &positions), &self.wish)
    }
}

/// All moves as one stretch.
pub struct MovesOnce<'a> {
    survey: &'a Survey,
    begun: Cell<bool>,
    moves: RefCell<PlannedMoves>,
    sets: Option<OffsetAtEnd>,
}

impl Itinerary for MovesOnce<'_> {
    fn begin(&self) -> Option<Vec<Wait>> {
        (!self.begun.replace(true)).then(Vec::new)
    }

    fn source(&self) -> Box<dyn SegmentSource + '_> {
        Box::new(&self.moves)
    }

    fn offsets(&self, end: &Status) -> Option<Offsets> {
        // The same offset was computed for the planned end before anything has moved.
        self.sets.as_ref().and_then(|sets| sets.at(&end.positions).ok())
    }

    fn keeps(&self) -> bool {
        self.sets.is_some()
    }

    fn whole(&self) -> Result<(), Failure> {
        Ok(self.survey.whole()?)
    }
}

/// The segments of a plan, which is made while they are sent.
struct PlannedMoves {
    moves: Reader<Arc<PlannedMove>>,
    /// For each axis, the segments of the moves that were read and that have not been sent.
    segments: Vec<VecDeque<Segment>>,
    /// The starts of these moves.
    starts: VecDeque<u8>,
}

impl PlannedMoves {
    fn new(survey: &Survey) -> Self {
        let segments = survey.machine().axes.iter().map(|_| VecDeque::new()).collect();
        Self { moves: survey.begin().moves, segments, starts: VecDeque::new() }
    }

    /// Reads the next move; `None` if there is none.
    fn read(&mut self) -> Option<()> {
        for command in self.moves.next()?.commands().iter().filter_map(Command::of) {
            match command {
                Command::Segment { axis, segment } => {
                    self.segments.get_mut(usize::from(axis))?.push_back(segment);
                }
                Command::Start { mask } => self.starts.push_back(mask),
                // Move files change no outputs.
                Command::Outputs(_) => {}
            }
        }
        Some(())
    }
}

impl SegmentSource for PlannedMoves {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        while self.segments.get(usize::from(axis))?.is_empty() {
            self.read()?;
        }
        self.segments[usize::from(axis)].pop_front()
    }

    fn start(&mut self) -> Option<u8> {
        while self.starts.is_empty() {
            self.read()?;
        }
        self.starts.pop_front()
    }
}

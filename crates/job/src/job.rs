//! A job of at most N letters: checks items, cuts them into pieces, and passes the pieces
//! through the stages to rows.

use crate::confined::Confined;
use crate::element::{Arc, Element, Item};
use crate::emitted::{Emitted, Passed};
use crate::error::JobError;
use crate::limits::{Motors, of_machine};
use crate::marks::{Mark, Marks};
use crate::piece::Piece;
use crate::refuse::refuse;
use crate::rhythm::{LONGEST, Rhythm, shortest};
use crate::row::Row;
use crate::run::Runs;
use crate::targets::{Targets, with_still_letters};
use crate::vector::Point;
use crate::weave::{Broken, Span, Weave};
use carrystep_core::Segment;
use carrystep_files::Machine;
use carrystep_plan::exact::{nearest, travel};
use std::collections::VecDeque;
use std::fmt::Debug;

/// Shortest element that moves, mm or degrees.
const NO_MOVE: f64 = 1e-9;
/// Longest piece, seconds at its feed: the knots of one piece are made at once.
const PIECE_SECONDS: f64 = 0.5;

/// A job with any number of axes.
pub(crate) trait Jobs: Debug + Send {
    fn push(&mut self, item: &Item) -> Result<(), JobError>;
    fn check(&self, from: &[f64], element: &Element) -> Result<(), JobError>;
    fn finish(&mut self) -> Result<(), JobError>;
    fn next_row(&mut self) -> Result<Option<Row>, JobError>;
}

/// What is still to be planned, in order.
#[derive(Debug)]
enum Work<const N: usize> {
    /// A piece of which `done` of `count` parts have been planned.
    Piece {
        piece: Piece<N>,
        arc: Option<Arc>,
        done: u64,
        count: u64,
    },
    Mark(Mark),
    /// The run ends.
    Land,
    /// A rest of so many ticks.
    Rest {
        ticks: u64,
        line: u64,
    },
    End,
}

#[derive(Debug)]
pub(crate) struct Job<const N: usize> {
    motors: Motors<N>,
    targets: Targets<N>,
    linear: usize,
    rhythm: Rhythm,
    tick_seconds: f64,
    runs: Runs<N>,
    weave: Weave<N>,
    /// What the path has passed at the end of the span that the weave holds.
    held: Option<Passed>,
    /// The last element, which is held back until it is known whether the path rests behind it.
    pending: Option<Element>,
    /// Marks behind it.
    pending_marks: Vec<Mark>,
    confined: Confined<N>,
    /// Where the stored path ends, and where the program says that it ends.
    at: Point<N>,
    programmed: Point<N>,
    work: VecDeque<Work<N>>,
    /// Marks that no row has.
    marks: Marks<N>,
    /// P where the last row ends, units of 2^-64 step.
    woven: [i128; N],
    /// The piece that the path had reached at the end of the last row.
    reached: u64,
    line: u64,
    block: u64,
    rows: VecDeque<Row>,
    ended: bool,
}

impl<const N: usize> Job<N> {
    /// A job of a machine with one axis for each letter, which stands for so many motors in all.
    /// Letters that the machine does not have stand still: the code for one number of letters is
    /// large, and two numbers of letters are enough for all machines.
    pub fn new(
        (machine, motors): (&Machine, usize),
        linear: usize,
        start: &[f64],
    ) -> Result<Self, JobError> {
        let letters = machine.axes.len();
        let machine = &with_still_letters(machine, N);
        let targets = Targets::new(machine, letters)?;
        let tick_seconds = machine.timebase.tick_seconds();
        let (mut limits, exact) = of_machine(machine)?;
        let baud = if machine.spi { u32::MAX } else { machine.baud };
        let shortest = shortest(motors, baud);
        let rhythm = Rhythm::new(&limits, tick_seconds, shortest);
        // From steps to units of the letters.
        for (motor, limit) in limits.iter_mut().enumerate() {
            let steps = targets.steps_per_unit[motor];
            limit.speed /= steps;
            limit.acceleration /= steps;
            limit.jerk /= steps;
        }
        let motors = Motors { limits, matrix: targets.matrix() };
        let start = targets.coordinates(start, 0)?;
        // With no rotary letter, those that stand still are linear, too: no rotary tolerance counts.
        let linear = if linear < letters { linear } else { N };
        let steps = targets.steps(&start, 0)?;
        let at = targets.letters(&steps);
        let mut quiet = [0; N];
        for (quiet, axis) in quiet.iter_mut().zip(&machine.axes) {
            *quiet = crate::turn::quiet(&axis.pins, &machine.timebase);
        }
        let units = steps.map(|steps| i128::from(steps) << 64);
        Ok(Self {
            runs: Runs::new(&motors, &rhythm, linear, at),
            weave: Weave::new(rhythm.ticks, exact, quiet, units),
            held: None,
            motors,
            targets,
            linear,
            rhythm,
            tick_seconds,
            pending: None,
            confined: Confined::new(linear, start),
            pending_marks: Vec::new(),
            at,
            programmed: start,
            work: VecDeque::new(),
            marks: Marks::default(),
            woven: units,
            reached: 0,
            line: 0,
            block: 0,
            rows: VecDeque::new(),
            ended: false,
        })
    }
}

impl<const N: usize> Jobs for Job<N> {
    fn push(&mut self, item: &Item) -> Result<(), JobError> {
        match item {
            Item::Move(element) => {
                let from = match &self.pending {
                    Some(before) => self.targets.coordinates(&before.to, before.line)?,
                    None => self.programmed,
                };
                refuse(element, &from, &self.targets, self.linear)?;
                let to = self.targets.coordinates(&element.to, element.line)?;
                if self.confined.rests_before(element, &from, &to) {
                    self.land()?;
                } else {
                    self.flush(None)?;
                }
                self.pending = Some(element.clone());
            }
            Item::Rest { dwell, line } => {
                if !dwell.is_finite() || *dwell < 0.0 {
                    let help = "it must be 0 or more";
                    return Err(JobError::Number {
                        line: *line,
                        what: "a dwell",
                        value: *dwell,
                        help,
                    });
                }
                self.land()?;
                let ticks = (dwell / self.tick_seconds).round() as u64;
                // A row is at least a knot time long.
                let ticks = if ticks == 0 { 0 } else { ticks.max(self.rhythm.ticks.into()) };
                self.work.push_back(Work::Rest { ticks, line: *line });
            }
            Item::Mark(number) | Item::NearMark(number) => {
                let may_be_early = matches!(item, Item::NearMark(_));
                let mark = Mark { number: *number, may_be_early };
                if self.pending.is_some() {
                    self.pending_marks.push(mark);
                } else {
                    self.work.push_back(Work::Mark(mark));
                }
            }
        }
        Ok(())
    }

    fn check(&self, from: &[f64], element: &Element) -> Result<(), JobError> {
        refuse(element, &self.targets.coordinates(from, element.line)?, &self.targets, self.linear)
    }

    fn finish(&mut self) -> Result<(), JobError> {
        self.land()?;
        self.work.push_back(Work::End);
        Ok(())
    }

    fn next_row(&mut self) -> Result<Option<Row>, JobError> {
        // The last row is held back, because it may be the last one of the job.
        while self.rows.len() < 2 && !self.ended {
            if !self.step()? {
                return Ok(None);
            }
        }
        let mut row = self.rows.pop_front();
        if self.ended
            && self.rows.is_empty()
            && let Some(row) = &mut row
        {
            row.segments.iter_mut().for_each(|segment| segment.last = true);
        }
        Ok(row)
    }
}

impl<const N: usize> Job<N> {
    /// Stores the element that was held back; with `end`, it ends there instead.
    fn flush(&mut self, end: Option<Point<N>>) -> Result<(), JobError> {
        let Some(element) = self.pending.take() else { return Ok(()) };
        let line = element.line;
        let programmed = self.targets.coordinates(&element.to, line)?;
        let from = std::mem::replace(&mut self.programmed, programmed);
        let to = match end {
            Some(end) => end,
            None => programmed,
        };
        let feed = element.feed.unwrap_or(f64::INFINITY);
        let mut piece =
            Piece::new(self.at, to, element.arc, feed, element.tolerance, line, self.linear);
        let moves = |letters: std::ops::Range<usize>| from[letters.clone()] != programmed[letters];
        piece.block = element.block;
        piece.turns_only = element.arc.is_none() && !moves(0..self.linear) && moves(self.linear..N);
        if piece.length > NO_MOVE {
            let direction = piece.tangent(0.0);
            let speed = feed.min(self.motors.greatest(&direction, |limit| limit.speed));
            let count = (piece.length / (speed * PIECE_SECONDS)).ceil().max(1.0) as u64;
            self.work.push_back(Work::Piece { piece, arc: element.arc, done: 0, count });
            self.at = to;
        }
        self.work.extend(self.pending_marks.drain(..).map(Work::Mark));
        Ok(())
    }

    /// The path rests where it ends, on whole steps.
    fn land(&mut self) -> Result<(), JobError> {
        let (to, line) = match &self.pending {
            Some(element) => (self.targets.coordinates(&element.to, element.line)?, element.line),
            None => (self.at, self.line),
        };
        let end = self.targets.letters(&self.targets.steps(&to, line)?);
        self.confined = Confined::new(self.linear, to);
        self.flush(Some(end))?;
        self.work.push_back(Work::Land);
        Ok(())
    }

    /// Does the next part of the work; `false` if there is none.
    fn step(&mut self) -> Result<bool, JobError> {
        let mut emitted = Vec::new();
        match self.work.front_mut() {
            None => return Ok(false),
            Some(Work::Piece { piece, arc, done, count }) => {
                let part = piece.part(*arc, *done, *count, self.linear);
                *done += 1;
                if done == count {
                    self.work.pop_front();
                }
                self.runs.push(part, &mut emitted);
                self.weave(&emitted, None)?;
            }
            Some(&mut Work::Mark(mark)) => {
                self.work.pop_front();
                let (piece, end) = (self.runs.next_piece(), *self.runs.end());
                let at = self.units(&end, self.line)?;
                self.marks.push(mark, piece, at);
            }
            Some(Work::Land) => {
                self.work.pop_front();
                if self.runs.moving() {
                    let end = *self.runs.end();
                    self.runs.rest(&mut emitted);
                    let target = self.targets.steps(&end, self.line)?;
                    self.weave(&emitted, Some(target.map(|steps| i128::from(steps) << 64)))?;
                }
                // What the path has passed includes marks at its end.
                self.reached = self.runs.next_piece();
            }
            Some(&mut Work::Rest { ticks, line }) => {
                let longest = ((LONGEST / self.tick_seconds) as u64).max(self.rhythm.ticks.into());
                // Two rows share what is more than one row and less than two.
                let now = match ticks {
                    t if t <= longest => t,
                    t if t < 2 * longest => t / 2,
                    _ => longest,
                };
                if ticks > now {
                    self.work[0] = Work::Rest { ticks: ticks - now, line };
                } else {
                    self.work.pop_front();
                }
                self.line = line;
                self.rest(now as u32);
            }
            Some(Work::End) => {
                self.work.pop_front();
                if !self.marks.is_empty() {
                    self.rest(self.rhythm.ticks);
                }
                self.ended = true;
            }
        }
        Ok(true)
    }

    /// Adds a row at rest.
    fn rest(&mut self, ticks: u32) {
        if ticks > 0 {
            let segments = [Segment { ticks, v: 0, a: 0, j: 0, last: false }; N];
            let (piece, line, block) = (self.reached, self.line, self.block);
            let passed = Passed { piece, line, block, feed: f64::INFINITY, off: 0.0, corner: 0.0 };
            self.row(&Span { ticks, segments }, &passed, true);
        }
    }

    /// Makes rows of control points; with `target`, the last ones land there.
    fn weave(&mut self, emitted: &[Emitted<N>], target: Option<[i128; N]>) -> Result<(), JobError> {
        // The last points of a run are at rest at its target, exactly.
        let resting = if target.is_some() { crate::smooth::RESTING } else { 0 };
        let count = emitted.len().saturating_sub(resting);
        for knot in &emitted[..count] {
            let point = self.units(&knot.point, knot.passed.line)?;
            if self.weave.leaves(&point) {
                self.add(point, knot.passed)?;
            }
        }
        if let (Some(target), Some(last)) = (target, emitted.last()) {
            for _ in 1..resting {
                self.add(target, last.passed)?;
            }
            let spans = self.weave.land(target).map_err(|broken| self.broken(broken))?;
            let count = spans.len();
            for (number, span) in spans.iter().enumerate() {
                let passed = self.held.take().unwrap_or(last.passed);
                self.row(span, &passed, number + 1 == count);
            }
        }
        Ok(())
    }

    /// Adds a control point, and the row of the span before the one that it completes.
    fn add(&mut self, point: [i128; N], passed: Passed) -> Result<(), JobError> {
        let span = self.weave.push(point).map_err(|broken| self.broken(broken))?;
        let before = self.held.replace(passed);
        if let (Some(span), Some(before)) = (span, before) {
            self.row(&span, &before, false);
        }
        Ok(())
    }

    /// Adds a row, and what the path has passed at its end, where the motion may rest.
    fn row(&mut self, span: &Span<N>, passed: &Passed, rests: bool) {
        let begin = self.woven;
        for (at, segment) in self.woven.iter_mut().zip(&span.segments) {
            *at += travel(segment, span.ticks.into());
        }
        let marks = self.marks.take([self.reached, passed.piece], [&begin, &self.woven]);
        self.reached = self.reached.max(passed.piece);
        (self.line, self.block) = (passed.line, passed.block);
        let &Passed { line, block, feed, off, corner, .. } = passed;
        let (ticks, segments) = (span.ticks, span.segments.to_vec());
        self.rows.push_back(Row { ticks, segments, line, block, feed, off, corner, marks, rests });
    }

    /// The motors at a control point, in units of 2^-64 step.
    fn units(&self, point: &Point<N>, line: u64) -> Result<[i128; N], JobError> {
        let motors = self.motors.of(point);
        let mut units = [0; N];
        for (axis, unit) in units.iter_mut().enumerate() {
            let steps = nearest(motors[axis] * self.targets.steps_per_unit[axis]);
            *unit = steps.ok_or(JobError::Broken { line, axis, rule: crate::Rule::Range })?;
        }
        Ok(units)
    }

    fn broken(&self, broken: Broken) -> JobError {
        JobError::Broken { line: self.line, axis: broken.axis, rule: broken.rule }
    }
}

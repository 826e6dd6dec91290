//! A job for a fixed number of axes: checks items, cuts them into pieces, and passes the pieces
//! through the stages to rows.

use crate::element::{Arc, Element, Item};
use crate::error::JobError;
use crate::kinematics::Kinematics;
use crate::limits::{Limit, Motors};
use crate::piece::Piece;
use crate::rhythm::{Rhythm, SHORTEST};
use crate::row::Row;
use crate::run::Runs;
use crate::settle::Emitted;
use crate::targets::Targets;
use crate::vector::Point;
use crate::weave::{Broken, Span, Weave};
use bigdecimal::ToPrimitive;
use carrystep_core::Segment;
use carrystep_files::Machine;
use carrystep_plan::exact::{ExactLimits, nearest};
use std::collections::VecDeque;
use std::fmt::Debug;

/// Shortest element that moves, mm or degrees.
const NO_MOVE: f64 = 1e-9;
/// Longest piece, seconds at its feed: the knots of one piece are made at once.
const PIECE_SECONDS: f64 = 0.5;
/// Longest row of a rest, seconds.
const LONGEST_REST: f64 = 0.016;

/// A job with any number of axes.
pub(crate) trait Jobs: Debug {
    fn push(&mut self, item: &Item) -> Result<(), JobError>;
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
    Mark(u64),
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
    /// The last element, which is held back until it is known whether the path rests behind it.
    pending: Option<Element>,
    /// Marks behind it.
    pending_marks: Vec<u64>,
    /// Where the stored path ends, and where the program says that it ends.
    at: Point<N>,
    programmed: Point<N>,
    work: VecDeque<Work<N>>,
    /// Marks, each with the piece before which it is.
    marks: VecDeque<(u64, u64)>,
    /// The piece that the path had reached at the end of the last row.
    reached: u64,
    line: u64,
    rows: VecDeque<Row>,
    ended: bool,
}

impl<const N: usize> Job<N> {
    pub fn new(
        machine: &Machine,
        kinematics: &dyn Kinematics,
        linear: usize,
        start: &[f64],
    ) -> Result<Self, JobError> {
        let targets = Targets::new(machine, kinematics)?;
        let tick_seconds = machine.timebase.tick_seconds();
        let mut limits = [Limit { speed: 0.0, acceleration: 0.0, jerk: 0.0 }; N];
        let mut exact = Vec::with_capacity(N);
        for (limit, axis) in limits.iter_mut().zip(&machine.axes) {
            let float = |value: &carrystep_files::BigDecimal| {
                value.to_f64().filter(|x| x.is_finite() && *x > 0.0)
            };
            let [speed, acceleration] = [&axis.speed_limit, &axis.accel_limit].map(float);
            let (Some(speed), Some(acceleration)) = (speed, acceleration) else {
                return Err(JobError::Axes(machine.axes.len()));
            };
            let jerk = axis.jerk_limit.as_ref().and_then(float).unwrap_or(acceleration / SHORTEST);
            *limit = Limit { speed, acceleration, jerk };
            exact.extend(ExactLimits::new::<f64>(axis, &machine.timebase));
        }
        let exact: [ExactLimits; N] =
            exact.try_into().map_err(|_| JobError::Axes(machine.axes.len()))?;
        let rhythm = Rhythm::new(&limits, tick_seconds);
        let exact = exact.map(|limits| {
            let jerk = limits.jerk.unwrap_or_else(|| default_jerk(&limits, tick_seconds));
            ExactLimits { jerk: Some(jerk), ..limits }
        });
        // From steps to units of the letters.
        for (motor, limit) in limits.iter_mut().enumerate() {
            let steps = targets.steps_per_unit[motor];
            limit.speed /= steps;
            limit.acceleration /= steps;
            limit.jerk /= steps;
        }
        let motors = Motors { limits, matrix: targets.matrix() };
        let start = coordinates(start, 0)?;
        let linear = linear.min(N);
        let steps = targets.steps(&start, 0)?;
        let at = targets.letters(&steps);
        let units = steps.map(|steps| i128::from(steps) << 64);
        Ok(Self {
            runs: Runs::new(&motors, &rhythm, linear, at),
            weave: Weave::new(rhythm.ticks, exact, units),
            motors,
            targets,
            linear,
            rhythm,
            tick_seconds,
            pending: None,
            pending_marks: Vec::new(),
            at,
            programmed: start,
            work: VecDeque::new(),
            marks: VecDeque::new(),
            reached: 0,
            line: 0,
            rows: VecDeque::new(),
            ended: false,
        })
    }
}

/// J = A / 4 ms in 2^-64 step per tick^3, rounded down; the ticks of 4 ms are rounded up.
fn default_jerk(limits: &ExactLimits, tick_seconds: f64) -> i128 {
    let ticks = (SHORTEST / tick_seconds * (1.0 - 1e-12)).ceil();
    limits.acceleration / i128::from(ticks as u64).max(1)
}

fn coordinates<const N: usize>(values: &[f64], line: u64) -> Result<Point<N>, JobError> {
    let point: Point<N> = values.try_into().map_err(|_| JobError::Coordinates {
        line,
        found: values.len(),
        axes: N,
    })?;
    match point.iter().find(|x| !x.is_finite()) {
        Some(&value) => {
            Err(JobError::Number { line, what: "a coordinate", value, help: "it must be finite" })
        }
        None => Ok(point),
    }
}

/// Refuses what is not a positive finite number.
fn positive(value: f64, line: u64, what: &'static str, help: &'static str) -> Result<(), JobError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(JobError::Number { line, what, value, help })
    }
}

impl<const N: usize> Jobs for Job<N> {
    fn push(&mut self, item: &Item) -> Result<(), JobError> {
        match item {
            Item::Move(element) => {
                self.refuse(element)?;
                self.flush(None)?;
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
            Item::Mark(mark) => {
                if self.pending.is_some() {
                    self.pending_marks.push(*mark);
                } else {
                    self.work.push_back(Work::Mark(*mark));
                }
            }
        }
        Ok(())
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
    /// Refuses an element that cannot be planned.
    fn refuse(&self, element: &Element) -> Result<(), JobError> {
        let line = element.line;
        let to: Point<N> = coordinates(&element.to, line)?;
        self.targets.check(&to, line)?;
        if let Some(feed) = element.feed {
            positive(feed, line, "the feed", "give a feed above 0")?;
        }
        let help = "give a tolerance above 0, or let the path rest at each corner";
        positive(element.tolerance.linear, line, "the tolerance", help)?;
        positive(element.tolerance.rotary, line, "the rotary tolerance", help)?;
        let Some(arc) = &element.arc else { return Ok(()) };
        let [i, j] = arc.plane;
        let from: Point<N> = match &self.pending {
            Some(before) => coordinates(&before.to, line)?,
            None => self.programmed,
        };
        if i == j || i >= self.linear || j >= self.linear {
            return Err(JobError::Arc { line });
        }
        let [start, end] = [&from, &to].map(|p| (p[i] - arc.centre[0]).hypot(p[j] - arc.centre[1]));
        if !arc.angle.is_finite() || arc.angle == 0.0 || !start.is_finite() || start.min(end) <= 0.0
        {
            return Err(JobError::Arc { line });
        }
        let differ = (start - end).abs();
        if differ > 0.5 || (differ > 0.005 && differ > 0.001 * start.max(end)) {
            return Err(JobError::Radii { line, start, end });
        }
        // The extremes of the letters and of sums and differences of two of them.
        let eighth = std::f64::consts::FRAC_PI_4;
        let first = (from[j] - arc.centre[1]).atan2(from[i] - arc.centre[0]);
        let (low, high) = (first.min(first + arc.angle), first.max(first + arc.angle));
        for turn in 0..8 {
            let angle = f64::from(turn) * eighth;
            let whole = ((low - angle) / std::f64::consts::TAU).ceil();
            if angle + whole * std::f64::consts::TAU <= high {
                let mut point = to;
                point[i] = arc.centre[0] + start * angle.cos();
                point[j] = arc.centre[1] + start * angle.sin();
                self.targets.check(&point, line)?;
            }
        }
        Ok(())
    }

    /// Stores the element that was held back; with `end`, it ends there instead.
    fn flush(&mut self, end: Option<Point<N>>) -> Result<(), JobError> {
        let Some(element) = self.pending.take() else { return Ok(()) };
        self.programmed = coordinates(&element.to, element.line)?;
        let line = element.line;
        let to = match end {
            Some(end) => end,
            None => coordinates(&element.to, line)?,
        };
        let feed = element.feed.unwrap_or(f64::INFINITY);
        let piece =
            Piece::new(self.at, to, element.arc, feed, element.tolerance, line, self.linear);
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
            Some(element) => (coordinates(&element.to, element.line)?, element.line),
            None => (self.at, self.line),
        };
        let end = self.targets.letters(&self.targets.steps(&to, line)?);
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
                self.marks.push_back((self.runs.next_piece(), mark));
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
                let longest =
                    ((LONGEST_REST / self.tick_seconds) as u64).max(self.rhythm.ticks.into());
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
            self.row(&Span { ticks, segments }, self.reached);
        }
    }

    /// Makes rows of control points; with `target`, the last ones land there.
    fn weave(&mut self, emitted: &[Emitted<N>], target: Option<[i128; N]>) -> Result<(), JobError> {
        // The last points of a run are at rest at its target, exactly.
        let resting = if target.is_some() { crate::smooth::RESTING } else { 0 };
        let count = emitted.len().saturating_sub(resting);
        for knot in &emitted[..count] {
            let point = self.units(&knot.point, knot.place.piece)?;
            if self.weave.leaves(&point) {
                let span = self.weave.push(point).map_err(|broken| self.broken(broken))?;
                self.spans(span, knot.place.piece);
            }
        }
        if let (Some(target), Some(last)) = (target, emitted.last()) {
            for _ in 1..resting {
                let span = self.weave.push(target).map_err(|broken| self.broken(broken))?;
                self.spans(span, last.place.piece);
            }
            let spans = self.weave.land(target).map_err(|broken| self.broken(broken))?;
            self.spans(spans, last.place.piece);
        }
        Ok(())
    }

    fn spans(&mut self, spans: impl IntoIterator<Item = Span<N>>, piece: u64) {
        for span in spans {
            self.line = self.runs.line(piece);
            self.row(&span, piece);
        }
    }

    /// Adds a row at whose end the path has reached this piece.
    fn row(&mut self, span: &Span<N>, piece: u64) {
        let mut marks = Vec::new();
        while let Some(&(before, mark)) = self.marks.front() {
            if before > self.reached {
                break;
            }
            marks.push(mark);
            self.marks.pop_front();
        }
        self.reached = self.reached.max(piece);
        let segments = span.segments.to_vec();
        self.rows.push_back(Row { ticks: span.ticks, segments, line: self.line, marks });
    }

    /// The motors at a control point, in units of 2^-64 step.
    fn units(&self, point: &Point<N>, piece: u64) -> Result<[i128; N], JobError> {
        let motors = self.motors.of(point);
        let mut units = [0; N];
        for (axis, unit) in units.iter_mut().enumerate() {
            *unit = nearest(motors[axis] * self.targets.steps_per_unit[axis]).ok_or(
                JobError::Broken { line: self.runs.line(piece), axis, rule: crate::Rule::Range },
            )?;
        }
        Ok(units)
    }

    fn broken(&self, broken: Broken) -> JobError {
        JobError::Broken { line: self.line, axis: broken.axis, rule: broken.rule }
    }
}

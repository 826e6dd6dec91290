//! From a move file to a plan: time, profiles, shares, segments, rest, and the exact check.

use crate::check::{Duty, check};
use crate::demand::{Clock, demand};
use crate::direction::{Pins, Strokes, borrows, turning_rest};
use crate::edges;
use crate::error::{Broken, PlanError};
use crate::limits::ExactLimits;
use crate::peaks::Peaks;
use crate::plan::{Plan, PlannedAxis, PlannedMove};
use crate::run::Writer;
use crate::share::share;
use carrystep_profile::{Profile, Real, SharedProfile, Widened};
use carrystep_spec::{Axis, Build, MoveFile, Segment, fixed::ONE_STEP};
use std::sync::Arc;

/// Plans all moves of a file, in floats of type `F`.
///
/// # Errors
/// [`PlanError`] names the move, the axis, the limit and what would do.
pub fn plan<F: Real>(file: &MoveFile) -> Result<Plan, PlanError> {
    let mut planner = Planner::new::<F>(file)?;
    let moves = (0..file.moves.len()).map(|index| planner.plan_move::<F>(index)).collect::<Result<_, _>>()?;
    Ok(Plan { build: planner.build, moves })
}

struct Planner<'a> {
    file: &'a MoveFile,
    build: Build,
    limits: Vec<ExactLimits>,
    pins: Vec<Pins>,
    /// Ticks planned so far.
    ticks: u64,
}

/// One axis of a move, before it is known how long all must rest.
struct Draft<F: Real> {
    steps: i64,
    profile: SharedProfile<F>,
    segments: Vec<Segment>,
    strokes: Option<Strokes>,
    rest: u64,
}

impl<'a> Planner<'a> {
    fn new<F: Real>(file: &'a MoveFile) -> Result<Self, PlanError> {
        let timebase = file.machine.timebase;
        let exact = |axis: &Axis| ExactLimits::new::<F>(axis, &timebase).ok_or_else(|| broken(0, axis, Broken::Range));
        Ok(Self {
            file,
            build: file.machine.build(),
            limits: file.machine.axes.iter().map(exact).collect::<Result<_, _>>()?,
            pins: vec![Pins::new(&timebase); file.machine.axes.len()],
            ticks: 0,
        })
    }

    fn plan_move<F: Real>(&mut self, index: usize) -> Result<PlannedMove, PlanError> {
        let (clock, profiles) = demand::<F>(self.file, index)?;
        let axes = &self.file.machine.axes;
        let drafts = profiles
            .into_iter()
            .enumerate()
            .map(|(axis, profile)| self.draft(index, axis, profile, &clock).map_err(|b| broken(index, &axes[axis], b)));
        let drafts = drafts.collect::<Result<Vec<_>, _>>()?;
        let rest = drafts.iter().map(|draft| draft.rest).max().unwrap_or(0);
        let planned = drafts
            .into_iter()
            .enumerate()
            .map(|(axis, draft)| self.finish(axis, draft, rest, &clock).map_err(|b| broken(index, &axes[axis], b)));
        let planned = planned.collect::<Result<Vec<_>, _>>()?;
        let start_tick = self.ticks + rest;
        self.ticks = start_tick + clock.ticks;
        let seconds = clock.seconds.to_f64().unwrap_or(f64::NAN);
        Ok(PlannedMove { start_tick, rest_ticks: rest, ticks: clock.ticks, seconds, axes: planned })
    }

    fn draft<F: Real>(
        &self,
        index: usize,
        axis: usize,
        profile: SharedProfile<F>,
        clock: &Clock<F>,
    ) -> Result<Draft<F>, Broken> {
        let steps = self.file.moves[index].steps[axis];
        if steps == 0 {
            return Ok(Draft { steps, profile, segments: still(clock.ticks), strokes: None, rest: 0 });
        }
        let segments = self.motion(axis, steps, &*profile, clock, 0)?;
        let (timebase, phase) = (&self.build.timebase, self.build.phase);
        let backward = steps < 0;
        let edge = |k| edges::edge(&segments, phase.start_value(), backward, k, timebase).ok_or(Broken::Landing);
        let strokes = Strokes {
            backward,
            motion: i128::from(edges::first_motion(&segments)) * i128::from(timebase.clocks_per_tick()),
            first_edge: edge(1)?,
            last_edge: edge(steps.unsigned_abs())?,
        };
        let rest = self.pins[axis].rest(self.now(), &strokes, &self.build.pins[axis], (timebase, phase));
        Ok(Draft { steps, profile, segments, strokes: Some(strokes), rest })
    }

    /// The segments of the motion alone; `borrowed` units have been travelled before it.
    fn motion<F: Real>(
        &self,
        axis: usize,
        steps: i64,
        profile: &dyn Profile<F>,
        clock: &Clock<F>,
        borrowed: i128,
    ) -> Result<Vec<Segment>, Broken> {
        let total = i128::from(steps.unsigned_abs()) * ONE_STEP - borrowed;
        let mut writer = Writer {
            profile,
            clock: *clock,
            limits: &self.limits[axis],
            phase: self.build.phase,
            backward: steps < 0,
            segments: Vec::new(),
            ahead: 0,
        };
        for piece in share(profile, clock, total).ok_or(Broken::Range)? {
            writer.piece(piece)?;
        }
        Ok(writer.segments)
    }

    /// Puts the rest before the motion, marks the end, checks all of it, and moves the pins on.
    fn finish<F: Real>(
        &mut self,
        axis: usize,
        draft: Draft<F>,
        rest: u64,
        clock: &Clock<F>,
    ) -> Result<PlannedAxis, Broken> {
        let Draft { steps, profile, segments: mut motion, strokes, rest: own_rest } = draft;
        let phase = self.build.phase;
        let backward = steps < 0;
        let mut before = still(rest);
        let mut early = None;
        let mut borrowed = 0;
        if own_rest > 0 && strokes.is_some_and(|s| self.pins[axis].turns(&s)) {
            before = turning_rest(u32::try_from(rest).map_err(|_| Broken::Range)?, backward, phase);
            early = Some(i128::from(self.build.timebase.clocks_per_tick()));
            if borrows(phase, backward) {
                (early, borrowed) = (Some(0), 1);
                motion = self.motion(axis, steps, &*profile, clock, borrowed)?;
            }
        }
        let duty = Duty { backward, distance: i128::from(steps) * ONE_STEP - borrowed, ticks: clock.ticks };
        let peaks = if steps == 0 { Peaks::default() } else { check(&motion, &duty, &self.limits[axis])? };
        if before.iter().map(|s| edges::travel(s, s.ticks.into())).sum::<i128>() != borrowed {
            return Err(Broken::Landing);
        }
        if let Some(strokes) = strokes {
            let now = self.now();
            self.pins[axis].after(now, rest, early, &strokes, &self.build.pins[axis], &self.build.timebase);
        }
        let mut segments = before;
        segments.append(&mut motion);
        if let Some(last) = segments.last_mut() {
            last.last = true;
        }
        let profile: SharedProfile = Arc::new(Widened::new(profile));
        Ok(PlannedAxis { steps, segments, shape: profile.shape(), profile, peaks })
    }

    /// Clocks planned so far.
    fn now(&self) -> i128 {
        i128::from(self.ticks) * i128::from(self.build.timebase.clocks_per_tick())
    }
}

/// An axis that stands.
fn still(mut ticks: u64) -> Vec<Segment> {
    let mut segments = Vec::new();
    while ticks > 0 {
        let length = u32::try_from(ticks).unwrap_or(u32::MAX);
        segments.push(Segment { ticks: length, v: 0, a: 0, j: 0, last: false });
        ticks -= u64::from(length);
    }
    segments
}

fn broken(index: usize, axis: &Axis, broken: Broken) -> PlanError {
    PlanError::Broken { index, axis: axis.name.clone(), broken }
}

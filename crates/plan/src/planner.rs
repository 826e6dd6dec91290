//! Plans a move file: for each move it finds the time and the profiles, shares the distance out,
//! writes the segments, runs the exact check, and adds the rest that DIR needs.
//!
//! This file holds the order of these steps; each step has a module of its own. The exact check
//! (`check.rs`) decides whether a plan leaves this crate. A unit is 2^-64 step throughout the
//! crate.

use crate::asked::Asked;
use crate::check::{Duty, check};
use crate::demand::{Clock, PerAxis, demand};
use crate::direction::{Pins, Strokes, borrows, still, turning_rest};
use crate::edges::{self, Edges};
use crate::error::{Broken, PlanError};
use crate::limits::{ExactLimits, float_limits};
use crate::longest::longest_time;
use crate::peaks::Peaks;
use crate::plan::{Plan, PlannedAxis, PlannedMove};
use crate::share::Room;
use crate::slow::{self, Pulses};
use crate::units;
use bigdecimal::{BigDecimal, ToPrimitive as _};
use carrystep_core::ProfileKind;
use carrystep_core::fixed::ONE_STEP;
use carrystep_core::{Build, Segment};
use carrystep_files::{Axis, Machine, Move, MoveFile};
use carrystep_profile::{Limits, Profile, Real, SharedProfile};
use std::borrow::Cow;

mod motion;

/// Plans all moves of a file, with profiles computed in floats of type `F`.
///
/// Every plan that is returned travels exactly the commanded steps, whichever `F` is used. An f32
/// cannot tell ticks apart beyond 2^24 (16.8 s at 1 us): a longer move planned in f32 may be
/// refused by the exact check, but it never exceeds a limit unnoticed.
///
/// # Errors
/// A [`PlanError`] names the move and the axis, the limit that refuses the move, and, where one is
/// known, a value that would work.
pub fn plan<F: Real>(file: &MoveFile) -> Result<Plan, PlanError> {
    let mut planner = Planner::<F>::new(Cow::Borrowed(&file.machine))?;
    let mut moves = Vec::with_capacity(file.moves.len());
    for moved in &file.moves {
        moves.push(planner.plan(moved)?);
    }
    Ok(Plan { build: planner.build, moves })
}

/// Identifies one axis in one move, counted from 0.
#[derive(Debug, Clone, Copy)]
struct Place<'a> {
    asked: Asked<'a>,
    axis: usize,
}

/// Plans the moves of a machine one after the other.
pub(crate) struct Planner<'a, F> {
    machine: Cow<'a, Machine>,
    pub(crate) build: Build,
    limits: PerAxis<ExactLimits>,
    float_limits: PerAxis<Limits<F>>,
    pins: PerAxis<Pins>,
    room: Room,
    /// The next move, counted from 0.
    next: usize,
    /// Ticks planned so far, from the origin.
    pub(crate) ticks: u64,
}

/// One axis of a move before the common rest of all axes is known. `segments` holds the motion
/// alone and `rest` the ticks of rest that this axis needs.
struct Draft<F: Real> {
    steps: i64,
    profile: SharedProfile<F>,
    segments: Vec<Segment>,
    strokes: Option<Strokes>,
    rest: u64,
}

impl<'a, F: Real> Planner<'a, F> {
    /// # Errors
    /// A [`PlanError`] if no gateware can be built for the machine.
    pub(crate) fn new(machine: Cow<'a, Machine>) -> Result<Self, PlanError> {
        let timebase = machine.timebase;
        Ok(Self {
            build: machine.build()?,
            limits: machine.axes.iter().map(ExactLimits::new::<F>).collect(),
            float_limits: machine.axes.iter().map(float_limits).collect(),
            pins: machine.axes.iter().map(|_| Pins::new(&timebase)).collect(),
            room: Room::default(),
            machine,
            next: 0,
            ticks: 0,
        })
    }

    /// Plans the next move. After an error the planner is not used again.
    ///
    /// # Errors
    /// As [`plan`].
    pub(crate) fn plan(&mut self, moved: &Move) -> Result<PlannedMove, PlanError> {
        let index = self.next;
        self.next += 1;
        let asked = Asked { index, moved };
        let mut room = std::mem::take(&mut self.room);
        let mut drafts = PerAxis::new();
        let clock = self
            .drafts(asked, moved.time.as_ref(), &mut room, &mut drafts)
            .map_err(|error| self.explained(asked, error))?;
        self.room = room;
        let rest = drafts.iter().map(|draft| draft.rest).max().unwrap_or(0);
        let mut planned = Vec::with_capacity(drafts.len());
        for (axis, draft) in drafts.into_iter().enumerate() {
            let finished = self.finish(Place { asked, axis }, draft, rest, &clock);
            planned.push(finished.map_err(|b| broken(index, &self.machine.axes[axis], b))?);
        }
        let start_tick = self.ticks + rest;
        self.ticks = start_tick + clock.ticks;
        let seconds = clock.seconds.to_f64().unwrap_or(f64::NAN);
        let Move { profile, path, fit_ns, .. } = *moved;
        let fit_seconds = if profile.is_fitted() { fit_ns as f64 * 1e-9 } else { 0.0 };
        Ok(PlannedMove {
            start_tick,
            rest_ticks: rest,
            ticks: clock.ticks,
            seconds,
            given: moved.time.is_some(),
            fit_seconds,
            kind: profile,
            path,
            axes: planned,
        })
    }

    /// Plans all axes of a move, in the given time in seconds, or without one as fast as the limits
    /// allow. They are put into `drafts`.
    fn drafts(
        &self,
        asked: Asked<'_>,
        time: Option<&BigDecimal>,
        room: &mut Room,
        drafts: &mut PerAxis<Draft<F>>,
    ) -> Result<Clock<F>, PlanError> {
        let (clock, profiles) = demand(&self.machine, &self.float_limits, asked, time)?;
        for (axis, profile) in profiles.into_iter().enumerate() {
            let draft = self.draft(Place { asked, axis }, profile, &clock, room);
            drafts.push(draft.map_err(|b| broken(asked.index, &self.machine.axes[axis], b))?);
        }
        Ok(clock)
    }

    /// Turns the error of a move that is too slow into [`PlanError::TooSlow`], which names the
    /// longest time that works. It is found by bisection between the shortest and the given time;
    /// each candidate is planned as a trial. Every other error is returned unchanged.
    fn explained(&self, asked: Asked<'_>, error: PlanError) -> PlanError {
        let PlanError::Broken { axis, broken: broken @ (Broken::Slow | Broken::Segments), .. } =
            error
        else {
            return error;
        };
        let timebase = &self.build.timebase;
        let trial = |time: Option<&BigDecimal>| {
            self.drafts(asked, time, &mut Room::default(), &mut PerAxis::new()).ok()
        };
        let shortest = trial(None).and_then(|clock| clock.seconds.to_f64());
        let given = asked.moved.time.as_ref().and_then(BigDecimal::to_f64);
        let works = |time: &BigDecimal| trial(Some(time)).is_some();
        let longest = shortest
            .zip(given)
            .and_then(|(least, given)| longest_time(least, given, timebase, works));
        let named = self.machine.axes.iter().find(|one| one.name == axis);
        let least = slow::least_speed(timebase);
        let least_speed =
            named.map_or_else(|| format!("{least} steps/s"), |axis| axis.unit.both(least, 1));
        PlanError::TooSlow { index: asked.index, axis, broken, least_speed, longest }
    }

    fn draft(
        &self,
        place: Place<'_>,
        profile: SharedProfile<F>,
        clock: &Clock<F>,
        room: &mut Room,
    ) -> Result<Draft<F>, Broken> {
        let Place { asked, axis } = place;
        let steps = asked.moved.steps[axis];
        if steps == 0 {
            let segments = still(clock.ticks);
            return Ok(Draft { steps, profile, segments, strokes: None, rest: 0 });
        }
        let (timebase, phase) = (&self.build.timebase, self.build.phase);
        let pulses = Pulses::new(&*profile, clock, steps, (timebase, phase), 0);
        let segments = self.motion(place, &pulses, room)?;
        let backward = steps < 0;
        let edges = Edges { segments: &segments, start: phase.start_value(), backward, timebase };
        let [first, last] = pulses.ticks();
        let strokes = Strokes {
            backward,
            motion: i128::from(edges::first_motion(&segments))
                * i128::from(timebase.clocks_per_tick()),
            first_edge: edges.first(first).ok_or(Broken::Landing)?,
            last_edge: edges.last(pulses.count, last).ok_or(Broken::Landing)?,
        };
        let rest =
            self.pins[axis].rest(self.now(), &strokes, &self.build.pins[axis], (timebase, phase));
        Ok(Draft { steps, profile, segments, strokes: Some(strokes), rest })
    }

    /// The limits that the integers of one axis must keep in one move.
    fn limits(
        &self,
        Place { asked, axis }: Place<'_>,
        profile: &dyn Profile<F>,
    ) -> Cow<'_, ExactLimits> {
        let limits = &self.limits[axis];
        if asked.moved.profile != ProfileKind::Logistic || limits.start_speed > 0 {
            return Cow::Borrowed(limits);
        }
        // A logistic profile is never at rest. Without a start speed in the file, the speed of the
        // curve itself at time 0 is therefore the limit of the start speed.
        let per_tick = profile.speed(F::zero())
            * F::from(self.build.timebase.tick_seconds()).unwrap_or_else(F::nan);
        let start_speed = units::toward_zero(per_tick).unwrap_or(0);
        Cow::Owned(ExactLimits { start_speed, ..*limits })
    }

    /// Finishes an axis of a move, in this order: plans the motion again where the rest has already
    /// travelled a unit of it, runs the exact check on the motion alone, tests that the rest
    /// travels what it has borrowed, updates the recorded state of the axis' pins, puts the rest
    /// before the motion, and marks the last segment.
    fn finish(
        &mut self,
        place: Place<'_>,
        draft: Draft<F>,
        rest: u64,
        clock: &Clock<F>,
    ) -> Result<PlannedAxis, Broken> {
        let Draft { steps, profile, segments: mut motion, strokes, rest: own_rest } = draft;
        let axis = place.axis;
        let phase = self.build.phase;
        let backward = steps < 0;
        let mut before = still(rest);
        let mut early = None;
        let mut borrowed = 0;
        // A rest in which DIR changes is written by `turning_rest`, whose length has 32 bits; a
        // longer one is refused.
        if own_rest > 0 && strokes.is_some_and(|s| self.pins[axis].changes_dir(&s)) {
            before = turning_rest(u32::try_from(rest).map_err(|_| Broken::Range)?, backward, phase);
            early = Some(i128::from(self.build.timebase.clocks_per_tick()));
            if borrows(phase, backward) {
                (early, borrowed) = (Some(0), 1);
                let build = (&self.build.timebase, phase);
                let pulses = Pulses::new(&*profile, clock, steps, build, borrowed);
                motion = self.motion(place, &pulses, &mut Room::default())?;
            }
        }
        let duty = Duty {
            backward,
            distance: i128::from(steps) * ONE_STEP - borrowed,
            ticks: clock.ticks,
        };
        let limits = self.limits(place, &*profile);
        let peaks = if steps == 0 { Peaks::default() } else { check(&motion, &duty, &limits)? };
        if before.iter().map(|s| edges::travel(s, s.ticks.into())).sum::<i128>() != borrowed {
            return Err(Broken::Landing);
        }
        if let Some(strokes) = strokes {
            let (now, Build { timebase, pins, .. }) = (self.now(), &self.build);
            self.pins[axis].after(now, rest, early, &strokes, &pins[axis], timebase);
        }
        let mut segments = motion;
        if rest > 0 {
            segments.splice(0..0, before);
        }
        if let Some(last) = segments.last_mut() {
            last.last = true;
        }
        let profile = F::widened(profile);
        let rounding_steps = place.asked.moved.rounding[axis];
        Ok(PlannedAxis { steps, rounding_steps, segments, shape: profile.shape(), profile, peaks })
    }

    /// Gateware clocks planned so far, from the origin.
    fn now(&self) -> i128 {
        i128::from(self.ticks) * i128::from(self.build.timebase.clocks_per_tick())
    }
}

fn broken(index: usize, axis: &Axis, broken: Broken) -> PlanError {
    PlanError::Broken { index, axis: axis.name.clone(), broken }
}

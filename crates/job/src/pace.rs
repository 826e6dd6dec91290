//! Overrides: the motion goes along the planned curve at another speed, while a program runs.
//!
//! As in a [hold](crate::Hold), the motors are at x(p(t)) where the plan has x(p). The rate dp/dt is
//! the greatest with which the speed along the path is at most the feed times its override, and with
//! which each motor keeps its limits. Rapid moves go at most at their override of the planned speed.
//!
//! ```text
//! planned rows --> target.rs: greatest rates  --> drive.rs: rows of equal length --> keep.rs: exact
//!                  of a window                    on the planned curve               check
//! ```
//!
//! A window reaches so far ahead that the motion can come back to the rate 1, at which the plan
//! itself is lawful. Only rows of a window that was checked to its end are passed on, so that the
//! next window can always go on as the one before. As long as all overrides are 1, planned rows pass
//! as they are; after a change, the plan itself follows from the next rest on.

mod drive;
mod phase;
mod place;
mod rates;
mod target;
mod track;

use crate::error::JobError;
use crate::keep::{Keep, REST};
use crate::limits::SHORTEST;
use crate::row::Row;
use bigdecimal::ToPrimitive;
use carrystep_files::Machine;
use drive::{Begin, Driven, drive};
use phase::align;
use rates::Rates;
use std::collections::VecDeque;
use std::sync::Arc;
use target::{Rules, TRIES};
pub use track::Track;

/// 2^64, the units of a step.
const STEP: f64 = 18_446_744_073_709_551_616.0;
/// Planned time of a window, as a multiple of the time in which an axis reaches its greatest speed.
const AMPLE: f64 = 2.5;
/// Rows of a window in any case.
const LEAST_WINDOW: u64 = 200;
/// Rows of the longest window.
const MOST_WINDOW: u64 = 4000;
/// Rows that are passed on before the next window is looked at.
const BLOCK: u32 = 48;
/// Rows until the next try where no rates keep the limits.
const RETRY: u32 = 3;
/// Rows over which a change of the rate is tried, at the rate 1.
const FIRST_TRY: f64 = 4.0;
/// By how much each try is longer than the one before.
const LONGER: f64 = 1.5;
/// Rows of the longest try.
const LONGEST_TRY: f64 = 300.0;

/// Factors of the feed and of rapid moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overrides {
    /// Of the feed, from 0.1 to 2.
    pub feed: f64,
    /// Of rapid moves, from 0.1 to 1.
    pub rapid: f64,
}

impl Overrides {
    /// Everything as planned.
    pub const NONE: Self = Self { feed: 1.0, rapid: 1.0 };
}

impl Default for Overrides {
    fn default() -> Self {
        Self::NONE
    }
}

/// Where a row begins, so that [`Pace::back`] can return there.
#[derive(Debug, Clone)]
pub struct PacePlace(Arc<Begin>);

impl PacePlace {
    /// The number of the planned row in which it is.
    pub fn row(&self) -> u64 {
        self.0.row
    }
}

/// A row as the motion has it.
#[derive(Debug, Clone)]
pub struct Paced {
    /// The row.
    pub row: Row,
    /// Planned ticks per tick where it begins.
    pub rate: f64,
    /// Where it begins.
    pub from: PacePlace,
}

/// Planned rows at the rates of overrides.
#[derive(Debug, Clone)]
pub struct Pace {
    keep: Keep,
    /// Of each motor, mm/s of the tool for a speed of one unit per tick; 0 for all but the first motor
    /// of a letter; `None` for rotary ones.
    linear: Vec<Option<f64>>,
    width: usize,
    window: u64,
    overrides: Overrides,
    ready: VecDeque<(Row, Arc<Begin>)>,
    /// Where the rows that are ready end.
    end: Arc<Begin>,
    /// Rows until the next window is looked at; `None` if those that are ready lead to a rest.
    next_look: Option<u32>,
}

impl Pace {
    /// Paces the rows of a program that begins at these steps from machine zero.
    ///
    /// # Errors
    /// [`JobError::Axes`].
    pub fn new(machine: &Machine, start_steps: &[i64]) -> Result<Self, JobError> {
        let keep = Keep::new(machine)?;
        let tick_seconds = machine.timebase.tick_seconds();
        let linear = machine.axes.iter().enumerate().map(|(motor, axis)| {
            let steps = axis.steps_per_unit.to_f64().filter(|steps| *steps > 0.0)?;
            let is_linear = matches!(&*axis.letter, "x" | "y" | "z");
            // The speed of a letter is that of its first motor.
            let leads = machine.leader(motor) == motor;
            let counts = if leads { machine.step_of_tool(motor) } else { 0.0 };
            is_linear.then_some(counts / (STEP * steps * tick_seconds))
        });
        let row = SHORTEST / tick_seconds;
        let times = |of: fn(&carrystep_plan::exact::ExactLimits) -> f64| {
            keep.limits.iter().map(of).fold(0.0, f64::max) / row
        };
        let reached = times(|one| one.speed as f64 / one.acceleration as f64);
        let bent = times(|one| one.jerk.map_or(0.0, |jerk| one.acceleration as f64 / jerk as f64));
        let begin = Begin {
            row: 0,
            marked: 0,
            at: start_steps.iter().map(|&steps| i128::from(steps) << 64).collect(),
            before: vec![REST; start_steps.len()],
            motion: None,
        };
        Ok(Self {
            linear: linear.collect(),
            width: (bent.ceil() as usize).clamp(1, 100),
            window: LEAST_WINDOW + ((AMPLE * reached) as u64).min(MOST_WINDOW),
            overrides: Overrides::NONE,
            ready: VecDeque::new(),
            end: Arc::new(begin),
            next_look: None,
            keep,
        })
    }

    /// The overrides in force.
    pub const fn overrides(&self) -> Overrides {
        self.overrides
    }

    /// Sets the overrides for the rows from a place on, that of a row that was passed on or of the
    /// next one. The rows behind it are paced again.
    pub fn set(&mut self, overrides: Overrides, place: Option<&PacePlace>) {
        self.overrides = overrides;
        if let Some(PacePlace(begin)) = place {
            self.end = Arc::clone(begin);
            self.ready.clear();
        }
        self.next_look = Some(0);
    }

    /// Drops the planned rows that only the rows before a place need.
    pub fn forget(&self, track: &mut Track, place: &PacePlace) {
        track.forget(place.row().saturating_sub(self.history()));
    }

    /// Rows before a place that are looked at.
    const fn history(&self) -> u64 {
        (4 * TRIES * (self.width + 2)) as u64
    }

    /// The next row; `None` where the planned rows end. `track` is the same one each time, and
    /// `source` gives the planned row behind its last one.
    pub fn next(
        &mut self,
        track: &mut Track,
        source: &mut dyn FnMut() -> Option<Row>,
    ) -> Option<Paced> {
        let begin = self.ready.front().map_or(&self.end, |(_, begin)| begin);
        let begin = Arc::clone(begin);
        if track.take(begin.row, source) && self.is_due(track, &begin) {
            let looks = self.overrides != Overrides::NONE || begin.motion.is_some();
            let found = if looks { self.look(track, &begin, source) } else { None };
            self.next_look = Some(if found.is_some() { BLOCK } else { RETRY });
            if let Some(driven) = found {
                let rows = driven.rows.into_iter();
                self.ready = rows.map(|(row, begin)| (row, Arc::new(begin))).collect();
                self.next_look = driven.end.motion.as_ref().map(|_| BLOCK);
                self.end = Arc::new(driven.end);
            }
        }
        if let Some(next) = &mut self.next_look {
            *next = next.saturating_sub(1);
        }
        if let Some((row, begin)) = self.ready.pop_front() {
            let rate = begin.rate(track);
            return Some(Paced { row, rate, from: PacePlace(begin) });
        }
        // If a motion that is not at its place in the plan could not go on, the rows would break off.
        // It can: at the end of its window the rate is one that keeps all limits.
        let row = track.row(begin.row).filter(|_| begin.motion.is_none())?.clone();
        let at = track.at(begin.row + 1)?.clone();
        let number = begin.row + 1;
        let before = row.segments.clone();
        self.end = Arc::new(Begin { row: number, marked: number, at, before, motion: None });
        Some(Paced { row, rate: 1.0, from: PacePlace(begin) })
    }

    /// Whether the next window is to be looked at where a row begins.
    fn is_due(&self, track: &Track, begin: &Begin) -> bool {
        let ends = || begin.motion.is_some() || track.rests(begin.row);
        match self.next_look {
            Some(0) => true,
            Some(_) => self.ready.is_empty() && ends(),
            None => self.ready.is_empty(),
        }
    }

    /// The rows of the next window from a place; `None` if the plan is to follow as it is, or if no
    /// rates keep the limits.
    fn look(
        &self,
        track: &mut Track,
        begin: &Begin,
        source: &mut dyn FnMut() -> Option<Row>,
    ) -> Option<Driven> {
        let rests = begin.motion.is_none() && track.rests(begin.row);
        if rests && !track.moves(begin.row) {
            return None;
        }
        let mut end = begin.row + 1;
        let ends = loop {
            if !track.take(end, source) || track.rests(end) {
                break true;
            }
            if end >= begin.row + self.window {
                break false;
            }
            end += 1;
        };
        let mut first = begin.row;
        let history = track.first().max(begin.row.saturating_sub(self.history()));
        while first > history && !track.rests(first) {
            first -= 1;
        }
        let old = match &begin.motion {
            Some(motion) => Some(Arc::clone(&motion.rates)),
            None => (!rests).then(|| Arc::new(Rates::constant(first, 1.0))),
        };
        let rules = Rules {
            limits: self.keep.limits.clone(),
            linear: self.linear.clone(),
            feed: self.overrides.feed,
            rapid: self.overrides.rapid,
            width: self.width,
        };
        // The rate in the row of the place follows from the values of the rows around it, too.
        let is_between = begin.motion.as_ref().is_some_and(|motion| motion.tick > 0.0);
        let stays = begin.row + u64::from(is_between);
        for attempt in 0..TRIES {
            let target = rules.target(track, (first, end, ends), attempt);
            let Some(old) = &old else {
                if let Ok(driven) = self.try_rates(track, begin, (end, ends), target, true) {
                    return Some(driven);
                }
                continue;
            };
            let mut over = 1.0 + (FIRST_TRY - 1.0) * old.of(begin.row).min(1.0);
            while over <= LONGEST_TRY {
                let rates = old.toward(&target, stays, over);
                match self.try_rates(track, begin, (end, ends), rates, false) {
                    Ok(driven) => return Some(driven),
                    // The target itself may be too fast there.
                    Err(Some(row)) if row as f64 > stays as f64 + 2.0 * over + 8.0 => break,
                    Err(_) => over *= LONGER,
                }
            }
        }
        // As before.
        let old = old.filter(|_| begin.motion.is_some())?;
        let values = (first..end).map(|row| old.of(row)).collect();
        self.try_rates(track, begin, (end, ends), Rates { first, values }, false).ok()
    }

    /// The rows at these rates.
    ///
    /// # Errors
    /// The planned row near which a limit is broken, if there are rows.
    fn try_rates(
        &self,
        track: &Track,
        begin: &Begin,
        (end, ends): (u64, bool),
        mut rates: Rates,
        rests: bool,
    ) -> Result<Driven, Option<u64>> {
        let ticks = begin.motion.as_ref().map(|motion| motion.ticks);
        let ticks = ticks.or_else(|| track.row(begin.row).map(|row| row.ticks)).ok_or(None)?;
        align(track, &mut rates, begin.place(), end, ticks);
        let rates = Arc::new(rates);
        let mut driven = drive(track, begin, (end, ends), &rates, rests).ok_or(None)?;
        let lands = driven.end.motion.is_none();
        let rows: Vec<Row> = driven.rows.iter().map(|(row, _)| row.clone()).collect();
        let rest = vec![REST; begin.at.len()];
        let (rows, after) = match rows.split_last() {
            Some((last, rows)) if !lands => (rows, &last.segments),
            _ => (&rows[..], &rest),
        };
        if let Some(broken) = self.keep.broken(&begin.at, &begin.before, rows, after) {
            return Err(driven.rows.get(broken).map(|(_, begin)| begin.row));
        }
        if lands && let Some(last) = track.row(end.saturating_sub(1)) {
            let segments = driven.rows.last_mut().map(|(row, _)| &mut row.segments);
            let marks = last.segments.iter().map(|segment| segment.last);
            segments.into_iter().flatten().zip(marks).for_each(|(one, last)| one.last = last);
        }
        Ok(driven)
    }
}

//! Holds: the motion comes to rest on the planned curve, and later goes on along it.
//!
//! The planned rows stay what they are. Only time changes: the motors are at x(p(t)) where the plan
//! has x(p), and the rate dp/dt falls from 1 to 0 or rises from 0 to 1 ([`law`]). So the tool stays on
//! the planned curve, whatever it is, and behind the resumed motion the planned rows follow bit for
//! bit.
//!
//! ```text
//! planned    |----|----|----|----|----|----|----|----|----|----|    p, rows of equal length
//!                 ^ from       ^ rest            ^ first row that is as planned
//! re-timed        |-----|------|     |------|----|----|----|----|    t
//! ```
//!
//! A re-timed row ends where the planned one does, so that its motors follow a piece of one cubic
//! each. It is checked like all others: exactly, against each limit. A transition that breaks a
//! limit is tried again over more time. Where the planned motion itself uses the whole
//! acceleration, none may be possible; then a later row has to begin it.

mod curve;
mod law;
mod transition;

pub use curve::{Curve, CurvePlace};

use crate::error::JobError;
use crate::keep::Keep;
use crate::limits::SHORTEST;
use crate::rhythm::LONGEST;
use crate::row::Row;
use carrystep_core::Segment;
use carrystep_files::Machine;
use law::{Law, Way};
use transition::rows;

/// The planned time of the shortest stop that is tried, seconds.
const FIRST_TRY: f64 = 0.008;
/// By how much each try is longer than the one before.
const LONGER: f64 = 1.2;
/// How long a hold may wait before it begins, to be at rest sooner, seconds.
const PROMPT: f64 = 0.016;
/// The part of [`Hold::least`] at which the search begins: the plan may slow down by itself.
const SHORTEST_PART: f64 = 0.5;
/// The planned time of a hold, as a multiple of the time in which an axis reaches its greatest
/// speed: stop and resumption take nearly twice that at the least.
const AMPLE: f64 = 4.0;
/// Rows that a hold looks at in any case.
const LEAST_WINDOW: usize = 300;
/// The planned time of the longest transition, seconds.
const LONGEST_TRY: f64 = 20.0;

/// Re-times rows of a machine's plans.
#[derive(Debug, Clone)]
pub struct Hold {
    keep: Keep,
    tick_seconds: f64,
    /// Ticks of the longest row.
    longest: u32,
}

/// A hold: the rows that lead to rest, and those that lead back.
#[derive(Debug, Clone, PartialEq)]
pub struct Held {
    /// The rows with which the motion leaves the plan; the last one ends at rest.
    pub stop: Vec<Row>,
    /// The rows with which it comes back; the first one begins at rest.
    pub resume: Vec<Row>,
    /// Where on the planned curve the motors rest.
    pub place: CurvePlace,
    /// The planned row that follows the last one of `resume`; the number of rows if the plan ends
    /// there.
    pub next: usize,
}

impl Hold {
    /// Holds of plans for a machine.
    ///
    /// # Errors
    /// [`JobError::Axes`].
    pub fn new(machine: &Machine) -> Result<Self, JobError> {
        let tick_seconds = machine.timebase.tick_seconds();
        Ok(Self {
            keep: Keep::new(machine)?,
            tick_seconds,
            longest: ((LONGEST / tick_seconds) as u32).max(1),
        })
    }

    /// The hold that brings the motion to rest first, of those that begin with a planned row from
    /// `first` on and within [`PROMPT`] of it. Gives the row too with which it begins. `None` if no
    /// such hold keeps the limits; a later row may have one.
    pub fn hold(&self, curve: &Curve<'_>, first: usize) -> Option<(usize, Held)> {
        let prompt = (PROMPT / self.tick_seconds) as u64;
        let begin = |row| curve.ticks_to(CurvePlace { row, tick: 0 });
        let since = begin(first);
        let mut best: Option<(u64, usize, Held)> = None;
        for from in first..curve.rows().len() {
            let waited = begin(from) - since;
            let rested = best.as_ref().map_or(u64::MAX, |(rested, ..)| *rested);
            if waited >= rested || waited > prompt {
                break;
            }
            if let Some(held) = self.from(curve, from, rested - waited) {
                let ticks = held.stop.iter().map(|row| u64::from(row.ticks)).sum::<u64>();
                best = Some((waited + ticks, from, held));
            }
        }
        best.map(|(_, from, held)| (from, held))
    }

    /// So many planned rows are enough to stop and to go on if the motion goes on at its greatest
    /// speed and the rows last 4 ms.
    pub fn window(&self) -> usize {
        let times = self.keep.limits.iter().map(|one| one.speed as f64 / one.acceleration as f64);
        let slowest = times.fold(0.0, f64::max) * self.tick_seconds;
        (AMPLE * slowest.min(LONGEST_TRY) / SHORTEST) as usize + LEAST_WINDOW
    }

    /// The hold that begins with a row and takes the shortest time, if that is less than `most`
    /// ticks.
    fn from(&self, curve: &Curve<'_>, from: usize, most: u64) -> Option<Held> {
        let begin = curve.ticks_to(CurvePlace { row: from, tick: 0 });
        let longest = ((LONGEST_TRY / self.tick_seconds) as u64).min(curve.ticks() - begin);
        let before = curve.segments(from.checked_sub(1));
        let mut planned =
            (FIRST_TRY / self.tick_seconds).max(self.least(curve, begin) * SHORTEST_PART);
        while planned as u64 <= longest && 2 * (planned as u64) < most {
            let law = Law::over(Way::Stop, planned as u64);
            let end = begin + planned as u64;
            let place = curve.place(end);
            if let Some(stop) = rows(curve, (begin, end), law, self.longest)
                && self.keep(&curve.at(curve.place(begin)), &before, &stop, &curve.segments(None))
                && let Some((resume, next)) = self.resume(curve, place)
            {
                return Some(Held { stop, resume, place, next });
            }
            planned = (planned * LONGER).ceil();
        }
        None
    }

    /// The planned time of the shortest stop of a motion that goes on evenly from a planned tick,
    /// ticks: half of the time in which the law's steepest rate changes its speed.
    fn least(&self, curve: &Curve<'_>, tick: u64) -> f64 {
        let motors = self.keep.limits.iter().zip(curve.sample(tick as f64));
        let times = motors.map(|(limits, motor)| motor.speed.abs() / limits.acceleration as f64);
        Law::STEEPEST / 2.0 * times.fold(0.0, f64::max)
    }

    /// The rows that bring the motion from rest at a place back to the planned one, soon, and the
    /// planned row that follows.
    fn resume(&self, curve: &Curve<'_>, place: CurvePlace) -> Option<(Vec<Row>, usize)> {
        let begin = curve.ticks_to(place);
        let mut wanted = FIRST_TRY / self.tick_seconds / 2.0;
        for next in place.row + 1..=curve.rows().len() {
            let end = curve.ticks_to(CurvePlace { row: next, tick: 0 });
            let planned = (end - begin) as f64;
            if planned * self.tick_seconds > LONGEST_TRY {
                return None;
            }
            if planned >= wanted {
                let law = Law::over(Way::Resume, end - begin);
                let before = curve.segments(None);
                if let Some(rows) = rows(curve, (begin, end), law, self.longest)
                    && self.keep(&curve.at(place), &before, &rows, &curve.segments(Some(next)))
                {
                    return Some((rows, next));
                }
                wanted = planned * LONGER;
            }
        }
        None
    }

    /// Whether rows keep all limits, from the segments before them to those behind.
    fn keep(&self, at: &[i128], before: &[Segment], rows: &[Row], after: &[Segment]) -> bool {
        self.keep.broken(at, before, rows, after).is_none()
    }
}

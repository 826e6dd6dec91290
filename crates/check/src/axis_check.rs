//! Checks one axis edge by edge, in constant memory.
//!
//! Transcripts in tests/ quote the messages.

use crate::ahead::Ahead;
use crate::edge::{Pin, PinChange};
use crate::exact;
use crate::ideal::{
    ALMOST, Due, PS, curvature_ps, is_less_curved, moment, nearest, phase_ps, tick_ps,
};
use crate::origin::Base;
use crate::pins::PinWatch;
use crate::spread::Spread;
use carrystep_core::{PinTimes, StartPhase, Timebase};
use carrystep_files::Unit;
use carrystep_profile::{Crossing, Timeline, Travel};
use serde::{Deserialize, Serialize};

mod judge;
mod part;

pub(crate) use part::AxisPart;

/// The values against which one axis is checked.
#[derive(Debug, Clone)]
pub struct AxisSetup<'a> {
    /// The name of the axis in the report.
    pub name: &'a str,
    /// The unit of the axis in messages; `None`: steps.
    pub unit: Option<&'a Unit>,
    /// The float profile of all moves.
    pub timeline: Timeline,
    /// What the axis does in all moves together.
    pub travel: Travel,
    /// The pin times that the driver requires, ns.
    pub pins_ns: PinTimes,
}

/// Allowance for rounding, ps. Times are rounded to ps and P to 32 bits; together both stay below
/// it.
const ROUNDING_PS: f64 = 2000.0;

/// The number of failures of single pulses that get a message for each axis. The others are only
/// counted.
const SPELLED_OUT: usize = 8;

/// A pulse that has been paired with its crossing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Paired {
    ps: u64,
    #[serde(with = "exact")]
    lateness_ps: f64,
    backward: bool,
    /// First tick of the crossing's move.
    start_tick: u64,
    /// Seconds from that tick to the crossing.
    #[serde(with = "exact")]
    seconds: f64,
}

/// What was found so far on the pins of an axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Found {
    watch: PinWatch,
    position: i64,
    wrong_direction: u64,
    /// The pulse that was paired last.
    last: Option<Paired>,
    errors: Spread,
    #[serde(with = "exact")]
    curvature_ps: f64,
    #[serde(with = "exact::optional")]
    jitter_ps: Option<f64>,
    #[serde(with = "exact::optional")]
    ripple: Option<f64>,
    #[serde(with = "exact")]
    shortest_ideal_ps: f64,
    /// Messages about single pulses, at most [`SPELLED_OUT`].
    pulse_failures: Vec<String>,
    omitted: u64,
}

impl Found {
    fn new(watch: PinWatch) -> Self {
        Self {
            watch,
            position: 0,
            wrong_direction: 0,
            last: None,
            errors: Spread::default(),
            curvature_ps: 0.0,
            jitter_ps: None,
            ripple: None,
            shortest_ideal_ps: f64::INFINITY,
            pulse_failures: Vec::new(),
            omitted: 0,
        }
    }

    fn fail_pulse(&mut self, message: String) {
        if self.pulse_failures.len() < SPELLED_OUT {
            self.pulse_failures.push(message);
        } else {
            self.omitted += 1;
        }
    }

    /// Takes the next paired pulse beside the one before.
    fn follow(&mut self, next: Paired) {
        if let Some(last) = self.last.filter(|last| last.backward == next.backward) {
            let since = next.ps.saturating_sub(last.ps) as f64;
            let jitter = (next.lateness_ps - last.lateness_ps).abs();
            self.jitter_ps = greater(self.jitter_ps, jitter);
            if last.start_tick == next.start_tick && since > 0.0 {
                // Most pulses are far from the greatest ripple, and need no division.
                if self.ripple.is_none_or(|most| jitter > most * since * ALMOST) {
                    self.ripple = greater(self.ripple, jitter / since);
                }
                let ideal = (next.seconds - last.seconds) * PS;
                self.shortest_ideal_ps = self.shortest_ideal_ps.min(ideal);
            }
        }
        self.last = Some(next);
    }
}

/// An edge beside the next crossing.
struct Compared {
    /// The lateness of the edge, if it belongs to the next crossing, ps.
    lateness_ps: Option<f64>,
    /// The time since the last paired pulse on the pins, ps, and the lateness of that pulse; `None`
    /// before the first paired pulse of a capture whose origin is only an estimate.
    last: Option<(f64, f64)>,
}

fn greater(old: Option<f64>, new: f64) -> Option<f64> {
    Some(old.map_or(new, |old| old.max(new)))
}

/// The period that the profile has between a paired pulse and a crossing, ps: the period on the
/// pins minus the change of the lateness.
fn profile_period(since: f64, late: f64, before: f64) -> f64 {
    since - (late - before)
}

/// The state of the check of one axis.
pub(crate) struct AxisCheck<'a> {
    name: &'a str,
    unit: Option<&'a Unit>,
    pins_ns: PinTimes,
    travel: Travel,
    /// When the first pulse is due; `None` if the axis has none.
    first: Option<Due>,
    timebase: Timebase,
    slack_ps: f64,
    /// The greatest tolerance of a fit, ps.
    fit_ps: f64,
    /// The allowed deviation of a period, ps, before its edge counts as an extra or a missing
    /// pulse. A fit may shift both edges of the period.
    tolerance_ps: f64,
    ahead: Ahead,
    /// Number of the crossing with which the check of a part of the capture has begun; `None` if
    /// it began at the start of the capture.
    begun_at: Option<u64>,
    found: Found,
    /// The first pulse, if it was paired.
    first_paired: Option<Paired>,
    /// Messages about the axis as a whole; there are only a few.
    failures: Vec<String>,
}

impl<'a> AxisCheck<'a> {
    pub(crate) fn new(
        setup: AxisSetup<'a>,
        phase: StartPhase,
        timebase: Timebase,
        slack_ps: u64,
    ) -> Self {
        let AxisSetup { name, unit, timeline, travel, pins_ns } = setup;
        let tick_ps = tick_ps(&timebase);
        let fit_ps = (travel.fit_seconds * PS).round();
        let first = travel.first.as_ref();
        Self {
            name,
            unit,
            pins_ns,
            first: first.map(|leg| Due::of(&leg.crossing(phase, 1), tick_ps)),
            travel,
            timebase,
            slack_ps: slack_ps as f64,
            fit_ps,
            tolerance_ps: phase_ps(&timebase) + slack_ps as f64 + 2.0 * fit_ps,
            ahead: Ahead::new(&timeline, phase, tick_ps),
            begun_at: None,
            found: Found::new(PinWatch::default()),
            first_paired: None,
            failures: Vec::new(),
        }
    }

    fn fail(&mut self, what: &str) {
        self.failures.push(format!("axis {}: {what}", self.name));
    }

    fn fail_pulse(&mut self, what: &str) {
        self.found.fail_pulse(format!("axis {}: {what}", self.name));
    }

    /// When the first pulse is due; `None` if there is none.
    pub(crate) fn first(&self) -> Option<Due> {
        self.first
    }

    pub(crate) fn initial(&mut self, pin: Pin, level: bool) {
        self.found.watch.initial(pin, level);
        if pin == Pin::Step && level {
            self.fail("STEP is high when the capture begins");
        }
    }

    /// Takes a change of a pin.
    pub(crate) fn change(&mut self, change: PinChange, base: Base) {
        if self.found.watch.change(change) {
            self.pulse(change, base);
        }
    }

    fn pulse(&mut self, change: PinChange, base: Base) {
        self.look_ahead(change.ps, base);
        let next = self.ahead.next(0);
        self.found.watch.assume_dir(|| next.is_some_and(|(crossing, _)| crossing.backward));
        let backward = self.found.watch.backward();
        self.found.position += if backward { -1 } else { 1 };
        let mut compared = self.compare(change.ps, base);
        if self.is_extra(&compared) {
            let after = match self.ahead.number() - 1 {
                0 => "before pulse 1".to_owned(),
                k if k == self.travel.pulses => format!("after pulse {k}, the last"),
                k => format!("after pulse {k}"),
            };
            self.fail_pulse(&format!("one pulse too many at {}, {after}", moment(change.ps)));
            return;
        }
        while self.is_missing(&compared, change.ps, base) {
            self.miss(base.ps);
            self.look_ahead(change.ps, base);
            compared = self.compare(change.ps, base);
        }
        let (Some(&(crossing, _)), Some(lateness_ps)) = (self.ahead.next(0), compared.lateness_ps)
        else {
            return;
        };
        if crossing.backward != backward {
            self.found.wrong_direction += 1;
            let way = |back| if back { "backward" } else { "forward" };
            self.fail_pulse(&format!(
                "pulse {} at {} goes {}, the profile {}",
                self.ahead.number(),
                moment(change.ps),
                way(backward),
                way(crossing.backward)
            ));
        }
        self.pair(change.ps, backward, crossing, lateness_ps);
        self.ahead.advance();
    }

    /// Computes the next two crossings, as far as an edge at `ps` may belong to one of them.
    ///
    /// An edge is nearer to the last paired pulse than to a crossing that is twice as far from this
    /// pulse as the edge is.
    fn look_ahead(&mut self, ps: u64, base: Base) {
        if self.ahead.has_two() || self.ahead.number() > self.travel.pulses {
            return;
        }
        // The first pulse of a part is compared with the next crossing alone.
        let beside = self.begun_at.map(|_| (0.0, 0.0));
        let tick = self.since_last(ps, base).or(beside).map_or(u64::MAX, |(since, before)| {
            let now = nearest(i128::from(ps) - i128::from(base.ps));
            let latest = now + since + 2.0 * (self.tolerance_ps + before.abs());
            // A cast saturates: before the origin the tick is 0.
            (latest / tick_ps(&self.timebase) as f64) as u64 + 2
        });
        self.ahead.look_to(tick);
    }

    /// The time from the last paired pulse to `ps`, ps, and the lateness of that pulse. Before the
    /// first one the origin counts as a pulse in time, unless it is only an estimate.
    fn since_last(&self, ps: u64, base: Base) -> Option<(f64, f64)> {
        match self.found.last {
            Some(last) => Some((ps.saturating_sub(last.ps) as f64, last.lateness_ps)),
            None if base.is_sure && self.begun_at.is_none() => {
                Some((nearest(i128::from(ps) - i128::from(base.ps)), 0.0))
            }
            None => None,
        }
    }

    /// Compares an edge with the next crossing.
    fn compare(&self, ps: u64, base: Base) -> Compared {
        Compared { lateness_ps: self.lateness_ps(0, ps, base), last: self.since_last(ps, base) }
    }

    /// The lateness of an edge, if it belongs to the next crossing (0) or to the one after it (1),
    /// ps.
    fn lateness_ps(&self, which: usize, ps: u64, base: Base) -> Option<f64> {
        Some(self.ahead.next(which)?.1.lateness_ps(ps, base.ps))
    }

    fn is_extra(&self, compared: &Compared) -> bool {
        match (compared.lateness_ps, compared.last) {
            (None, _) => true,
            (Some(late), Some((since, before))) => {
                since < profile_period(since, late, before) / 2.0 - self.tolerance_ps
            }
            (Some(_), None) => false,
        }
    }

    fn is_missing(&self, compared: &Compared, ps: u64, base: Base) -> bool {
        let (Some(late), Some((since, before))) = (compared.lateness_ps, compared.last) else {
            return false;
        };
        let this = profile_period(since, late, before);
        // The crossing after the next one is not earlier, so that most edges need no comparison
        // with it.
        if since <= this + self.tolerance_ps {
            return false;
        }
        self.lateness_ps(1, ps, base).is_some_and(|late| {
            let after = profile_period(since, late, before);
            since > f64::midpoint(this, after) + self.tolerance_ps
        })
    }

    /// Records that the next crossing has no pulse.
    fn miss(&mut self, origin_ps: i64) {
        if let Some((_, due)) = self.ahead.next(0) {
            let due = moment(due.at_ps(origin_ps));
            self.fail_pulse(&format!("pulse {} is missing, due at {due}", self.ahead.number()));
            self.ahead.advance();
        }
    }

    /// Records the crossings that are left when the capture ends.
    fn miss_rest(&mut self, origin_ps: i64) {
        let number = self.ahead.number();
        let left = self.travel.pulses.saturating_sub(number - 1);
        if left > 0 {
            self.ahead.look_to(u64::MAX);
        }
        match self.ahead.next(0) {
            Some((_, first)) if left > 1 => {
                let due = moment(first.at_ps(origin_ps));
                self.fail_pulse(&format!(
                    "pulse {number} and all behind it are missing, due from {due}"
                ));
            }
            _ => self.miss(origin_ps),
        }
    }

    fn pair(&mut self, ps: u64, backward: bool, crossing: Crossing, lateness_ps: f64) {
        let found = &mut self.found;
        found.errors.add(lateness_ps, self.ahead.number(), ps);
        if !is_less_curved(&crossing, &self.timebase, found.curvature_ps) {
            found.curvature_ps = found.curvature_ps.max(curvature_ps(&crossing, &self.timebase));
        }
        let Crossing { start_tick, seconds, .. } = crossing;
        let paired = Paired { ps, lateness_ps, backward, start_tick, seconds };
        if found.watch.pulses() == 1 {
            self.first_paired = Some(paired);
        }
        found.follow(paired);
    }

    /// Least and greatest lateness so far, ps.
    pub(crate) fn range_ps(&self) -> Option<(f64, f64)> {
        Some((self.found.errors.min()?.value, self.found.errors.max()?.value))
    }

    /// The greatest allowed deviation of an edge from the profile, ps.
    pub(crate) fn bound_ps(&self) -> f64 {
        phase_ps(&self.timebase)
            + self.found.curvature_ps
            + self.fit_ps
            + ROUNDING_PS
            + self.slack_ps
    }
}

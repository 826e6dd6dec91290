//! The check of a capture of a job: the path that the pulses follow, and, against the plan, their
//! times.

use crate::edge::{Pin, PinChange, PinSink};
use crate::error::TraceError;
use crate::origin::Origin;
use crate::path_check::{PathChecker, PathSetup};
use crate::path_leg::PathLeg;
use crate::path_report::PathReport;
use crate::pulse_times::{PlannedRows, PulseTimes, PulseTimesReport};
use crate::report::{OriginKind, table};
use carrystep_core::Timebase;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// The check of a capture of a job.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct JobReport {
    /// Whether there is no failure.
    pub passed: bool,
    /// How the origin was determined. Without times, that of a foreign capture is its first pulse.
    pub origin: OriginKind,
    /// The start of the job in the capture plus the latency, ps of the capture.
    pub origin_ps: i64,
    /// Uncertainty of the capture's times, ns. It widens the bounds of times.
    pub slack_ns: f64,
    /// The times of the pulses of each axis against the plan; none if only the path was checked.
    pub times: Option<Vec<PulseTimesReport>>,
    /// The path that the pulses follow, and the pins.
    pub path: PathReport,
}

/// Checks a capture of a job, in constant memory.
#[derive(Debug)]
pub struct JobChecker<'a> {
    path: PathChecker<'a>,
    times: Option<PulseTimes<'a>>,
    origin: Origin,
    slack_ps: u64,
    /// The level of STEP of each axis.
    steps: Vec<bool>,
    first: Option<u64>,
}

impl<'a> JobChecker<'a> {
    /// A checker that has not seen any change. `legs` is the programmed path; `rows` are the
    /// segments of the plan, or `None` if only the path is checked. The origin of the setup is not
    /// used.
    pub fn new(
        mut setup: PathSetup<'a>,
        legs: Box<dyn Iterator<Item = PathLeg> + Send + 'a>,
        rows: Option<PlannedRows<'a>>,
        timebase: &Timebase,
        origin: Origin,
    ) -> Self {
        let known = match origin {
            Origin::Known { ps } | Origin::Fixed { ps } => Some(ps),
            Origin::Midpoint => None,
        };
        setup.origin_ps = known.map_or(0, |ps| u64::try_from(ps).unwrap_or(0));
        let slack_ps = setup.slack_ps;
        let names: Vec<&str> = setup.axes.iter().map(|axis| axis.name).collect();
        let steps = vec![false; names.len()];
        let times =
            rows.map(|rows| PulseTimes::new(rows, names.into_iter(), timebase, known, slack_ps));
        Self { path: PathChecker::new(setup, legs), times, origin, slack_ps, steps, first: None }
    }

    /// Ends the check and returns the report.
    pub fn finish(mut self) -> JobReport {
        let (kind, known) = match self.origin {
            Origin::Known { ps } => (OriginKind::Known, Some(ps)),
            Origin::Fixed { ps } => (OriginKind::Fixed, Some(ps)),
            Origin::Midpoint => (OriginKind::Midpoint, None),
        };
        let found = self.times.as_ref().and_then(PulseTimes::origin_ps);
        let first = self.first.map(|ps| i64::try_from(ps).unwrap_or(i64::MAX));
        let origin_ps = known.or(found).or(first).unwrap_or(0);
        if known.is_none() {
            // The first pulse of a foreign capture may seem to be before a start that is estimated.
            self.path.begin_at(u64::try_from(origin_ps).unwrap_or(0));
        }
        let times = self.times.map(PulseTimes::finish);
        let path = self.path.finish();
        let on_time = times.iter().flatten().all(|axis| axis.failures.is_empty());
        JobReport {
            passed: path.passed && on_time,
            origin: kind,
            origin_ps,
            slack_ns: self.slack_ps as f64 / 1e3,
            times,
            path,
        }
    }
}

impl PinSink for JobChecker<'_> {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        if let (Pin::Step, Some(step)) = (level.pin, self.steps.get_mut(usize::from(level.axis))) {
            *step = level.level;
        }
        self.path.initial(level)
    }

    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        let axis = usize::from(change.axis);
        if let (Pin::Step, Some(step)) = (change.pin, self.steps.get_mut(axis)) {
            let before = std::mem::replace(step, change.level);
            if change.level && !before {
                self.first.get_or_insert(change.ps);
                if let Some(times) = &mut self.times {
                    times.pulse(axis, change.ps);
                }
            }
        }
        self.path.change(change)
    }
}

impl fmt::Display for JobReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let origin = match self.origin {
            OriginKind::Known => "known",
            OriginKind::Midpoint => "found from the pulses",
            OriginKind::Fixed => "given",
        };
        writeln!(f, "the job starts at {} ps of the capture, {origin}", self.origin_ps)?;
        if let Some(times) = &self.times {
            let ns = |value: Option<f64>| value.map_or_else(|| "-".into(), |ns| format!("{ns:.1}"));
            let row = |axis: &PulseTimesReport| {
                let Self { path, .. } = self;
                let found = path.axes.iter().find(|one| one.axis == axis.axis);
                let found = found.map_or(0, |one| one.pulses);
                [
                    axis.axis.clone(),
                    format!("{found}/{}", axis.pulses_expected),
                    ns(axis.error_min_ns),
                    ns(axis.error_max_ns),
                    ns(Some(axis.error_bound_ns)),
                ]
            };
            let rows: Vec<_> = times.iter().map(row).collect();
            table(f, ["axis", "pulses", "e min", "e max", "bound"], &rows)?;
            writeln!(f, "e: edge less the time at which the plan makes it, ns")?;
        }
        write!(f, "{}", self.path)?;
        let failures = self.times.iter().flatten().flat_map(|axis| &axis.failures);
        failures.into_iter().try_for_each(|failure| writeln!(f, "FAILED {failure}"))
    }
}

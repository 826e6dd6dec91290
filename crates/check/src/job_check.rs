//! The check of a capture of a job: the path that the pulses follow, the places where outputs
//! change, and, against the plan, the times of both.

use crate::edge::{OutputPins, Pin, PinChange, PinSink};
use crate::error::TraceError;
use crate::origin::Origin;
use crate::output_places::OutputMarks;
use crate::output_times::OutputTimesReport;
use crate::path_check::{PathChecker, PathSetup};
use crate::path_leg::PathLeg;
use crate::path_report::PathReport;
use crate::pulse_times::{PlannedRows, PulseTimes, PulseTimesReport};
use crate::pwm_check::{PwmCheck, PwmReport, PwmTiming};
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
    /// The times of the changes of each output against the plan; none if only the path was checked.
    pub output_times: Option<Vec<OutputTimesReport>>,
    /// The outputs of the machine that the capture does not show, and that were not checked.
    pub outputs_not_checked: Vec<u8>,
    /// The pin of the PWM against the plan; none if only the path was checked, or if the machine or
    /// the capture has none.
    pub pwm: Option<PwmReport>,
    /// Whether the machine has a PWM that the capture does not show, and that was not checked.
    pub pwm_not_checked: bool,
    /// The path that the pulses follow, and the pins.
    pub path: PathReport,
}

/// The outputs of a machine, and how a capture of a job shows them.
pub struct JobOutputs<'a> {
    /// The outputs that the machine has.
    pub exist: OutputPins,
    /// The outputs that the capture shows.
    pub shown: OutputPins,
    /// The clocks of the PWM.
    pub divider: u32,
    /// Whether the counter of the PWM begins where the capture does: those by carrystep.
    pub is_own: bool,
    /// Where the program changes them.
    pub marks: OutputMarks<'a>,
}

impl fmt::Debug for JobOutputs<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { exist, shown, .. } = self;
        f.debug_struct("JobOutputs").field("exist", exist).field("shown", shown).finish()
    }
}

/// Checks a capture of a job, in constant memory.
#[derive(Debug)]
pub struct JobChecker<'a> {
    path: PathChecker<'a>,
    times: Option<PulseTimes<'a>>,
    origin: Origin,
    slack_ps: u64,
    not_checked: OutputPins,
    /// The level of STEP of each axis.
    steps: Vec<bool>,
    first: Option<u64>,
    /// The end of the capture, ps.
    end: u64,
}

impl<'a> JobChecker<'a> {
    /// A checker that has not seen any change. `legs` is the programmed path; `rows` is the plan,
    /// or `None` if only the path is checked. The origin of the setup is not used.
    pub fn new(
        mut setup: PathSetup<'a>,
        legs: Box<dyn Iterator<Item = PathLeg> + Send + 'a>,
        rows: Option<PlannedRows<'a>>,
        outputs: JobOutputs<'a>,
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
        let JobOutputs { exist, shown, divider, is_own, marks } = outputs;
        let not_checked =
            OutputPins { outputs: exist.outputs & !shown.outputs, pwm: exist.pwm && !shown.pwm };
        let zero = is_own.then_some(0);
        let pwm = PwmTiming { timebase: *timebase, divider };
        let pwm = (exist.pwm && shown.pwm).then(|| PwmCheck::new(pwm, zero, known, slack_ps));
        let shown = exist.outputs & shown.outputs;
        let times = rows.map(|rows| {
            let times =
                PulseTimes::new(rows, names.into_iter(), timebase, (known, slack_ps), shown);
            times.with_pwm(pwm)
        });
        let mut path = PathChecker::new(setup, legs);
        if shown != 0 {
            path = path.with_outputs(marks, shown);
        }
        Self { path, times, origin, slack_ps, not_checked, steps, first: None, end: 0 }
    }

    /// Ends the check and returns the report.
    pub fn finish(mut self) -> JobReport {
        let (kind, known) = match self.origin {
            Origin::Known { ps } => (OriginKind::Known, Some(ps)),
            Origin::Fixed { ps } => (OriginKind::Fixed, Some(ps)),
            Origin::Midpoint => (OriginKind::Midpoint, None),
        };
        let end = self.end;
        self.times.iter_mut().for_each(PulseTimes::end);
        let pwm = self.times.as_mut().and_then(|times| times.end_pwm(end));
        let found = self.times.as_ref().and_then(PulseTimes::origin_ps);
        let first = self.first.map(|ps| i64::try_from(ps).unwrap_or(i64::MAX));
        let origin_ps = known.or(found).or(first).unwrap_or(0);
        if known.is_none() {
            // The first pulse of a foreign capture may seem to be before a start that is estimated.
            self.path.begin_at(u64::try_from(origin_ps).unwrap_or(0));
        }
        let (times, output_times) = self.times.map(PulseTimes::finish).unzip();
        let path = self.path.finish();
        let of_axes = times.iter().flatten().map(|axis| &axis.failures);
        let of_outputs = output_times.iter().flatten().map(|output| &output.failures);
        let not_checked = self.not_checked;
        JobReport {
            passed: path.passed
                && of_axes.chain(of_outputs).all(Vec::is_empty)
                && pwm.as_ref().is_none_or(|pwm| pwm.passed),
            origin: kind,
            origin_ps,
            slack_ns: self.slack_ps as f64 / 1e3,
            times,
            output_times,
            outputs_not_checked: (0..8)
                .filter(|number| not_checked.outputs >> number & 1 == 1)
                .collect(),
            pwm,
            pwm_not_checked: not_checked.pwm,
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

    fn outputs(&mut self, ps: u64, levels: u8) -> Result<(), TraceError> {
        if let Some(times) = &mut self.times {
            times.levels(ps, levels);
        }
        self.path.outputs(ps, levels)
    }

    fn pwm(&mut self, ps: u64, level: bool) -> Result<(), TraceError> {
        self.times.iter_mut().for_each(|times| times.pwm(ps, level));
        Ok(())
    }

    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        self.end = ps;
        self.path.end(ps)
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
        let ns = |value: Option<f64>| value.map_or_else(|| "-".into(), |ns| format!("{ns:.1}"));
        if let Some(times) = &self.times {
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
        if let Some(outputs) = self.output_times.as_ref().filter(|all| !all.is_empty()) {
            let row = |one: &OutputTimesReport| {
                [
                    one.output.to_string(),
                    format!("{}/{}", one.changes_found, one.changes_expected),
                    ns(one.error_min_ns),
                    ns(one.error_max_ns),
                    ns(Some(one.error_bound_ns)),
                ]
            };
            let rows: Vec<_> = outputs.iter().map(row).collect();
            table(f, ["output", "changes", "e min", "e max", "bound"], &rows)?;
        }
        if !self.outputs_not_checked.is_empty() {
            let numbers: Vec<_> = self.outputs_not_checked.iter().map(u8::to_string).collect();
            writeln!(
                f,
                "not checked: output {}; the capture does not show it",
                numbers.join(", ")
            )?;
        }
        if self.pwm_not_checked {
            writeln!(f, "not checked: the PWM; the capture does not show it")?;
        }
        self.pwm.iter().try_for_each(|pwm| write!(f, "{pwm}"))?;
        write!(f, "{}", self.path)?;
        let of_axes = self.times.iter().flatten().flat_map(|axis| &axis.failures);
        let of_outputs = self.output_times.iter().flatten().flat_map(|output| &output.failures);
        let failures = of_axes.chain(of_outputs);
        failures.into_iter().try_for_each(|failure| writeln!(f, "FAILED {failure}"))
    }
}

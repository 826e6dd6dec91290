//! Compares the time of each pulse of a job, and of each change of an output, with the plan.
//!
//! The k-th pulse of an axis belongs to the k-th pulse that the plan's integers make. The plan is
//! read as far as the capture has come, and a little further; its memory is bounded also where an
//! axis makes no pulses, or pulses that are not due.

use crate::due_pulses::AxisDue;
use crate::due_times::{DueTimes, Judged};
use crate::ideal::tick_ps;
use crate::output_times::{OutputTimes, OutputTimesReport};
use crate::pwm_check::{PwmCheck, PwmReport};
use carrystep_core::{OutputChange, Segment, Timebase};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// How far the plan is read beyond the time of a pulse, ps.
const AHEAD_PS: i64 = 100_000_000_000;
/// Additional tolerance for rounding to ps, as for moves, ps.
const ROUNDING_PS: f64 = 2000.0;

/// A row of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRow {
    /// The segments of all axes, for the same ticks.
    pub segments: Vec<Segment>,
    /// What changes at the outputs where the row begins.
    pub outputs: OutputChange,
}

/// A plan, row by row.
pub type PlannedRows<'a> = Box<dyn Iterator<Item = PlannedRow> + Send + 'a>;

/// The times of the pulses of one axis against the plan.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct PulseTimesReport {
    /// The name of the axis.
    pub axis: String,
    /// Number of pulses that the plan makes.
    pub pulses_expected: u64,
    /// Least error e = edge - due time, ns; negative is early.
    pub error_min_ns: Option<f64>,
    /// Greatest error e, ns.
    pub error_max_ns: Option<f64>,
    /// The bound of |e|, ns: one phase h/Q + 2 ns + slack.
    pub error_bound_ns: f64,
    /// What is wrong.
    pub failures: Vec<String>,
}

struct Axis {
    name: String,
    due: AxisDue,
    times: DueTimes,
}

/// Compares times of pulses and of changes of outputs with a plan.
pub(crate) struct PulseTimes<'a> {
    rows: PlannedRows<'a>,
    tick_ps: i64,
    phase_ps: f64,
    slack_ps: f64,
    /// Time of the plan that has been read, ps from its start.
    read_to: i64,
    axes: Vec<Axis>,
    outputs: OutputTimes,
    pwm: Option<PwmCheck>,
    /// The start of the plan, ps of the capture: known, or estimated from the first pulse.
    base: Option<i64>,
    is_sure: bool,
}

impl fmt::Debug for PulseTimes<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PulseTimes").field("base", &self.base).finish_non_exhaustive()
    }
}

impl<'a> PulseTimes<'a> {
    /// The plan starts at `base`, ps of the capture, or, without it, where its first pulse says. Of
    /// the outputs, those of the mask `outputs` are compared.
    pub fn new<'n>(
        rows: PlannedRows<'a>,
        names: impl Iterator<Item = &'n str>,
        timebase: &Timebase,
        (base, slack_ps): (Option<i64>, u64),
        outputs: u8,
    ) -> Self {
        let axis = |name: &str| Axis {
            name: name.to_owned(),
            due: AxisDue::default(),
            times: DueTimes::default(),
        };
        let tick_ps = tick_ps(timebase).cast_signed();
        Self {
            rows,
            tick_ps,
            phase_ps: tick_ps as f64 / f64::from(timebase.phases()),
            slack_ps: slack_ps as f64,
            read_to: 0,
            axes: names.map(axis).collect(),
            outputs: OutputTimes::new(outputs),
            pwm: None,
            base,
            is_sure: base.is_some(),
        }
    }

    /// The same with a check of the PWM.
    pub fn with_pwm(self, pwm: Option<PwmCheck>) -> Self {
        Self { pwm, ..self }
    }

    /// Reads the next row of the plan; false at its end.
    fn read(&mut self) -> bool {
        let Some(row) = self.rows.next() else { return false };
        self.outputs.plan(row.outputs, self.read_to);
        if let (Some(pwm), Some(duty)) = (&mut self.pwm, row.outputs.duty) {
            pwm.due(self.read_to, duty);
        }
        let mut ticks = 0;
        for (axis, segment) in self.axes.iter_mut().zip(&row.segments) {
            let Axis { due, times, .. } = axis;
            due.pass(segment, |pulse| {
                let within = (pulse.part * self.tick_ps as f64).round() as i64;
                times.due(self.read_to + i64::from(pulse.tick) * self.tick_ps + within);
            });
            ticks = segment.ticks;
        }
        self.read_to += i64::from(ticks) * self.tick_ps;
        true
    }

    /// Reads the plan beyond a time of the capture.
    fn read_beyond(&mut self, ps: u64, base: i64) {
        let now = i64::try_from(ps).unwrap_or(i64::MAX);
        while self.read_to < now - base + AHEAD_PS && self.read() {}
    }

    /// An axis makes a pulse.
    pub fn pulse(&mut self, number: usize, ps: u64) {
        let base = match self.base {
            Some(base) => base,
            None => {
                let first = |axes: &[Axis]| axes.iter().filter_map(|axis| axis.times.first()).min();
                while first(&self.axes).is_none() && self.read() {}
                let now = i64::try_from(ps).unwrap_or(i64::MAX);
                let base = now - first(&self.axes).unwrap_or(0);
                self.base = Some(base);
                self.read_beyond(ps, base);
                self.outputs.begin(base);
                self.pwm.iter_mut().for_each(|pwm| pwm.begin(base));
                base
            }
        };
        self.read_beyond(ps, base);
        if let Some(axis) = self.axes.get_mut(number) {
            axis.times.comes(ps, base);
        }
    }

    /// The outputs have these levels from `ps` on.
    pub fn levels(&mut self, ps: u64, levels: u8) {
        if let Some(base) = self.base {
            self.read_beyond(ps, base);
        }
        self.outputs.levels(ps, levels, self.base);
    }

    /// The pin of the PWM has this level from `ps` on.
    pub fn pwm(&mut self, ps: u64, level: bool) {
        if let Some(base) = self.base {
            self.read_beyond(ps, base);
        }
        self.pwm.iter_mut().for_each(|pwm| pwm.pin(ps, level));
    }

    /// The report of the PWM, after the end of the capture at `ps`.
    pub fn end_pwm(&mut self, ps: u64) -> Option<PwmReport> {
        Some(self.pwm.as_mut()?.end(ps))
    }

    /// The start of the plan, ps of the capture. Where it was only estimated, it is the one with
    /// which the least and the greatest error of all pulses together are equally far from zero;
    /// without pulses, those of all changes of outputs.
    pub fn origin_ps(&self) -> Option<i64> {
        let base = self.base?;
        Some(base + if self.is_sure { 0 } else { self.middle() })
    }

    /// The middle of the least and the greatest error.
    fn middle(&self) -> i64 {
        let middle = |errors: &[[i64; 2]]| {
            let least = errors.iter().map(|[least, _]| *least).min();
            let greatest = errors.iter().map(|[_, greatest]| *greatest).max();
            least.zip(greatest).map(|(least, greatest)| least.midpoint(greatest))
        };
        let pulses: Vec<_> = self.axes.iter().filter_map(|axis| axis.times.errors()).collect();
        let changes: Vec<_> = self.outputs.errors().collect();
        middle(&pulses).or_else(|| middle(&changes)).unwrap_or(0)
    }

    /// The capture has ended. What is not known of the origin is estimated.
    pub fn end(&mut self) {
        while self.read() {}
        if self.base.is_none()
            && let Some(base) = self.outputs.base()
        {
            self.base = Some(base);
            self.outputs.begin(base);
            self.pwm.iter_mut().for_each(|pwm| pwm.begin(base));
        }
    }

    /// The reports of the axes and of the outputs, after the end.
    pub fn finish(self) -> (Vec<PulseTimesReport>, Vec<OutputTimesReport>) {
        let shift = if self.is_sure { 0 } else { self.middle() };
        let origin = self.origin_ps().unwrap_or(0);
        let exact = ROUNDING_PS + self.slack_ps;
        let bound = self.phase_ps + exact;
        let judged = Judged { shift, origin, bound };
        let report = |Axis { name, times, .. }: Axis| {
            let failures = times.failures(&format!("axis {name}"), "pulse", judged);
            let errors = times.errors();
            let ns = |at: usize| errors.map(|errors| (errors[at] - shift) as f64 / 1e3);
            PulseTimesReport {
                pulses_expected: times.expected,
                error_min_ns: ns(0),
                error_max_ns: ns(1),
                error_bound_ns: bound / 1e3,
                axis: name,
                failures,
            }
        };
        // An output changes at the beginning of a tick, and not at a phase before its time.
        let of_outputs = Judged { bound: if self.is_sure { exact } else { bound }, ..judged };
        let outputs = self.outputs.finish(of_outputs);
        (self.axes.into_iter().map(report).collect(), outputs)
    }
}

//! Compares the time of each pulse of a job with the plan.
//!
//! The k-th pulse of an axis belongs to the k-th pulse that the plan's integers make. The plan is
//! read as far as the capture has come, and a little further; its memory is bounded also where an
//! axis makes no pulses, or pulses that are not due.

use crate::due_pulses::AxisDue;
use crate::ideal::tick_ps;
use carrystep_core::{Segment, Timebase};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::VecDeque;
use std::fmt;

/// How far the plan is read beyond the time of a pulse, ps.
const AHEAD_PS: i64 = 100_000_000_000;
/// Most pulses of an axis that wait for the capture.
const WAITING: usize = 1 << 18;
/// Additional tolerance for rounding to ps, as for moves, ps.
const ROUNDING_PS: f64 = 2000.0;

/// The segments of all axes for the same ticks, row by row.
pub type PlannedRows<'a> = Box<dyn Iterator<Item = Vec<Segment>> + Send + 'a>;

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

/// The error of a pulse.
#[derive(Debug, Clone, Copy)]
struct ErrorAt {
    ps: i64,
    number: u64,
    /// When the pulse came, ps of the capture.
    at: u64,
}

struct Axis {
    name: String,
    due: AxisDue,
    /// Times at which pulses are due, ps from the start of the plan.
    waiting: VecDeque<i64>,
    /// Pulses of the plan so far, and of the capture.
    expected: u64,
    found: u64,
    /// Pulses that were not due, and the first of them, ps of the capture.
    surplus: u64,
    first_surplus: Option<u64>,
    /// The pulses that wait are too many: they do not come.
    gone: bool,
    least: Option<ErrorAt>,
    greatest: Option<ErrorAt>,
}

/// Compares times of pulses with a plan.
pub(crate) struct PulseTimes<'a> {
    rows: PlannedRows<'a>,
    tick_ps: i64,
    phase_ps: f64,
    slack_ps: f64,
    /// Time of the plan that has been read, ps from its start.
    read_to: i64,
    axes: Vec<Axis>,
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
    /// The plan starts at `base`, ps of the capture, or, without it, where its first pulse says.
    pub fn new<'n>(
        rows: PlannedRows<'a>,
        names: impl Iterator<Item = &'n str>,
        timebase: &Timebase,
        base: Option<i64>,
        slack_ps: u64,
    ) -> Self {
        let axis = |name: &str| Axis {
            name: name.to_owned(),
            due: AxisDue::default(),
            waiting: VecDeque::new(),
            expected: 0,
            found: 0,
            surplus: 0,
            first_surplus: None,
            gone: false,
            least: None,
            greatest: None,
        };
        let tick_ps = tick_ps(timebase).cast_signed();
        Self {
            rows,
            tick_ps,
            phase_ps: tick_ps as f64 / f64::from(timebase.phases()),
            slack_ps: slack_ps as f64,
            read_to: 0,
            axes: names.map(axis).collect(),
            base,
            is_sure: base.is_some(),
        }
    }

    /// Reads the next row of the plan; false at its end.
    fn read(&mut self) -> bool {
        let Some(row) = self.rows.next() else { return false };
        let mut ticks = 0;
        for (axis, segment) in self.axes.iter_mut().zip(&row) {
            let Axis { due, waiting, expected, gone, .. } = axis;
            due.pass(segment, |pulse| {
                *expected += 1;
                let within = (pulse.part * self.tick_ps as f64).round() as i64;
                if !*gone {
                    waiting.push_back(self.read_to + i64::from(pulse.tick) * self.tick_ps + within);
                }
            });
            if waiting.len() > WAITING {
                waiting.clear();
                *gone = true;
            }
            ticks = segment.ticks;
        }
        self.read_to += i64::from(ticks) * self.tick_ps;
        true
    }

    /// An axis makes a pulse.
    pub fn pulse(&mut self, number: usize, ps: u64) {
        let now = i64::try_from(ps).unwrap_or(i64::MAX);
        let base = match self.base {
            Some(base) => base,
            None => {
                let first =
                    |axes: &[Axis]| axes.iter().filter_map(|a| a.waiting.front()).min().copied();
                while first(&self.axes).is_none() && self.read() {}
                let base = now - first(&self.axes).unwrap_or(0);
                self.base = Some(base);
                base
            }
        };
        while self.read_to < now - base + AHEAD_PS && self.read() {}
        let Some(axis) = self.axes.get_mut(number) else { return };
        axis.found += 1;
        if axis.gone {
            return;
        }
        let Some(due) = axis.waiting.pop_front() else {
            axis.surplus += 1;
            axis.first_surplus.get_or_insert(ps);
            return;
        };
        let error = ErrorAt { ps: now - base - due, number: axis.found, at: ps };
        if axis.least.is_none_or(|least| error.ps < least.ps) {
            axis.least = Some(error);
        }
        if axis.greatest.is_none_or(|greatest| error.ps > greatest.ps) {
            axis.greatest = Some(error);
        }
    }

    /// The start of the plan, ps of the capture. Where it was only estimated, it is the one with
    /// which the least and the greatest error of all axes together are equally far from zero.
    pub fn origin_ps(&self) -> Option<i64> {
        let base = self.base?;
        Some(base + if self.is_sure { 0 } else { self.middle() })
    }

    /// The middle of the least and the greatest error of all axes.
    fn middle(&self) -> i64 {
        let least = self.axes.iter().filter_map(|axis| axis.least).map(|e| e.ps).min();
        let greatest = self.axes.iter().filter_map(|axis| axis.greatest).map(|e| e.ps).max();
        least.zip(greatest).map_or(0, |(least, greatest)| least.midpoint(greatest))
    }

    /// The capture has ended.
    pub fn finish(mut self) -> Vec<PulseTimesReport> {
        while self.read() {}
        let shift = if self.is_sure { 0 } else { self.middle() };
        let origin = self.origin_ps().unwrap_or(0);
        let bound = self.phase_ps + ROUNDING_PS + self.slack_ps;
        let report = |axis: Axis| {
            let mut failures = Vec::new();
            let seconds = |ps: u64| (i128::from(ps) - i128::from(origin)) as f64 / 1e12;
            let Axis { name, expected, found, surplus, first_surplus, .. } = &axis;
            if found != expected {
                failures.push(format!("axis {name}: {found} pulses, the plan makes {expected}"));
            }
            if axis.gone {
                failures.push(format!(
                    "axis {name}: its pulses do not come; their times are not compared"
                ));
            }
            if let Some(first) = first_surplus {
                failures.push(format!(
                    "axis {name}: {surplus} pulses are not due, the first at {:.9} s",
                    seconds(*first)
                ));
            }
            let errors = [(axis.least, "early"), (axis.greatest, "late")];
            for (error, way) in errors {
                let Some(error) = error else { continue };
                let off = (error.ps - shift) as f64;
                if off.abs() > bound && (off < 0.0) == (way == "early") {
                    failures.push(format!(
                        "axis {name}: pulse {} at {:.9} s is {:.1} ns {way}, the bound is {:.1} ns",
                        error.number,
                        seconds(error.at),
                        off.abs() / 1e3,
                        bound / 1e3
                    ));
                }
            }
            let ns = |error: Option<ErrorAt>| error.map(|e| (e.ps - shift) as f64 / 1e3);
            PulseTimesReport {
                pulses_expected: *expected,
                error_min_ns: ns(axis.least),
                error_max_ns: ns(axis.greatest),
                error_bound_ns: bound / 1e3,
                axis: axis.name,
                failures,
            }
        };
        self.axes.into_iter().map(report).collect()
    }
}

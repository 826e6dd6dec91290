//! The checker of pulse trains. It judges the pin edges only by the float profile and by what
//! [`Setup`] requires (clock and tick, start phase, pin timing of the drivers, straight lines). It
//! knows nothing of the plan's segments.
//!
//! For the k-th rising edge of STEP of an axis, e = m - t, where m is the time of the edge minus
//! the origin, and t the time at which the profile crosses the k-th step. A pulse with e > 0 is
//! late, one with e < 0 early. The capture is judged as a stream, in constant memory. A missing or
//! extra pulse is reported where it occurs, and the pulses after it are still compared with the
//! crossings to which they belong.

use crate::axis_check::{AxisCheck, AxisSetup};
use crate::edge::{PinChange, PinSink};
use crate::error::TraceError;
use crate::ideal::{NS, PS, phase_ps};
use crate::line_check::LinesCheck;
use crate::origin::{Origin, RunningOrigin};
use crate::report::{CheckReport, OriginKind};
use carrystep_core::{StartPhase, Timebase};
use carrystep_profile::{Course, Reader};
use std::fmt;

mod part;

pub use part::Part;

/// The values against which a capture is checked.
#[derive(Debug, Clone)]
pub struct Setup<'a> {
    /// Clock, tick and phases of the gateware.
    pub timebase: Timebase,
    /// The position in a step at which the moves start.
    pub phase: StartPhase,
    /// The axes, in the order of their numbers.
    pub axes: Vec<AxisSetup<'a>>,
    /// The courses of all moves; `None` if the axes do not keep to a line in any of them.
    pub courses: Option<Reader<Course>>,
    /// The time from which times are counted.
    pub origin: Origin,
    /// Uncertainty of the capture's times, ps: the sample period of a logic analyser, or 0 for a
    /// simulator.
    pub slack_ps: u64,
}

/// Checks a capture from a stream of pin changes.
pub struct Checker<'a> {
    pub(crate) axes: Vec<AxisCheck<'a>>,
    pub(crate) lines: Option<LinesCheck>,
    pub(crate) origin: RunningOrigin,
    pub(crate) slack_ps: u64,
    pub(crate) phase_ns: f64,
}

impl fmt::Debug for Checker<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Checker").field("origin", &self.origin).finish_non_exhaustive()
    }
}

impl<'a> Checker<'a> {
    /// A checker that has not seen any change.
    pub fn new(setup: Setup<'a>) -> Self {
        let Setup { timebase, phase, axes, courses, origin, slack_ps } = setup;
        let lines = courses.map(|courses| LinesCheck::new(courses, phase, axes.len()));
        let axes =
            axes.into_iter().map(|axis| AxisCheck::new(axis, phase, timebase, slack_ps)).collect();
        Self {
            axes,
            lines,
            origin: RunningOrigin::new(origin),
            slack_ps,
            phase_ns: phase_ps(&timebase) / NS,
        }
    }

    /// Ends the check and returns the report.
    pub fn finish(self) -> CheckReport {
        let (base, kind) = (self.origin.base().ps, self.origin.kind());
        let shift = if kind == OriginKind::Midpoint { midpoint(&self.axes) } else { 0 };
        // The greatest bound of all axes for e, in seconds. `LinesCheck::off` allows each axis the
        // distance that it travels in this time; `finish` makes the result a part of the axis'
        // `passed`.
        let late = self.axes.iter().map(AxisCheck::bound_ps).fold(0.0, f64::max) / PS;
        let off = |axis| self.lines.as_ref()?.off(axis, late);
        let offs: Vec<_> = (0..self.axes.len()).map(off).collect();
        // The moves behind the end of the capture are not read for the lines.
        drop(self.lines);
        let axes = self.axes.into_iter().zip(offs);
        let axes: Vec<_> = axes.map(|(axis, off)| axis.finish(base, shift, off)).collect();
        CheckReport {
            passed: axes.iter().all(|axis| axis.passed),
            origin: kind,
            origin_ps: base.saturating_add(shift),
            slack_ns: self.slack_ps as f64 / NS,
            phase_ns: self.phase_ns,
            axes,
        }
    }
}

/// The midpoint of the least and the greatest lateness over all axes, in whole ps.
fn midpoint(axes: &[AxisCheck<'_>]) -> i64 {
    let ranges = axes.iter().filter_map(AxisCheck::range_ps);
    let whole = ranges.reduce(|(a, b), (c, d)| (a.min(c), b.max(d)));
    whole.map_or(0, |(least, greatest)| f64::midpoint(least, greatest).round() as i64)
}

impl PinSink for Checker<'_> {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        if let Some(axis) = self.axes.get_mut(usize::from(level.axis)) {
            axis.initial(level.pin, level.level);
        }
        if let Some(lines) = &mut self.lines {
            lines.initial(level);
        }
        Ok(())
    }

    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        self.origin.estimate(change, |axis| self.axes.get(axis)?.first());
        if let Some(axis) = self.axes.get_mut(usize::from(change.axis)) {
            axis.change(change, self.origin.base());
        }
        if let Some(lines) = &mut self.lines {
            lines.change(change);
        }
        Ok(())
    }
}

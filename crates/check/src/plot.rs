//! Draws speed and error of every axis against time, as an SVG.
//!
//! This file collects the points, `plot/profile_line.rs` those of the profile; `plot/draw.rs` draws
//! them.

use crate::edge::{PinChange, PinSink};
use crate::error::TraceError;
use crate::follow::Follower;
use crate::ideal::{PS, tick_ps};
use crate::report::CheckReport;
use crate::thin::Thin;
use carrystep_core::{StartPhase, Timebase};
use carrystep_profile::Timeline;
use std::fmt;

mod draw;
mod profile_line;

use profile_line::ProfileLine;

/// Number of stretches of time to which the pulses are thinned out. Each keeps two points.
const STRETCHES: usize = 400;

/// The values that the plot shows beside the pulses.
#[derive(Debug, Clone)]
pub struct PlotSetup<'a> {
    /// The heading.
    pub title: &'a str,
    /// Clock, tick and phases of the gateware.
    pub timebase: Timebase,
    /// The position in a step at which the moves start.
    pub phase: StartPhase,
    /// The load of the first move plus the latency L, ps of the capture.
    pub origin_ps: i64,
    /// Length of all moves together, ticks.
    pub total_ticks: u64,
    /// The axes, in the order of their numbers.
    pub axes: Vec<PlotAxis<'a>>,
}

/// One axis of a plot.
#[derive(Debug, Clone)]
pub struct PlotAxis<'a> {
    /// The name of the axis.
    pub name: &'a str,
    /// The float profile, which is drawn as a line.
    pub timeline: Timeline,
}

/// Collects and thins out the points of the picture from a stream of pin changes.
pub struct Plot<'a> {
    title: &'a str,
    origin_ps: i64,
    tick_ps: u64,
    span_s: f64,
    axes: Vec<Curves<'a>>,
}

/// The curves of one axis.
struct Curves<'a> {
    name: &'a str,
    follower: Follower,
    /// The speed of the profile.
    line: ProfileLine,
    /// Signed speed of each period, steps/s, at the middle of the period.
    speed: Thin,
    /// Error of each pulse, ns.
    error: Thin,
}

impl fmt::Debug for Plot<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Plot")
            .field("title", &self.title)
            .field("span_s", &self.span_s)
            .finish_non_exhaustive()
    }
}

impl<'a> Plot<'a> {
    /// A plot that has not seen any pulse.
    pub fn new(setup: PlotSetup<'a>) -> Self {
        let PlotSetup { title, timebase, phase, origin_ps, total_ticks, axes } = setup;
        let tick_ps = tick_ps(&timebase);
        let span_s = total_ticks as f64 * tick_ps as f64 / PS;
        let curves = |axis: PlotAxis<'a>| Curves {
            name: axis.name,
            line: ProfileLine::new(&axis.timeline, tick_ps as f64 / PS, span_s),
            follower: Follower::new(&axis.timeline, phase, &timebase, origin_ps),
            speed: Thin::new(span_s, STRETCHES),
            error: Thin::new(span_s, STRETCHES),
        };
        let axes = axes.into_iter().map(curves).collect();
        Self { title, origin_ps, tick_ps, span_s, axes }
    }

    /// Draws the picture. The bounds come from the report of the same capture.
    ///
    /// # Errors
    /// [`TraceError::Plot`] if the drawing library fails.
    pub fn svg(mut self, report: &CheckReport) -> Result<String, TraceError> {
        self.axes.iter_mut().for_each(|axis| axis.line.reach(u64::MAX));
        draw::svg(&self, report)
    }
}

impl PinSink for Plot<'_> {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        if let Some(axis) = self.axes.get_mut(usize::from(level.axis)) {
            axis.follower.initial(level.pin, level.level);
        }
        Ok(())
    }

    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        let Some(axis) = self.axes.get_mut(usize::from(change.axis)) else { return Ok(()) };
        let since = i128::from(change.ps) - i128::from(self.origin_ps);
        axis.line.reach(u64::try_from(since).unwrap_or(0) / self.tick_ps);
        if let Some(pulse) = axis.follower.change(change) {
            let time = (i128::from(pulse.ps) - i128::from(self.origin_ps)) as f64 / PS;
            if let (Some(speed), Some(period)) = (pulse.speed(), pulse.period_ps) {
                axis.speed.add((time - period as f64 / PS / 2.0, speed));
            }
            if let Some(error) = pulse.error_ns {
                axis.error.add((time, error));
            }
        }
        Ok(())
    }
}

//! Speed and error of every axis against time, as an SVG.

use crate::edge::{PinChange, PinSink};
use crate::error::TraceError;
use crate::follow::Follower;
use crate::ideal::{PS, tick_ps};
use crate::report::Report;
use crate::thin::Thin;
use carrystep_core::{StartPhase, Timebase};
use carrystep_profile::Timeline;
use std::fmt;

mod draw;

/// Stretches that pulses are thinned out to; each keeps two points.
const STRETCHES: usize = 400;

/// What is drawn, beside the pulses.
#[derive(Debug, Clone)]
pub struct PlotSetup<'a> {
    /// The heading.
    pub title: &'a str,
    /// Clock, tick and phases of the gateware.
    pub timebase: Timebase,
    /// Where in a step the moves start.
    pub phase: StartPhase,
    /// The load of the first move plus the latency L, in ps of the capture.
    pub origin_ps: i64,
    /// Length of all moves together.
    pub total_ticks: u64,
    /// The axes, in the order of their numbers.
    pub axes: Vec<PlotAxis<'a>>,
}

/// One axis of a plot.
#[derive(Debug, Clone, Copy)]
pub struct PlotAxis<'a> {
    /// Its name.
    pub name: &'a str,
    /// The float profile, drawn as a line.
    pub timeline: &'a Timeline,
}

/// Collects what the picture shows, thinned out, as pin changes stream by.
pub struct Plot<'a> {
    title: &'a str,
    origin_ps: i64,
    tick_seconds: f64,
    span_s: f64,
    axes: Vec<Curves<'a>>,
}

/// The curves of one axis.
struct Curves<'a> {
    axis: PlotAxis<'a>,
    follower: Follower<'a>,
    /// Steps/s, signed, in the middle of each period.
    speed: Thin,
    /// ns at each pulse.
    error: Thin,
}

impl fmt::Debug for Plot<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Plot").field("title", &self.title).field("span_s", &self.span_s).finish_non_exhaustive()
    }
}

impl<'a> Plot<'a> {
    /// A plot that has seen no pulse yet.
    pub fn new(setup: PlotSetup<'a>) -> Self {
        let PlotSetup { title, timebase, phase, origin_ps, total_ticks, axes } = setup;
        let span_s = total_ticks as f64 * tick_ps(&timebase) as f64 / PS;
        let curves = |axis: PlotAxis<'a>| Curves {
            axis,
            follower: Follower::new(axis.timeline, phase, &timebase, origin_ps),
            speed: Thin::new(span_s, STRETCHES),
            error: Thin::new(span_s, STRETCHES),
        };
        let axes = axes.into_iter().map(curves).collect();
        Self { title, origin_ps, tick_seconds: timebase.tick_seconds(), span_s, axes }
    }

    /// The picture; the bounds come from the report of the same capture.
    ///
    /// # Errors
    /// The drawing library fails.
    pub fn svg(&self, report: &Report) -> Result<String, TraceError> {
        draw::svg(self, report)
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

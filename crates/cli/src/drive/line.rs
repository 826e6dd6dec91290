//! The progress line of a run.

use super::Itinerary;
use carrystep_link::Status;
use carrystep_runner::OverrideSetting;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::{Duration, Instant};

/// The progress line on a terminal: which part of the planned motion is over, the time that is
/// left, overrides, and the positions of the axes in steps. Waits of the program do not count.
pub(super) struct Line<'a> {
    bar: ProgressBar,
    axes: &'a [String],
    planned: Duration,
    /// Planned motion that is over.
    moved: Duration,
    /// When the motion of the present stretch was last looked at.
    seen: Option<Instant>,
    /// The overrides of late, and the planned seconds and seconds since they are in force.
    pace: (OverrideSetting, f64, f64),
}

/// Motion after which the rate of before says how fast the rest goes, s.
const SETTLED: f64 = 5.0;

impl<'a> Line<'a> {
    pub(super) fn new(axes: &'a [String], seconds: f64) -> Self {
        // The bar hides itself if standard error is not a terminal.
        let planned = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        let bar = ProgressBar::with_draw_target(
            Some(milliseconds(planned)),
            ProgressDrawTarget::stderr_with_hz(10),
        );
        let style = ProgressStyle::with_template("{bar:20} {percent:>3} % {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self {
            bar,
            axes,
            planned,
            moved: Duration::ZERO,
            seen: None,
            pace: (OverrideSetting::NONE, 0.0, 0.0),
        }
    }

    pub(super) fn show(&mut self, status: &Status, itinerary: &dyn Itinerary) {
        if status.answer.idle && self.seen.is_none() {
            return;
        }
        let now = Instant::now();
        let since = now - self.seen.replace(now).unwrap_or(now);
        let (overrides, rate) = (itinerary.overrides(), itinerary.rate());
        let planned = since.mul_f64(rate.clamp(0.0, 10.0));
        self.moved = self.moved.saturating_add(planned).min(self.planned);
        if self.pace.0 != overrides {
            self.pace = (overrides, 0.0, 0.0);
        }
        self.pace.1 += planned.as_secs_f64();
        self.pace.2 += since.as_secs_f64();
        if self.bar.is_hidden() {
            return;
        }
        let left = self.planned.saturating_sub(self.moved);
        let left = (left.as_secs_f64() / self.rate(rate)) as u64;
        let places =
            self.axes.iter().zip(status.positions).map(|(axis, steps)| format!("{axis} {steps}"));
        let places = places.collect::<Vec<_>>().join("  ");
        let (hours, minutes, seconds) = (left / 3600, left / 60 % 60, left % 60);
        let over = if overrides == OverrideSetting::NONE {
            String::new()
        } else {
            format!("  {overrides}")
        };
        self.bar.set_message(format!("{hours}:{minutes:02}:{seconds:02} left{over}  {places}"));
        self.bar.set_position(milliseconds(self.moved));
    }

    /// Planned seconds that will pass in a second: as since the overrides are in force, once this
    /// has been seen for a while.
    fn rate(&self, now: f64) -> f64 {
        match self.pace {
            (OverrideSetting::NONE, ..) => 1.0,
            (_, planned, real) if real > SETTLED && planned > 0.0 => planned / real,
            _ => now.max(0.05),
        }
    }

    /// The machine rests: its time stands still until it moves again.
    pub(super) fn rests(&mut self) {
        self.seen = None;
    }

    /// From now on, the motion that is left lasts this long. Returns the time of all motion, s.
    pub(super) fn plans(&mut self, seconds: f64) -> f64 {
        let left = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        self.planned = self.moved.saturating_add(left);
        self.bar.set_length(milliseconds(self.planned));
        self.planned.as_secs_f64()
    }

    /// Writes something that stays above the line.
    pub(super) fn above(&self, write: impl FnOnce()) {
        self.bar.suspend(write);
    }
}

fn milliseconds(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}

impl Drop for Line<'_> {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

//! The progress line of a run.

use carrystep_link::Status;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::{Duration, Instant};

/// The progress line on a terminal: which part of the planned motion is over, the time that is
/// left, and the positions of the axes in steps. Waits of the program do not count.
pub(super) struct Line<'a> {
    bar: ProgressBar,
    axes: &'a [String],
    planned: Duration,
    /// Motion of earlier stretches.
    before: Duration,
    /// When the motion of the present stretch was first seen.
    begun: Option<Instant>,
}

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
        Self { bar, axes, planned, before: Duration::ZERO, begun: None }
    }

    pub(super) fn show(&mut self, status: &Status) {
        if status.answer.idle && self.begun.is_none() {
            return;
        }
        self.begun.get_or_insert_with(Instant::now);
        if self.bar.is_hidden() {
            return;
        }
        let moved = self.moved();
        let left = self.planned.saturating_sub(moved).as_secs();
        let places =
            self.axes.iter().zip(status.positions).map(|(axis, steps)| format!("{axis} {steps}"));
        let places = places.collect::<Vec<_>>().join("  ");
        let (hours, minutes, seconds) = (left / 3600, left / 60 % 60, left % 60);
        self.bar.set_message(format!("{hours}:{minutes:02}:{seconds:02} left  {places}"));
        self.bar.set_position(milliseconds(moved));
    }

    /// The machine rests: its time stands still until it moves again.
    pub(super) fn rests(&mut self) {
        self.before = self.moved();
        self.begun = None;
    }

    /// From now on, the motion that is left lasts this long. Returns the time of all motion, s.
    pub(super) fn plans(&mut self, seconds: f64) -> f64 {
        let left = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        self.planned = self.moved().saturating_add(left);
        self.bar.set_length(milliseconds(self.planned));
        self.planned.as_secs_f64()
    }

    /// Writes something that stays above the line.
    pub(super) fn above(&self, write: impl FnOnce()) {
        self.bar.suspend(write);
    }

    fn moved(&self) -> Duration {
        (self.before + self.begun.map_or(Duration::ZERO, |begun| begun.elapsed())).min(self.planned)
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

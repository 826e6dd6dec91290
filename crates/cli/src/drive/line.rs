//! The progress line of a run.

use carrystep_link::Status;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Instant;

/// The progress line on a terminal: elapsed part of the planned time, and the positions of the axes
/// in steps.
pub(super) struct Line<'a> {
    bar: ProgressBar,
    axes: &'a [String],
    begun: Instant,
}

impl<'a> Line<'a> {
    pub(super) fn new(axes: &'a [String], seconds: f64) -> Self {
        // The bar hides itself if standard error is not a terminal.
        let total = (seconds * 1000.0) as u64;
        let bar =
            ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr_with_hz(10));
        let style = ProgressStyle::with_template("{bar:20} {percent:>3} % {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { bar, axes, begun: Instant::now() }
    }

    pub(super) fn show(&self, status: &Status) {
        if self.bar.is_hidden() {
            return;
        }
        let elapsed = self.begun.elapsed().as_millis() as u64;
        let places =
            self.axes.iter().zip(status.positions).map(|(axis, steps)| format!("{axis} {steps}"));
        self.bar.set_message(places.collect::<Vec<_>>().join("  "));
        self.bar.set_position(elapsed.min(self.bar.length().unwrap_or(0)));
    }
}

impl Drop for Line<'_> {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

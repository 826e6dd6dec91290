//! The progress line of a run.

use super::Itinerary;
use carrystep_link::Status;
use carrystep_runner::{MotionPace, OverrideSetting, TimeLeft};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::{Duration, Instant};

/// The progress line on a terminal: which part of the planned motion is over, the time that is
/// left, overrides, and the positions of the axes in steps. Waits of the program do not count.
pub(super) struct Line<'a> {
    bar: ProgressBar,
    axes: &'a [String],
    begun: Instant,
    time: TimeLeft,
}

impl<'a> Line<'a> {
    pub(super) fn new(axes: &'a [String], seconds: f64) -> Self {
        let time = TimeLeft::new(seconds);
        // The bar hides itself if standard error is not a terminal.
        let bar = ProgressBar::with_draw_target(
            Some(milliseconds(time.planned())),
            ProgressDrawTarget::stderr_with_hz(10),
        );
        let style = ProgressStyle::with_template("{bar:20} {percent:>3} % {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { bar, axes, begun: Instant::now(), time }
    }

    pub(super) fn show(&mut self, status: &Status, itinerary: &dyn Itinerary) {
        let (overrides, rate) = (itinerary.overrides(), itinerary.rate());
        let pace = MotionPace { overrides, rate, added: itinerary.added() };
        let moves = !status.answer.idle;
        if !self.time.see(self.begun.elapsed(), moves, pace) || self.bar.is_hidden() {
            return;
        }
        self.bar.set_message(message(self.time.left(), overrides, self.axes, &status.positions));
        self.bar.set_length(milliseconds(self.time.planned()));
        self.bar.set_position(milliseconds(self.time.moved()));
    }

    /// The machine rests: its time stands still until it moves again.
    pub(super) fn rests(&mut self, itinerary: &dyn Itinerary) {
        self.time.rests(itinerary.gone());
    }

    /// From now on, the motion that is left lasts this long. Returns the time of all motion, s.
    pub(super) fn plans(&mut self, seconds: f64) -> f64 {
        self.time.plans(seconds);
        self.bar.set_length(milliseconds(self.time.planned()));
        self.time.planned().as_secs_f64()
    }

    /// Writes something that stays above the line.
    pub(super) fn above(&self, write: impl FnOnce()) {
        self.bar.suspend(write);
    }
}

/// What stands behind the bar: the time that is left, to the nearest second, overrides that are in
/// force, and the positions.
fn message(
    left: Duration,
    overrides: OverrideSetting,
    axes: &[String],
    positions: &[i32],
) -> String {
    let left = left.saturating_add(Duration::from_millis(500)).as_secs();
    let places = axes.iter().zip(positions).map(|(axis, steps)| format!("{axis} {steps}"));
    let places = places.collect::<Vec<_>>().join("  ");
    let (hours, minutes, seconds) = (left / 3600, left / 60 % 60, left % 60);
    let over = match overrides {
        OverrideSetting::NONE => String::new(),
        overrides => format!("  {overrides}"),
    };
    format!("{hours}:{minutes:02}:{seconds:02} left{over}  {places}")
}

fn milliseconds(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}

impl Drop for Line<'_> {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_says_the_time_to_the_nearest_second() {
        let axes = ["x".to_owned(), "y".to_owned()];
        let said = |ms| {
            let left = Duration::from_millis(ms);
            message(left, OverrideSetting::NONE, &axes, &[3, -4, 0, 0])
        };
        assert_eq!(said(3_725_499), "1:02:05 left  x 3  y -4");
        assert_eq!(said(3_725_500), "1:02:06 left  x 3  y -4");
        assert_eq!(said(499), "0:00:00 left  x 3  y -4");
        let overrides = OverrideSetting { feed: 50, ..OverrideSetting::NONE };
        let said = message(Duration::ZERO, overrides, &axes, &[0, 0]);
        assert_eq!(said, format!("0:00:00 left  {overrides}  x 0  y 0"));
    }
}

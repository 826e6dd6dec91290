//! A progress bar for anything longer than a second, on a terminal only.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::{Duration, Instant};

/// Calls between two looks at the time: a look takes longer than an edge.
const CALLS: u32 = 1 << 14;

/// Looks at the time in a run whose edges are rarer than that.
const LOOKS: u64 = 1 << 10;

/// Progress of one run, in clocks.
pub struct Progress {
    bar: Option<ProgressBar>,
    calls: u32,
    /// The clock from which on it looks at the time, however few calls there were.
    next: u64,
    started: Instant,
    total: u64,
    what: &'static str,
}

impl Progress {
    /// A run of about `total` clocks.
    pub fn new(what: &'static str, total: u64) -> Self {
        Self { bar: None, calls: 0, next: total / LOOKS, started: Instant::now(), total, what }
    }

    /// The run has come to this clock.
    pub fn at(&mut self, clock: u64) {
        self.calls += 1;
        if self.calls < CALLS && clock < self.next {
            return;
        }
        (self.calls, self.next) = (0, clock + self.total / LOOKS);
        if self.bar.is_none() && self.started.elapsed() > Duration::from_secs(1) {
            // The target hides itself where standard error is no terminal.
            let bar = ProgressBar::with_draw_target(Some(self.total), ProgressDrawTarget::stderr_with_hz(10));
            let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} % {eta} left");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar.set_message(self.what);
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_position(clock.min(self.total));
        }
    }
}

/// What is going on, where nobody knows how long it takes.
pub struct Stages(ProgressBar);

impl Stages {
    /// Nothing yet.
    pub fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(10));
        let style = ProgressStyle::with_template("{spinner} {msg} {elapsed}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    /// This begins.
    pub fn next(&mut self, what: &str) {
        self.0.set_message(what.to_owned());
        self.0.reset_elapsed();
    }
}

impl Drop for Stages {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

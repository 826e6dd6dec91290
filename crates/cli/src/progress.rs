//! Progress displays for runs of more than a second, on a terminal only.

use carrystep_simulators::{HowFar, Level, RunStage};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Interval at which the watcher reads the progress of the run.
const LOOK: Duration = Duration::from_millis(100);

/// Shorter runs show no progress.
const SHORT: Duration = Duration::from_secs(1);

/// The progress of one run, in clocks. A separate thread polls it, so the display does not depend
/// on how often edges occur.
pub struct RunProgress {
    how_far: Arc<HowFar>,
    over: Arc<AtomicBool>,
    watcher: Option<JoinHandle<()>>,
}

impl RunProgress {
    /// The progress of a run at this level, of about `total` clocks if that is known.
    pub fn new(level: Level, total: Option<u64>) -> Self {
        let (how_far, over) = (Arc::new(HowFar::default()), Arc::new(AtomicBool::new(false)));
        let seen = (Arc::clone(&how_far), Arc::clone(&over));
        let watch = move || watch(level, total, &seen.0, &seen.1);
        let watcher = std::io::stderr().is_terminal().then(|| std::thread::spawn(watch));
        Self { how_far, over, watcher }
    }

    /// The counters that the run updates.
    pub fn how_far(&self) -> &HowFar {
        &self.how_far
    }
}

impl Drop for RunProgress {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        if let Some(watcher) = self.watcher.take() {
            watcher.thread().unpark();
            // A failure to draw the bar does not fail the run.
            let _ = watcher.join();
        }
    }
}

/// Displays the progress until the run is over.
fn watch(level: Level, total: Option<u64>, how_far: &HowFar, over: &AtomicBool) {
    let begun = Instant::now();
    let mut stage = (how_far.stage(), begun);
    let mut bar: Option<ProgressBar> = None;
    while !over.load(Ordering::Relaxed) {
        std::thread::park_timeout(LOOK);
        if how_far.stage() != stage.0 {
            stage = (how_far.stage(), Instant::now());
        }
        if begun.elapsed() < SHORT {
            continue;
        }
        let bar = bar.get_or_insert_with(|| total.map_or_else(spinner, begin));
        let name = match stage.0 {
            RunStage::Runs => level.name().to_owned(),
            RunStage::ModelRuns => format!("model, then {level}"),
            RunStage::VerilogRuns => format!("{level} against the model"),
        };
        let Some(total) = total else {
            bar.set_message(format!("{name}: {} M clocks", how_far.clock() / 1_000_000));
            bar.tick();
            continue;
        };
        let clock = how_far.clock().min(total);
        bar.set_position(clock);
        bar.set_prefix(name);
        bar.set_message(told(stage.1.elapsed(), clock, total));
    }
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
}

fn begin(total: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr_with_hz(10));
    let style = ProgressStyle::with_template("{prefix} {wide_bar} {percent:>3} % {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

/// The remaining time at the average speed of this run so far, and that speed.
fn told(elapsed: Duration, clock: u64, total: u64) -> String {
    let seconds = elapsed.as_secs_f64();
    if clock == 0 || seconds <= 0.0 {
        return format!("{} so far", clock_face(seconds));
    }
    let speed = clock as f64 / seconds;
    let left = total.saturating_sub(clock) as f64 / speed;
    format!("{} left at {:.0} k clocks/s", clock_face(left), speed / 1e3)
}

/// Formats a duration: `12 s`, `3 min 20 s`, `2 h 5 min`.
fn clock_face(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match whole {
        0..60 => format!("{whole} s"),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
    }
}

/// The number of moves, or of rows of a program, that have been planned.
pub struct PlanProgress {
    begun: Instant,
    what: &'static str,
    count: u64,
    bar: Option<ProgressBar>,
}

impl PlanProgress {
    /// A display that appears when planning takes longer than [`SHORT`].
    /// `what` is the word for what is counted.
    pub fn of(what: &'static str) -> Self {
        Self { begun: Instant::now(), what, count: 0, bar: None }
    }

    /// Counts one.
    pub fn one(&mut self) {
        const NOW_AND_THEN: u64 = 1000;
        self.count += 1;
        if self.count.is_multiple_of(NOW_AND_THEN) && self.begun.elapsed() >= SHORT {
            let bar = self.bar.get_or_insert_with(spinner);
            bar.set_message(format!("{} {} planned", self.count, self.what));
            bar.tick();
        }
    }
}

impl Drop for PlanProgress {
    fn drop(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

fn spinner() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(10));
    let style = ProgressStyle::with_template("{spinner} {msg} {elapsed}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    bar
}

/// A spinner with the current stage, for work of unknown length.
pub struct Stages(ProgressBar);

impl Stages {
    /// A spinner without a stage.
    pub fn new() -> Self {
        let bar = spinner();
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    /// Displays the name of a stage that begins now.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remaining_time_is_estimated_from_the_speed_of_this_run() {
        let told = |seconds, clock| told(Duration::from_secs(seconds), clock, 480_000_000);
        assert_eq!(told(10, 48_000_000), "1 min 30 s left at 4800 k clocks/s");
        assert_eq!(told(10, 480_000), "2 h 46 min left at 48 k clocks/s");
        assert_eq!(told(100, 480_000_000), "0 s left at 4800 k clocks/s");
        assert_eq!(told(7, 0), "7 s so far");
    }
}

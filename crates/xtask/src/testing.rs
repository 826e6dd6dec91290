//! Runs every test of the workspace. As many test binaries run at once as the cores can take, and one
//! more that waits for half of its time.
//!
//! `cargo test` runs the binaries one after another, so that one core idles while the last test of
//! each binary ends. Here all binaries are built once, long ones are split into slices of their
//! tests, and the slices run side by side, the longest first. Those of the command, which wait for
//! boards and lines for half of their time, share a core by twos. Tests that hardly do anything but
//! wait run beside all of them, one after the other. The runner is our own because cargo-nextest would
//! have to be compiled for many minutes before the first test.
//!
//! The seconds of each test are remembered in `target/test-durations.json`, and each binary's
//! output in `target/test-output/`.

mod binaries;
mod memory;
mod outcome;
mod process;
mod report;
mod schedule;
mod slices;

use crate::shell::{self, TaskResult};
use binaries::{Binary, Workspace};
use memory::TestTimes;
use outcome::Counts;
use process::Running;
use report::TestReport;
use schedule::Schedule;
use slices::{Needs, Slice};
use std::fs;
use std::path::Path;
use std::thread;
use std::time::Duration;

/// Random cases come from this seed, so that a failing run is caused by the change and not by
/// chance. Plain `cargo test` draws new cases.
const SEED: (&str, &str) = ("PROPTEST_RNG_SEED", "2009");

/// Number of half cores by which the running tests may exceed those of the computer: each test waits
/// at times, for a disk, a line or a tool that it has started.
const SPARE: usize = 1;

/// How often the running binaries are looked at.
const POLL: Duration = Duration::from_millis(20);

/// Builds all test binaries of the workspace. [`Workspace::run`] runs them.
///
/// # Errors
/// Something does not compile.
pub fn build() -> Result<Workspace, String> {
    binaries::build()
}

impl Workspace {
    /// Runs all tests. The last line that it prints is `N passed, N failed`.
    ///
    /// # Errors
    /// A test failed, a binary ended early, or no test was executed.
    pub fn run(&self) -> TaskResult {
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let halves = 2 * cores + SPARE;
        let path = self.target.join("test-durations.json");
        let mut memory = TestTimes::read(&path);
        let slices = self.slices(&memory)?;
        let outputs = self.target.join("test-output");
        empty(&outputs)?;
        let mut schedule = Schedule::new(&slices);
        let mut report = TestReport::new(&self.binaries, &slices, &outputs);
        let mut running: Vec<Running> = Vec::new();
        loop {
            let busy: usize = running.iter().map(|one| slices[one.slice].halves()).sum();
            let waits = running.iter().any(|one| slices[one.slice].needs == Needs::Patience);
            if let Some(slice) = schedule.next(halves.saturating_sub(busy), waits) {
                running.push(self.start(&slices, slice, &outputs)?);
                continue;
            }
            if running.is_empty() {
                break;
            }
            thread::sleep(POLL);
            let mut still = Vec::new();
            for mut one in running {
                match one.poll()? {
                    None => still.push(one),
                    Some(ended) => {
                        memory.learn(&self.binaries[slices[one.slice].binary].id, &ended.seconds);
                        report.add(one.slice, ended);
                    }
                }
            }
            running = still;
        }
        memory.write(&path)?;
        let counts = report.counts();
        if counts.ignored > 0 {
            report::line(&format!("{} tests are ignored", counts.ignored));
        }
        report::line(&format!("{} passed, {} failed", counts.passed, counts.failed));
        verdict(counts)
    }

    /// The slices of all binaries.
    fn slices(&self, memory: &TestTimes) -> Result<Vec<Slice>, String> {
        let mut slices = Vec::new();
        for (place, binary) in self.binaries.iter().enumerate() {
            let tests = process::tests(binary)?;
            slices.extend(slices::of(place, binary, &tests, memory));
        }
        Ok(slices)
    }

    fn start(&self, slices: &[Slice], place: usize, outputs: &Path) -> Result<Running, String> {
        let binary: &Binary = &self.binaries[slices[place].binary];
        Running::start(binary, &slices[place], place, &report::part(outputs, binary, place))
    }
}

/// A run in which no test passed is a failure.
fn verdict(counts: Counts) -> TaskResult {
    match counts {
        Counts { failed: 0, passed: 0, .. } => Err("no test was executed".to_owned()),
        Counts { failed: 0, .. } => Ok(()),
        _ => Err(format!("{} tests failed", counts.failed)),
    }
}

/// Makes a folder that holds nothing.
fn empty(folder: &Path) -> TaskResult {
    if folder.is_dir() {
        fs::remove_dir_all(folder).map_err(|error| shell::cannot("empty", folder, &error))?;
    }
    fs::create_dir_all(folder).map_err(|error| shell::cannot("make", folder, &error))
}

#[cfg(test)]
mod tests {
    use super::outcome::Counts;
    use super::verdict;

    #[test]
    fn a_run_without_tests_fails() {
        let counts = |passed, failed, ignored| Counts { passed, failed, ignored };
        assert!(verdict(counts(3, 0, 0)).is_ok());
        assert!(verdict(counts(3, 1, 0)).is_err());
        assert!(verdict(counts(0, 0, 0)).is_err());
        assert!(verdict(counts(0, 0, 5)).is_err());
    }
}

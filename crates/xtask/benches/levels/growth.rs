//! Measures how the time of each command of `carrystep` grows with its work, and its memory.
//!
//! The released command runs as a child process with 1, 10 and 100 times the work. The time per
//! unit of work must stay about the same, otherwise the time of the command is not linear. The
//! memory is that with a million moves.

mod child;
mod inputs;
mod rows;

use crate::report::{Growth, GrowthRow, MemoryRow};
use inputs::CommandLine;
use rows::{MEMORY_ROWS, ROWS, Row};
use std::path::Path;

/// How many times the work of its row a command is given.
const FACTORS: [u64; 3] = [1, 10, 100];

/// The greatest time per unit of work at the other factors, as a multiple of that at factor 1.
const RATIO_AT_MOST: f64 = 1.3;

/// The order in which the factors (by their index) take turns, so that a disturbance of the machine
/// meets all of them. The least time of each factor counts.
const TURNS: [usize; 8] = [0, 1, 0, 2, 0, 1, 0, 0];

/// The turns that follow where a ratio is too large, because a disturbance of the machine must not
/// fail the row.
const MORE_TURNS: [usize; 4] = [0, 2, 1, 2];

/// How often these turns follow at most.
const MORE: usize = 2;

/// The turns of a smoke run, which leaves out the longest run.
const SMOKE_TURNS: [usize; 2] = [0, 1];

/// A smoke run does this part of the work.
const SMOKE_PART: u64 = 50;

/// A smoke run measures the memory with this part of the moves.
const SMOKE_MEMORY_PART: u64 = 200;

/// The greatest memory of a command with a million moves, MB.
const MEGABYTES_AT_MOST: f64 = 200.0;

/// Number of runs of which the least is the time to start.
const STARTS: usize = 9;

/// Measures all commands. What is too slow is added to `failures`.
///
/// # Errors
/// A command fails.
pub fn measure(
    carrystep: &Path,
    smoke: bool,
    failures: &mut Vec<String>,
) -> Result<Growth, String> {
    let mut start_up = f64::INFINITY;
    for _ in 0..STARTS {
        start_up = start_up.min(child::seconds(carrystep, &["--version"])?);
    }
    let mut rows = Vec::new();
    for row in &ROWS {
        let measured = Timing::measure(row, carrystep, start_up, smoke)?.report();
        let ratios = [Some(measured.ratio_10), measured.ratio_100];
        for (factor, ratio) in FACTORS.into_iter().skip(1).zip(ratios) {
            if let Some(ratio) = ratio.filter(|ratio| *ratio > RATIO_AT_MOST) {
                failures.push(format!(
                    "{}: at {factor} times the work a {} takes {ratio:.2} times as long, \
                     {RATIO_AT_MOST} wanted",
                    row.command, row.unit
                ));
            }
        }
        rows.push(measured);
    }
    let memory = memory(carrystep, smoke, failures)?;
    Ok(Growth { start_up_ms: start_up * 1e3, ratio_wanted: RATIO_AT_MOST, rows, memory })
}

/// Measures the memory of the commands that read any number of moves.
fn memory(
    carrystep: &Path,
    smoke: bool,
    failures: &mut Vec<String>,
) -> Result<Vec<MemoryRow>, String> {
    let mut rows = Vec::new();
    for row in &MEMORY_ROWS {
        let moves = if smoke { row.units / SMOKE_MEMORY_PART } else { row.units };
        let bytes = CommandLine::prepare(row, moves, carrystep)?.memory(carrystep)?;
        let megabytes = bytes as f64 / 1e6;
        if megabytes > MEGABYTES_AT_MOST {
            failures.push(format!(
                "{}: {megabytes:.0} MB with {moves} moves, {MEGABYTES_AT_MOST} wanted",
                row.command
            ));
        }
        let wanted = MEGABYTES_AT_MOST;
        rows.push(MemoryRow { command: row.command, moves, megabytes, megabytes_wanted: wanted });
    }
    Ok(rows)
}

/// The measurement of one row.
struct Timing<'a> {
    row: &'a Row,
    /// The amount of work at factor 1.
    units: u64,
    /// The least processor time at each factor without the time to start, seconds. It is infinite
    /// where nothing was measured.
    least: [f64; FACTORS.len()],
}

impl<'a> Timing<'a> {
    fn measure(row: &'a Row, carrystep: &Path, start_up: f64, smoke: bool) -> Result<Self, String> {
        let units = if smoke { row.units.div_ceil(SMOKE_PART) } else { row.units };
        let mut timing = Self { row, units, least: [f64::INFINITY; FACTORS.len()] };
        let mut lines = [const { None }; FACTORS.len()];
        let mut take = |timing: &mut Self, turns: &[usize]| {
            for &size in turns {
                let line: &CommandLine = match &mut lines[size] {
                    Some(line) => line,
                    none => {
                        none.insert(CommandLine::prepare(row, units * FACTORS[size], carrystep)?)
                    }
                };
                // A smoke run may take less time than another run needed to start.
                let seconds = (line.run(carrystep)? - start_up).max(1e-6);
                timing.least[size] = timing.least[size].min(seconds);
            }
            Ok::<(), String>(())
        };
        if smoke {
            take(&mut timing, &SMOKE_TURNS)?;
        } else {
            take(&mut timing, &TURNS)?;
            for _ in 0..MORE {
                if (1..FACTORS.len()).any(|size| timing.ratio(size) > RATIO_AT_MOST) {
                    take(&mut timing, &MORE_TURNS)?;
                }
            }
        }
        Ok(timing)
    }

    /// Time per unit of work at a factor, seconds.
    fn per_unit(&self, size: usize) -> f64 {
        self.least[size] / (self.units * FACTORS[size]) as f64
    }

    /// Time per unit at a factor, as a multiple of that at factor 1.
    fn ratio(&self, size: usize) -> f64 {
        self.per_unit(size) / self.per_unit(0)
    }

    fn report(&self) -> GrowthRow {
        let measured = self.least[2].is_finite();
        GrowthRow {
            command: self.row.command,
            unit: self.row.unit,
            units: self.units,
            us_per_unit_1: self.per_unit(0) * 1e6,
            us_per_unit_10: self.per_unit(1) * 1e6,
            us_per_unit_100: measured.then(|| self.per_unit(2) * 1e6),
            ratio_10: self.ratio(1),
            ratio_100: measured.then(|| self.ratio(2)),
        }
    }
}

//! Benchmark: time for each line and memory, from ten thousand lines to a million.
//!
//!     cargo bench -p carrystep-job --bench scale

#![allow(clippy::print_stdout, reason = "a benchmark prints its table")]
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

#[path = "../tests/common/mod.rs"]
mod common;

use carrystep_job::{Cartesian, Planner, rows};
use common::measure::program;
use std::time::Instant;

fn main() {
    let machine = common::machine(&common::reader::file("machine.toml"));
    let relief = program("relief.ngc");
    for repeats in [1, 10, 97] {
        let lines = repeats * relief.len();
        let begin = Instant::now();
        let planner = Planner::new(&machine, &Cartesian, 3, &[0.0; 3]).unwrap();
        // The items are made while they are planned, and no row is kept.
        let items = (0..repeats).flat_map(|_| relief.iter().cloned());
        let count = rows(planner, items).filter(|row| row.as_ref().is_ok()).count();
        let seconds = begin.elapsed().as_secs_f64();
        println!(
            "{lines} lines: {count} rows in {seconds:.2} s, {:.0} lines/s, peak memory {}",
            lines as f64 / seconds,
            peak()
        );
    }
}

/// The greatest resident memory of this process so far, on Linux.
fn peak() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM"));
    line.map_or_else(|| "unknown".into(), |line| line["VmHWM:".len()..].trim().into())
}

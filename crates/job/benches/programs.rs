//! Benchmark: times of jobs beside those of other rules, and how fast they are planned.
//!
//!     cargo bench -p carrystep-job
//!
//! `JOBS` may name further programs of G0 to G3, by their whole paths.

#![allow(clippy::print_stdout, reason = "a benchmark prints its table")]
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

#[path = "../tests/common/mod.rs"]
mod common;

use carrystep_job::{Cartesian, Planner, rows};
use common::measure::{deviation, planned, program, times};
use std::time::Instant;

const PROGRAMS: [&str; 4] =
    ["square_and_arc.ngc", "chords_and_star.ngc", "trochoid.ngc", "relief.ngc"];

fn main() {
    let text = common::reader::file("machine.toml");
    let machine = common::machine(&text);
    let more = std::env::var("JOBS").unwrap_or_default();
    println!("program: ours / Grbl's rule = ratio; rest to rest; ours / least = ratio; deviation");
    for name in PROGRAMS.into_iter().chain(more.split_whitespace()) {
        let items = program(name);
        let t = times(&machine, &items);
        let (grbl, least) = (t.ours / t.grbl, t.inner / t.least);
        let off = deviation(&machine, &items, &planned(&machine, &items));
        println!(
            "{name}: {:.3} s / {:.3} s = {grbl:.4}; {:.1} s; {:.3} / {:.3} = {least:.4}; {off:.3} of the tolerance",
            t.ours, t.grbl, t.rest_to_rest, t.inner, t.least
        );
        let begin = Instant::now();
        let lines = items.len();
        let planner = Planner::new(&machine, &Cartesian, 3, &[0.0; 3]).unwrap();
        let count = rows(planner, items).filter(Result::is_ok).count();
        let seconds = begin.elapsed().as_secs_f64();
        println!(
            "    {count} rows planned in {seconds:.3} s: {:.0} lines/s, {:.0} times real time",
            lines as f64 / seconds,
            t.ours / seconds
        );
    }
    for jerk in [50_000, 10_000] {
        let text = text.replace("driver", &format!("jerk_limit = {jerk}\ndriver"));
        let machine = common::machine(&text);
        for name in PROGRAMS.into_iter().chain(more.split_whitespace()) {
            let items = program(name);
            let planner = Planner::new(&machine, &Cartesian, 3, &[0.0; 3]).unwrap();
            let planned: Result<Vec<_>, _> = rows(planner, items).collect();
            match planned {
                Ok(rows) => {
                    let ticks: u64 = rows.iter().map(|row| u64::from(row.ticks)).sum();
                    println!("{name}, jerk {jerk}: {:.3} s", ticks as f64 * 1e-6);
                }
                Err(error) => println!("{name}, jerk {jerk}: {error}"),
            }
        }
    }
}

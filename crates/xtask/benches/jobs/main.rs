//! `cargo xtask bench jobs` measures the planner of jobs: times beside other rules, deviation,
//! speed of planning and simulating, memory. It prints the tables of `docs/performance.md`.
//!
//! The reference planners are those of the planner's tests, written from the published formulas.
//! Speeds are in processor time, which other programs on the machine affect less than the time on
//! the clock.

#![allow(clippy::print_stdout, reason = "a benchmark prints its tables")]
#![allow(clippy::unwrap_used, reason = "the planner's tests, which are included, may panic")]

#[path = "../levels/growth/child.rs"]
mod child;
mod commands;
#[path = "../../../job/tests/common/mod.rs"]
mod common;
#[path = "../levels/stopwatch.rs"]
#[allow(dead_code, reason = "the other benchmark uses the rest")]
mod stopwatch;

use carrystep_files::Machine;
use carrystep_job::{Item, Planner, rows};
use clap::Parser;
use common::measure::{deviation, planned, program, times};
use std::path::PathBuf;
use std::process::ExitCode;

/// The programs of `sim/jobs/`, and whether Grbl's rule can be compared with them. On the trochoid,
/// chords let it pass arcs faster than the acceleration limit allows.
const PROGRAMS: [(&str, bool); 4] = [
    ("square_and_arc.ngc", true),
    ("chords_and_star.ngc", true),
    ("trochoid.ngc", false),
    ("relief.ngc", true),
];
/// A program of the package `linuxcnc-uspace`, and Grbl's time for it, s, by the same rule.
const CHIPS: (&str, f64) = ("/usr/share/linuxcnc/ncfiles/3D_Chips.ngc", 91.1);
/// What is required.
const TO_GRBL: f64 = 1.10;
const TO_LEAST: f64 = 1.03;
const LINES_A_SECOND: f64 = 20_000.0;
const TIMES_REAL_TIME: f64 = 100.0;

/// Times of jobs, speeds and memory.
#[derive(Parser)]
#[command(name = "cargo xtask bench jobs")]
struct Arguments {
    /// The command `carrystep` of the same build; `cargo xtask bench` passes it.
    #[arg(long, value_name = "FILE")]
    carrystep: PathBuf,
    /// Leave out the long programs.
    #[arg(long)]
    smoke: bool,
    /// Passed by `cargo bench`.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let mut missed = Vec::new();
    against_others(&mut missed);
    let measured = commands::chips(&arguments.carrystep, &CHIPS, &mut missed).and_then(|()| {
        with_jerk_limits();
        commands::speed_and_memory(&arguments.carrystep, arguments.smoke, &mut missed)
    });
    if let Err(error) = measured {
        println!("bench: {error}");
        return ExitCode::FAILURE;
    }
    if missed.is_empty() {
        println!("\nEvery figure is within what is required.");
    } else {
        println!("\nNot reached: {}.", missed.join("; "));
    }
    ExitCode::SUCCESS
}

/// Adds a figure that is worse than required.
fn judge(missed: &mut Vec<String>, holds: bool, what: String) {
    if !holds {
        missed.push(what);
    }
}

/// Processor time of planning a program, s: the least of three.
fn planning(machine: &Machine, items: &[Item]) -> f64 {
    let once = || {
        let planner = Planner::new(machine, 3, &[0.0; 3]).unwrap();
        rows(planner, items.iter().cloned()).filter(Result::is_ok).count()
    };
    (0..3).map(|_| stopwatch::least(0.0, once).0).fold(f64::INFINITY, f64::min)
}

/// The table of times without a jerk limit, beside those of other rules.
fn against_others(missed: &mut Vec<String>) {
    let machine = common::machine(&common::reader::file("machine.toml"));
    println!(
        "| program | ours, s | Grbl's rule, s | ratio | rest to rest, s | ours / least | deviation / tolerance | lines/s | x real time |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (name, compared) in PROGRAMS {
        let items = program(name);
        let t = times(&machine, &items);
        let (grbl, least) = (t.ours / t.grbl, t.inner / t.least);
        let off = deviation(&machine, &items, &planned(&machine, &items));
        let seconds = planning(&machine, &items);
        let (speed, real) = (items.len() as f64 / seconds, t.ours / seconds);
        let ratio = if compared { format!("{grbl:.3}") } else { String::new() };
        println!(
            "| `{name}` | {:.3} | {:.2} | {ratio} | {:.1} | {least:.4} | {off:.2} | {speed:.0} | {real:.0} |",
            t.ours, t.grbl, t.rest_to_rest
        );
        judge(missed, !compared || grbl <= TO_GRBL, format!("{name}: {grbl:.3} of Grbl's time"));
        judge(missed, least <= TO_LEAST, format!("{name}: {least:.4} of the least time"));
        judge(missed, off <= 1.0, format!("{name}: {off:.2} of the tolerance"));
        judge(missed, real >= TIMES_REAL_TIME, format!("{name}: {real:.0} x real time"));
        if name == "relief.ngc" {
            let what = format!("{name}: {speed:.0} lines/s of {LINES_A_SECOND}");
            judge(missed, speed >= LINES_A_SECOND, what);
        }
    }
}

/// The table of times with jerk limits.
fn with_jerk_limits() {
    let text = common::reader::file("machine.toml");
    println!(
        "\n| program | J = A / 4 ms | J = 50 000 mm/s^3 | J = 10 000 mm/s^3 |\n|---|---|---|---|"
    );
    for (name, _) in PROGRAMS {
        let items = program(name);
        let seconds = ["", "jerk_limit = 50000\n", "jerk_limit = 10000\n"].map(|jerk| {
            let machine = common::machine(&text.replace("driver", &format!("{jerk}driver")));
            let rows = planned(&machine, &items);
            rows.iter().map(|row| u64::from(row.ticks)).sum::<u64>() as f64 * 1e-6
        });
        let [a, b, c] = seconds;
        println!("| `{name}` | {a:.2} | {b:.1} | {c:.1} |");
    }
}

//! `cargo xtask bench` measures every level on the same moves, side by side in one run.
//!
//! The fast model and Verilator are measured in processor time over the whole move, each in its
//! fastest configuration. The other levels are measured over the beginning of the move.

mod levels;
mod moves;
mod report;
mod stopwatch;
mod ticking;
mod verilator;
mod writers;

use carrystep_core::AXES;
use carrystep_simulators::Level;
use clap::Parser;
use moves::{DENSITIES, Density, Moves, STEADY};
use report::{BenchReport, BenchRow};
use std::io::Write as _;
use std::process::ExitCode;
use std::time::Instant;
use verilator::Verilated;

/// If Verilator runs below this speed, clock cycles per second, the machine is disturbed and the
/// run is invalid.
const VERILATOR_AT_LEAST: f64 = 5e6;

/// The greatest time per edge of the fast model on the busy move, ns.
const NS_PER_EDGE_AT_MOST: f64 = 15.0;

/// Side by side: the fast model, the tick model, Rust-HDL, Icarus and Verilator.
#[derive(Parser)]
#[command(name = "cargo xtask bench")]
struct Arguments {
    /// One JSON document instead of the table.
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let text = measure().and_then(|report| {
        let json = serde_json::to_string_pretty(&report).map_err(|error| error.to_string())?;
        Ok((if arguments.json { format!("{json}\n") } else { report.to_string() }, report.passed))
    });
    let (text, passed) = text.unwrap_or_else(|error| (format!("bench: {error}\n"), false));
    // If this write fails, there is no way left to report it.
    let _ = std::io::stdout().write_all(text.as_bytes());
    if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn measure() -> Result<BenchReport, String> {
    let moves = DENSITIES.iter().map(Moves::load).collect::<Result<Vec<_>, _>>()?;
    let build = &moves[0].plan.build;
    let verilog = carrystep_verilog::parallel_verilog(build, AXES, "sim/bench/machine.toml")
        .map_err(|error| error.to_string())?;
    let toggling = Verilated::compile(&verilog, false)?;
    let tracing = Verilated::compile(&verilog, true)?;

    let begin = Instant::now();
    let mut failures = Vec::new();
    let mut rows = Vec::new();
    for (density, moves) in DENSITIES.iter().zip(&moves) {
        rows.push(row(density, moves, &toggling, &mut failures)?);
    }
    let steady = Moves::load(&STEADY)?;
    let (steady_seconds, heard) = levels::fast(&steady)?;
    let edge = steady_seconds / (heard.pulses + heard.dir_changes).max(1) as f64;
    let (typical_seconds, heard) = levels::fast(&moves[1])?;
    let loading = typical_seconds - edge * (heard.pulses + heard.dir_changes) as f64;
    let engine_times_real_time = levels::engine(&moves[0], &levels::fast(&moves[0])?.1)?;
    let [ticked_ns_one_after_the_other, ticked_ns_side_by_side] = ticking::measure()?;
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let busy = &moves[0];
    let ports = writers::ports(busy, folder.path())?;
    let waveform = writers::waveform(busy, folder.path())?;
    let (feed, clocks) = (busy.feed(), busy.outcome.clocks);
    let untraced = tracing.run(&feed, clocks, None)?.seconds;
    let theirs = writers::verilators(&tracing, &feed, clocks, untraced, folder.path())?;
    if ports.megabytes_per_second() < theirs.megabytes_per_second() / 2.0 {
        failures.push("our VCD is written at less than half the speed of Verilator's".to_owned());
    }
    let busy_ns = rows.first().map_or(f64::INFINITY, |row| row.fast_ns_per_edge);
    if busy_ns > NS_PER_EDGE_AT_MOST {
        failures.push(format!("busy: {busy_ns:.1} ns an edge, {NS_PER_EDGE_AT_MOST} wanted"));
    }
    let ratio = |name: &str| {
        rows.iter().find(|row: &&BenchRow| row.name == name).map_or(0.0, |row| row.ratio)
    };
    Ok(BenchReport {
        passed: failures.is_empty(),
        machine: machine(),
        ratio_busy: ratio("busy"),
        ratio_typical: ratio("typical"),
        ratio_rest: ratio("rest"),
        rows,
        steady_ns_per_edge: edge * 1e9,
        typical_ns_per_load: loading * 1e9 / moves[1].loads() as f64,
        engine_times_real_time,
        ticked_ns_one_after_the_other,
        ticked_ns_side_by_side,
        vcd_mb_per_s: ports.megabytes_per_second(),
        waveform_mb_per_s: waveform.megabytes_per_second(),
        verilator_vcd_mb_per_s: theirs.megabytes_per_second(),
        measured_s: begin.elapsed().as_secs_f64(),
        failures,
    })
}

fn row(
    density: &Density,
    moves: &Moves,
    toggling: &Verilated,
    failures: &mut Vec<String>,
) -> Result<BenchRow, String> {
    let clocks = moves.outcome.clocks;
    let (seconds, heard) = levels::fast(moves)?;
    let run = toggling.run(&moves.feed(), clocks, None)?;
    if run.positions != moves.outcome.last.position {
        failures.push(format!(
            "{}: Verilator's positions are not those of the fast model",
            density.name
        ));
    }
    let (fast, verilator) = (clocks as f64 / seconds, clocks as f64 / run.seconds);
    if verilator < VERILATOR_AT_LEAST {
        failures.push(format!(
            "{}: invalid, Verilator runs at only {verilator:.2e} clocks/s",
            density.name
        ));
    }
    if fast < density.wanted * verilator {
        failures.push(format!(
            "{}: {:.0} times Verilator, {} wanted",
            density.name,
            fast / verilator,
            density.wanted
        ));
    }
    Ok(BenchRow {
        name: density.name,
        what: density.what,
        clocks,
        pulses: heard.pulses,
        hash: format!("{:016x}", heard.hash),
        fast_ns_per_edge: seconds * 1e9 / (heard.pulses + heard.dir_changes).max(1) as f64,
        fast,
        model: levels::clocks_per_second(Level::Model, moves, 2_000_000)?,
        rust_hdl: levels::clocks_per_second(Level::RustHdl, moves, 4_000)?,
        icarus: levels::clocks_per_second(Level::Icarus, moves, 40_000)?,
        verilator,
        ratio: fast / verilator,
        ratio_wanted: density.wanted,
    })
}

/// The processor and the number of its cores, for the report.
fn machine() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{}, {cores} cores", model.map_or("unknown processor", |(_, name)| name))
}

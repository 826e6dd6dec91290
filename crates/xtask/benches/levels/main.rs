//! `cargo xtask bench` measures every level on the same moves, side by side in one run.
//!
//! The fast model and Verilator are measured in processor time over the whole move, each in its
//! fastest configuration. The other levels are measured over the beginning of the move. At the end
//! the released command itself is measured, with growing work.

mod growth;
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
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use verilator::Verilated;

/// The greatest time per edge of the fast model on the busy move, as a part of the time that
/// Verilator needs for a clock in the same run.
const EDGE_AT_MOST: f64 = 0.15;

/// The greatest time of writing the waveform of the busy move as FST, as a part of that as VCD. They
/// take about the same, and a run may find either a little faster.
const FST_AT_MOST: f64 = 1.1;

/// The number of clocks that Verilator runs in a smoke run: less than a second.
const SMOKE_CLOCKS: u64 = 2_000_000;

/// Side by side: the fast model, the tick model, Rust-HDL, Icarus and Verilator.
#[derive(Parser)]
#[command(name = "cargo xtask bench")]
struct Arguments {
    /// One JSON document instead of the table.
    #[arg(long)]
    json: bool,
    /// Only see that everything runs: about a second for each row, and no figure is judged.
    #[arg(long)]
    smoke: bool,
    /// The command `carrystep` of the same build; `cargo xtask bench` passes it.
    #[arg(long, value_name = "FILE")]
    carrystep: PathBuf,
    /// Passed by `cargo bench`.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let text = measure(&arguments.carrystep, arguments.smoke).and_then(|report| {
        let json = serde_json::to_string_pretty(&report).map_err(|error| error.to_string())?;
        Ok((if arguments.json { format!("{json}\n") } else { report.to_string() }, report.passed))
    });
    let (text, passed) = text.unwrap_or_else(|error| (format!("bench: {error}\n"), false));
    // If this write fails, there is no way left to report it.
    let _ = std::io::stdout().write_all(text.as_bytes());
    if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn measure(carrystep: &Path, smoke: bool) -> Result<BenchReport, String> {
    let moves = DENSITIES.iter().map(Moves::load).collect::<Result<Vec<_>, _>>()?;
    let build = &moves[0].plan.build;
    let verilog = carrystep_verilog::parallel_verilog(build, AXES, "sim/bench/machine.toml")
        .map_err(|error| error.to_string())?;
    let tracing = Verilated::compile(&verilog, true, smoke)?;
    // No figure of a smoke run is judged, so that one compilation is enough.
    let own = if smoke { None } else { Some(Verilated::compile(&verilog, false, smoke)?) };
    let toggling = own.as_ref().unwrap_or(&tracing);

    let begin = Instant::now();
    let mut failures = Vec::new();
    let mut rows = Vec::new();
    for (density, moves) in DENSITIES.iter().zip(&moves) {
        rows.push(row(density, moves, toggling, smoke, &mut failures)?);
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
    let [waveform, fst] = writers::waveforms(busy, folder.path())?;
    let fst_per_vcd = fst.seconds / waveform.seconds.max(1e-9);
    let (feed, clocks) = (busy.feed(), most_clocks(busy, smoke));
    let untraced = tracing.run(&feed, clocks, None)?.seconds;
    let theirs = writers::verilators(&tracing, &feed, clocks, untraced, folder.path())?;
    if ports.megabytes_per_second() < theirs.megabytes_per_second() / 2.0 {
        failures.push("our VCD is written at less than half the speed of Verilator's".to_owned());
    }
    if fst_per_vcd > FST_AT_MOST {
        failures
            .push(format!("FST takes {fst_per_vcd:.2} of the time of VCD, {FST_AT_MOST} wanted"));
    }
    if let Some(busy) = rows.first() {
        let edge = busy.fast_ns_per_edge * 1e-9 * busy.verilator;
        if edge > EDGE_AT_MOST {
            failures.push(format!(
                "busy: an edge takes {edge:.2} of a clock of Verilator, {EDGE_AT_MOST} wanted"
            ));
        }
    }
    let growth = growth::measure(carrystep, smoke, &mut failures)?;
    if smoke {
        failures.clear();
    }
    let ratio = |name: &str| {
        rows.iter().find(|row: &&BenchRow| row.name == name).map_or(0.0, |row| row.ratio)
    };
    Ok(BenchReport {
        passed: failures.is_empty(),
        judged: !smoke,
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
        fst_per_vcd,
        verilator_vcd_mb_per_s: theirs.megabytes_per_second(),
        growth,
        measured_s: begin.elapsed().as_secs_f64(),
        failures,
    })
}

/// How often the fast model and Verilator take turns.
const TURNS: usize = 6;

fn row(
    density: &Density,
    moves: &Moves,
    toggling: &Verilated,
    smoke: bool,
    failures: &mut Vec<String>,
) -> Result<BenchRow, String> {
    let (clocks, feed) = (moves.outcome.clocks, moves.feed());
    let most = most_clocks(moves, smoke);
    // Both take turns, so that a disturbance of the machine meets both.
    let (mut seconds, heard) = levels::fast(moves)?;
    let mut their_seconds = f64::INFINITY;
    for _ in 0..if smoke { 1 } else { TURNS } {
        let run = toggling.run(&feed, most, None)?;
        if most == clocks && run.positions != moves.outcome.last.position {
            return Err(format!(
                "{}: Verilator's positions are not those of the fast model",
                density.name
            ));
        }
        their_seconds = their_seconds.min(run.seconds);
        seconds = seconds.min(levels::fast(moves)?.0);
    }
    let fast = clocks as f64 / seconds;
    let verilator = most as f64 / their_seconds;
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
        icarus: levels::clocks_per_second(
            Level::Icarus,
            moves,
            if smoke { 4_000 } else { 40_000 },
        )?,
        verilator,
        ratio: fast / verilator,
        ratio_wanted: density.wanted,
    })
}

/// The number of clocks that Verilator runs.
fn most_clocks(moves: &Moves, smoke: bool) -> u64 {
    moves.outcome.clocks.min(if smoke { SMOKE_CLOCKS } else { u64::MAX })
}

/// The processor and the number of its cores, for the report.
fn machine() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{}, {cores} cores", model.map_or("unknown processor", |(_, name)| name))
}

//! The report of the bench, as JSON and as a table.
//!
//! The names of the fields are those of the JSON document.

use serde::Serialize;
use std::fmt;

/// All measurements, with one row per move.
#[derive(Debug, Serialize)]
pub struct BenchReport {
    pub passed: bool,
    /// Whether figures were compared with what is wanted; a smoke run does not.
    pub judged: bool,
    pub machine: String,
    /// Clock cycles per second of the fast model divided by those of Verilator, in the same run.
    pub ratio_busy: f64,
    pub ratio_typical: f64,
    pub ratio_rest: f64,
    pub rows: Vec<BenchRow>,
    /// Time per edge on the steady move, which has the density of the typical move but few loads,
    /// ns.
    pub steady_ns_per_edge: f64,
    /// Time that the typical move takes in addition, per load of a segment, ns. A load ends the
    /// current window of all axes.
    pub typical_ns_per_load: f64,
    /// Speed of the 80 MHz engine on the busy move, as a multiple of real time.
    pub engine_times_real_time: f64,
    /// Time of a tick of six axes when every tick is computed, ns.
    pub ticked_ns_one_after_the_other: f64,
    pub ticked_ns_side_by_side: f64,
    /// Writing speed for the ports of the core, which are the signals of Verilator's trace, MB/s.
    pub vcd_mb_per_s: f64,
    /// Writing speed for the waveform of the product: pins and registers beside the float profile,
    /// MB/s.
    pub waveform_mb_per_s: f64,
    /// Time of writing that waveform as FST, as a part of the time as VCD.
    pub fst_per_vcd: f64,
    pub verilator_vcd_mb_per_s: f64,
    /// How the time of each command grows with its work.
    pub growth: Growth,
    pub measured_s: f64,
    /// What is wrong with the run; empty if it passed.
    pub failures: Vec<String>,
}

/// One move on every level.
#[derive(Debug, Serialize)]
pub struct BenchRow {
    pub name: &'static str,
    pub what: &'static str,
    pub clocks: u64,
    pub pulses: u64,
    /// The hash of clock, axis, kind and direction of every edge.
    pub hash: String,
    pub fast_ns_per_edge: f64,
    /// Clock cycles per second, for this level and the following ones.
    pub fast: f64,
    pub model: f64,
    pub rust_hdl: f64,
    pub icarus: f64,
    pub verilator: f64,
    pub ratio: f64,
    pub ratio_wanted: f64,
}

/// The growth of all commands.
#[derive(Debug, Serialize)]
pub struct Growth {
    /// Processor time of `carrystep --version`, ms. It is subtracted from the time of each run.
    pub start_up_ms: f64,
    /// The greatest ratio with which a row passes.
    pub ratio_wanted: f64,
    pub rows: Vec<GrowthRow>,
    pub memory: Vec<MemoryRow>,
}

/// The greatest memory of a command.
#[derive(Debug, Serialize)]
pub struct MemoryRow {
    pub command: &'static str,
    /// Number of moves of its input.
    pub moves: u64,
    pub megabytes: f64,
    pub megabytes_wanted: f64,
}

/// Processor time of a command per unit of work, with 1, 10 and 100 times the work.
#[derive(Debug, Serialize)]
pub struct GrowthRow {
    pub command: &'static str,
    pub unit: &'static str,
    /// The amount of work at factor 1.
    pub units: u64,
    pub us_per_unit_1: f64,
    pub us_per_unit_10: f64,
    /// Null in a smoke run, as is `ratio_100`.
    pub us_per_unit_100: Option<f64>,
    /// The time per unit as a multiple of that at factor 1.
    pub ratio_10: f64,
    pub ratio_100: Option<f64>,
}

impl fmt::Display for BenchReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.machine)?;
        writeln!(f, "clock cycles a second, six axes at 48 MHz, 1 us ticks, the same pulses:\n")?;
        writeln!(
            f,
            "| move | pulses | fast | ns an edge | model | Rust-HDL | Icarus | Verilator | fast / Verilator | wanted |"
        )?;
        writeln!(f, "|---|---|---|---|---|---|---|---|---|---|")?;
        for row in &self.rows {
            writeln!(
                f,
                "| {} ({}) | {} | {:.3e} | {:.1} | {:.2e} | {:.2e} | {:.2e} | {:.2e} | **{:.0}** | {:.0} |",
                row.name,
                row.what,
                row.pulses,
                row.fast,
                row.fast_ns_per_edge,
                row.model,
                row.rust_hdl,
                row.icarus,
                row.verilator,
                row.ratio,
                row.ratio_wanted
            )?;
        }
        writeln!(
            f,
            "\nan edge at 10 000 steps/s without loads: {:.1} ns; a load of the typical move: {:.0} ns",
            self.steady_ns_per_edge, self.typical_ns_per_load
        )?;
        writeln!(
            f,
            "the engine at 80 MHz, busy: {:.0} times real time",
            self.engine_times_real_time
        )?;
        writeln!(
            f,
            "a tick of six axes, added: {:.1} ns one axis after the other, {:.1} ns side by side",
            self.ticked_ns_one_after_the_other, self.ticked_ns_side_by_side
        )?;
        writeln!(
            f,
            "VCD of the ports: {:.0} MB/s, Verilator's own trace of them {:.0} MB/s; our whole waveform {:.0} MB/s",
            self.vcd_mb_per_s, self.verilator_vcd_mb_per_s, self.waveform_mb_per_s
        )?;
        writeln!(f, "FST of the whole waveform takes {:.2} of the time of VCD", self.fst_per_vcd)?;
        write!(f, "{}", self.growth)?;
        writeln!(f, "measured in {:.0} s", self.measured_s)?;
        if !self.judged {
            writeln!(f, "a smoke run: nothing was judged")?;
        }
        self.failures.iter().try_for_each(|failure| writeln!(f, "FAILED: {failure}"))
    }
}

impl fmt::Display for Growth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "\nprocessor time per unit of work at 1, 10 and 100 times the work, without the {:.1} ms to start:\n",
            self.start_up_ms
        )?;
        writeln!(
            f,
            "| command | unit | units at 1 | us at 1 | at 10 | at 100 | 10 / 1 | 100 / 1 |"
        )?;
        writeln!(f, "|---|---|---|---|---|---|---|---|")?;
        let cell = |value: Option<f64>, digits: usize| {
            value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
        };
        for row in &self.rows {
            let digits = if row.us_per_unit_1 < 10.0 { 3 } else { 1 };
            writeln!(
                f,
                "| `{}` | {} | {} | {} | {} | {} | {:.2} | {} |",
                row.command,
                row.unit,
                row.units,
                cell(Some(row.us_per_unit_1), digits),
                cell(Some(row.us_per_unit_10), digits),
                cell(row.us_per_unit_100, digits),
                row.ratio_10,
                cell(row.ratio_100, 2)
            )?;
        }
        writeln!(f, "\na ratio is at most {}\n", self.ratio_wanted)?;
        writeln!(f, "| command | moves | memory, MB | wanted |")?;
        writeln!(f, "|---|---|---|---|")?;
        for MemoryRow { command, moves, megabytes, megabytes_wanted } in &self.memory {
            writeln!(f, "| `{command}` | {moves} | {megabytes:.0} | {megabytes_wanted:.0} |")?;
        }
        writeln!(f)
    }
}

//! What a run of the bench came to, as JSON and as a table.

use serde::Serialize;
use std::fmt;

/// Everything measured, one row a move.
#[derive(Debug, Serialize)]
pub struct Report {
    pub passed: bool,
    pub machine: String,
    /// Times Verilator's clock cycles a second, in this run.
    pub ratio_busy: f64,
    pub ratio_typical: f64,
    pub ratio_rest: f64,
    pub rows: Vec<Row>,
    /// The core's ports, as Verilator's trace has them.
    pub vcd_mb_per_s: f64,
    /// The product's waveform: pins and registers beside the float profile.
    pub waveform_mb_per_s: f64,
    pub verilator_vcd_mb_per_s: f64,
    pub measured_s: f64,
    /// What is wrong with the run; empty where it passed.
    pub failures: Vec<String>,
}

/// One move on every level.
#[derive(Debug, Serialize)]
pub struct Row {
    pub name: &'static str,
    pub what: &'static str,
    pub clocks: u64,
    pub pulses: u64,
    /// Of clock, axis, kind and direction of every edge.
    pub hash: String,
    pub fast_ns_per_edge: f64,
    /// Clock cycles a second.
    pub fast: f64,
    pub model: f64,
    pub rust_hdl: f64,
    pub icarus: f64,
    pub verilator: f64,
    pub ratio: f64,
    pub ratio_wanted: f64,
}

impl fmt::Display for Report {
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
            "\nVCD of the ports: {:.0} MB/s, Verilator's own trace of them {:.0} MB/s; our whole waveform {:.0} MB/s",
            self.vcd_mb_per_s, self.verilator_vcd_mb_per_s, self.waveform_mb_per_s
        )?;
        writeln!(f, "measured in {:.0} s", self.measured_s)?;
        self.failures.iter().try_for_each(|failure| writeln!(f, "FAILED: {failure}"))
    }
}

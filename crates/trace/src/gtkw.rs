//! A GTKWave save file for the VCD that [`VcdWriter`](crate::VcdWriter) writes.
//!
//! GTKWave drops a name that does not match without a word, so every name comes from the writer's own
//! table, range included.

use crate::error::TraceError;
use crate::vcd_out::{SCOPE, SIGNALS};
use minijinja::{Environment, context};
use serde::Serialize;

const TEMPLATE: &str = include_str!("../templates/gtkwave.gtkw");

/// Width of the wave area in pixels when all of a run is to be seen.
const PIXELS: f64 = 1100.0;

/// How a signal is drawn: the flags of a `@` line (GTKWave's analyzer.h) and blank rows that give it height.
#[derive(Serialize)]
struct Trace {
    name: String,
    flags: &'static str,
    colour: u8,
    rows: usize,
}

fn trace(axis: &str, name: &str, bits: u32) -> Trace {
    // 28 binary, 88420 signed analog step, 90020 real analog interpolated, each right-justified and scaled to all data
    let (flags, colour, rows) = match name {
        "step" => ("28", 2, 0),
        "dir" => ("28", 3, 0),
        "position" => ("88420", 5, 3),
        "v" => ("88420", 4, 3),
        "error_ns" => ("90020", 1, 3),
        _ => ("90020", 6, 3),
    };
    let range = if bits > 1 { format!("[{}:0]", bits - 1) } else { String::new() };
    Trace { name: format!("{SCOPE}.{axis}.{name}{range}"), flags, colour, rows }
}

/// The save file: a group for each axis, zoomed so that `end_ps` is in sight.
///
/// `vcd` is the VCD's name as it is seen from the save file's folder.
///
/// # Errors
/// The template cannot be rendered.
pub fn save_file(vcd: &str, axes: &[&str], end_ps: u64) -> Result<String, TraceError> {
    #[derive(Serialize)]
    struct Group<'a> {
        name: &'a str,
        traces: Vec<Trace>,
    }
    let group = |name| Group { name, traces: SIGNALS.iter().map(|&(signal, bits)| trace(name, signal, bits)).collect() };
    let groups: Vec<Group<'_>> = axes.iter().map(|&axis| group(axis)).collect();
    // GTKWave draws 2^-zoom units of time in a pixel
    let zoom = -(end_ps.max(1) as f64 / PIXELS).log2();
    let text = Environment::new().render_str(
        TEMPLATE,
        context! { vcd, groups, scope => SCOPE, zoom => format!("{zoom:.6}") },
    )?;
    Ok(text + "\n")
}

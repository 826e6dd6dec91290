//! A GTKWave save file for the VCD that [`VcdWriter`](crate::VcdWriter) writes.
//!
//! GTKWave drops a name that does not match without a word, so every name comes from the writer's own
//! table, range included.

use crate::error::TraceError;
use crate::waves::{SCOPE, SIGNALS};
use minijinja::{Environment, Value, context};

const TEMPLATE: &str = include_str!("../templates/gtkwave.gtkw");

/// Width of the wave area in the window of the template, in GTKWave's frames of 200 pixels.
const FRAMES: f64 = 4.7;

/// How a signal is drawn: the flags of a `@` line, a colour, and blank rows that give it height.
fn trace(axis: &str, name: &str, bits: u32) -> Value {
    // 28 binary, 88420 signed analog step, 90020 real analog interpolated, both scaled to all data
    let (flags, colour, rows) = match name {
        "step" => ("28", 2, 0),
        "dir" => ("28", 3, 0),
        "position" => ("88420", 4, 3),
        "v" => ("88420", 2, 3),
        "error_ns" => ("90020", 1, 3),
        _ => ("90020", 7, 3),
    };
    let range = if bits > 1 { format!("[{}:0]", bits - 1) } else { String::new() };
    context! { name => format!("{SCOPE}.{axis}.{name}{range}"), flags, colour, rows }
}

/// The save file: a group for each axis, zoomed so that `end_ps` is in sight.
///
/// `vcd` is the VCD's name as it is seen from the save file's folder.
///
/// # Errors
/// The template cannot be rendered.
pub fn save_file(vcd: &str, axes: &[&str], end_ps: u64) -> Result<String, TraceError> {
    let traces = |axis| SIGNALS.iter().map(|&(name, bits)| trace(axis, name, bits)).collect::<Vec<Value>>();
    let groups: Vec<Value> = axes.iter().map(|&axis| context! { name => axis, traces => traces(axis) }).collect();
    // GTKWave draws 2^-zoom units of time in a frame
    let zoom = -(end_ps.max(1) as f64 / FRAMES).log2();
    let text = Environment::new()
        .render_str(TEMPLATE, context! { vcd, groups, scope => SCOPE, zoom => format!("{zoom:.6}") })?;
    Ok(text + "\n")
}

//! Writes a GTKWave save file for the VCD that [`VcdWriter`](crate::VcdWriter) writes.
//!
//! GTKWave ignores a name that is not in the VCD, without a message. Every name therefore comes
//! from the writer's own table, with its range.

use crate::error::TraceError;
use crate::wave_format::{SCOPE, SIGNALS};
use minijinja::{Environment, Value, context};
use std::path::Path;

const TEMPLATE: &str = include_str!("../templates/gtkwave.gtkw");

/// Width of the wave area in the window of the template, in GTKWave's frames of 200 pixels.
const FRAMES: f64 = 4.7;

/// How a signal is drawn: the flags of a `@` line, a colour, and the blank rows that give it
/// height.
fn trace(axis: &str, name: &str, bits: u32) -> Value {
    // 28 is binary, 88420 a signed analog step, and 90020 a real that is interpolated. The latter
    // two are scaled to all data.
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

/// Returns the text of the save file. It has a group for each axis, and its zoom shows `length_ps`
/// from the beginning of the VCD.
///
/// `vcd` is the name of the VCD, relative to the folder of the save file.
///
/// # Errors
/// [`TraceError::Template`] if the template cannot be rendered.
pub fn save_file(vcd: &str, axes: &[&str], length_ps: u64) -> Result<String, TraceError> {
    let traces =
        |axis| SIGNALS.iter().map(|&(name, bits)| trace(axis, name, bits)).collect::<Vec<Value>>();
    let groups: Vec<Value> =
        axes.iter().map(|&axis| context! { name => axis, traces => traces(axis) }).collect();
    // GTKWave takes a relative name for one in the folder where it was started. From two absolute
    // names it computes the way from the save file to the VCD, and goes it from where this file is.
    let folder = if Path::new(vcd).is_absolute() { "" } else { "/carrystep/" };
    // GTKWave draws 2^-zoom units of time in a frame.
    let zoom = -(length_ps.max(1) as f64 / FRAMES).log2();
    let text = Environment::new().render_str(
        TEMPLATE,
        context! { folder, vcd, groups, scope => SCOPE, zoom => format!("{zoom:.6}") },
    )?;
    Ok(text + "\n")
}

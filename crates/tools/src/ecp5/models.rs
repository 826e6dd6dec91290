//! Simulation models of an ECP5's cells: those of yosys, and our own of the clock cells and the
//! block RAM.

use crate::SynthesisError;
use crate::cells::{self, ECP5, FirstContents, pattern};
use regex::Captures;

const CELLS: &str = include_str!("cells.v");

/// Cells that occur within yosys' models of others: a carry cell is made of LUTs.
const IN_OTHERS: &str = " LUT2 LUT4";

/// Verilog with the models of all its cells, for simulators.
///
/// # Errors
/// [`SynthesisError`] if yosys' models are not found.
pub fn simulated(verilog: &str) -> Result<String, SynthesisError> {
    // yosys' model of the block RAM has ports and timings, but no function.
    let others = verilog.replace("DP16KD", "");
    let models = cells::models(&ECP5, &(others + IN_OTHERS))?;
    Ok(format!("{models}{}{verilog}", own()))
}

/// Our own models with their macros expanded: `BITS(ADA, 14)` is `ADA0, ADA1, ...`, and `ALL(ADA,
/// 14)` the same with the highest bit first. `INITVALS` declares the parameters of the first
/// contents, and `ALL_INITVALS` are all of them as one number.
fn own() -> String {
    let count = |found: &Captures<'_>| found[2].parse().unwrap_or(0);
    let bits = |found: &Captures<'_>| {
        (0..count(found)).map(|bit: u32| format!("{}{bit}", &found[1])).collect::<Vec<_>>()
    };
    let text = pattern(r"\bBITS\((\w+), (\d+)\)")
        .replace_all(CELLS, |found: &Captures<'_>| bits(found).join(", "));
    let text = pattern(r"\bALL\((\w+), (\d+)\)").replace_all(&text, |found: &Captures<'_>| {
        bits(found).into_iter().rev().collect::<Vec<_>>().join(", ")
    });
    let first = FirstContents::of("INITVAL_", 320);
    text.replace("ALL_INITVALS", &first.all).replace("INITVALS", &first.declared)
}

//! Simulation models of a Gowin part's cells: those of yosys, and our own of the clock cells and the
//! block RAMs.

use crate::SynthesisError;
use crate::cells::{self, FirstContents, GOWIN, pattern};

const CELLS: &str = include_str!("cells.v");

/// Cells that occur within yosys' models of others.
const IN_OTHERS: &str = " MUX2";

/// Verilog with the models of all its cells, for simulators.
///
/// # Errors
/// [`SynthesisError`] if yosys' models are not found.
pub fn simulated(verilog: &str) -> Result<String, SynthesisError> {
    // yosys' models of these block RAMs have ports, but no function.
    let others = pattern(r"\bSP(X9)?\b").replace_all(verilog, "").into_owned();
    let models = cells::models(&GOWIN, &(others + IN_OTHERS))?;
    Ok(format!("{models}{}{verilog}", own()))
}

/// Our own models with their macros expanded. `INIT_RAMS(256)` declares the parameters of the first
/// contents, of 256 bits each, and `ALL_INIT_RAMS` are all of them as one number. `BYTES(data)` are
/// the bytes of eight bits in data that has nine a byte, and `NINES(data)` is the reverse.
fn own() -> String {
    let eight = |from: usize| format!("$1[{}:{}]", from + 7, from);
    let bytes = [27, 18, 9, 0].map(eight).join(", ");
    let nines = [24, 16, 8, 0].map(|from| format!("1'b0, {}", eight(from))).join(", ");
    let text = pattern(r"\bBYTES\((\w+)\)").replace_all(CELLS, format!("{{{bytes}}}"));
    let text = pattern(r"\bNINES\((\w+)\)").replace_all(&text, format!("{{{nines}}}"));
    let [eight, nine] = [256, 288].map(|bits| FirstContents::of("INIT_RAM_", bits));
    text.replace("ALL_INIT_RAMS", &nine.all)
        .replace("INIT_RAMS(256)", &eight.declared)
        .replace("INIT_RAMS(288)", &nine.declared)
}

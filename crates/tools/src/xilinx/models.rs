//! Simulation models of a Spartan's cells: those of yosys, and our own of clock cells and block
//! RAMs, for which yosys has none.

use crate::SynthesisError;
use crate::cells::{self, XILINX, pattern};
use regex::Captures;
use std::collections::BTreeSet;

const CLOCKS: &str = include_str!("clocks.v");
const BLOCK_RAMS: &str = include_str!("block_rams.v");
const SPARTAN_3: &str = include_str!("spartan_3_block_ram.v");

/// Verilog with the models of all its cells, for simulators.
///
/// # Errors
/// [`SynthesisError`] if yosys' models are not found.
pub fn simulated(verilog: &str) -> Result<String, SynthesisError> {
    // yosys' models of block RAMs have ports and timings, but no function.
    let others = pattern(r"\bRAMB\w+").replace_all(verilog, "");
    let models = cells::models(&XILINX, &others)?;
    Ok(format!("{models}{CLOCKS}{}{}{verilog}", with_inits(BLOCK_RAMS), spartan_3(verilog)))
}

/// Expands macros: `INITS(32, 4)` declares `INIT_00` to `INIT_1F` and `INITP_00` to `INITP_03`;
/// `ALL_INITS(32)` is all of them as one number.
fn with_inits(models: &str) -> String {
    let count = |found: &Captures<'_>, group: usize| found[group].parse().unwrap_or(0);
    let text = pattern(r"\bINITS\((\d+), (\d+)\)").replace_all(models, |found: &Captures<'_>| {
        declared("INIT", count(found, 1)) + &declared("INITP", count(found, 2))
    });
    let text = pattern(r"ALL_(INITP?)S\((\d+)\)")
        .replace_all(&text, |found: &Captures<'_>| together(&found[1], count(found, 2)));
    text.into_owned()
}

fn declared(prefix: &str, count: u32) -> String {
    let names: Vec<String> =
        (0..count).map(|number| format!("{prefix}_{number:02X} = 0")).collect();
    format!("parameter [255:0] {}, ", names.join(", "))
}

fn together(prefix: &str, count: u32) -> String {
    let names: Vec<String> =
        (0..count).rev().map(|number| format!("{prefix}_{number:02X}")).collect();
    format!("{{{}}}", names.join(", "))
}

/// The models of a Spartan-3's block RAMs that a design uses: one cell for each pair of widths.
fn spartan_3(verilog: &str) -> String {
    let cell = pattern(r"\bRAMB16_S(\d+)(?:_S(\d+))?\b");
    let used: BTreeSet<(&str, u32, Option<u32>)> = cell
        .captures_iter(verilog)
        .filter_map(|found| {
            let width = |group| found.get(group)?.as_str().parse().ok();
            Some((found.get(0)?.as_str(), width(1)?, width(2)))
        })
        .collect();
    let with_letters = pattern(r"\b(CLK|EN|SSR|WE|ADDR|DIP?|DOP?|INIT_|SRVAL_|WRITE_MODE_)A\b");
    let cells = used.into_iter().map(|(name, a, b)| {
        let cell = [("A", a), ("B", b.unwrap_or(1))].into_iter().fold(
            with_inits(SPARTAN_3).replace("NAME", name),
            |text, (port, width)| {
                let log = if width < 9 { width.ilog2() } else { (width / 9 * 8).ilog2() };
                text.replace(&format!("WIDTH_{port}"), &width.to_string())
                    .replace(&format!("LOG_{port}"), &log.to_string())
            },
        );
        // The port names of a single-port RAM have no letter at their end.
        let single = |found: &Captures<'_>| found[1].trim_end_matches('_').to_owned();
        if b.is_some() { cell } else { with_letters.replace_all(&cell, single).into_owned() }
    });
    cells.collect()
}

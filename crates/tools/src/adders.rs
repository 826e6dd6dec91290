//! `hdl-out/adders.md`: what engines with several adders take of a part, and the clock that they
//! reach. Rows, measurement and page.

use crate::SynthesisError;
use crate::board::{BuildJob, Built, build};
use crate::resources::failed;
use crate::xilinx;
use carrystep_boards::{Board, Mapped, block_rams, board};
use carrystep_core::EngineBuild;
use carrystep_core::tick::mhz;
use carrystep_files::SourceText;
use carrystep_verilog::{Gateware, shipped_machine};

/// Path of the page, from the root of the workspace.
pub const PAGE: &str = "hdl-out/adders.md";

/// The gateware of a board with a number of adders, in the shortest tick of its clock in four
/// phases.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Row {
    /// Name of the board; the part is its first.
    pub board: &'static str,
    /// Clock, Hz.
    pub clock_hz: u64,
    /// Number of adders.
    pub adders: usize,
    /// Budget of LUTs, counted with those of carry chains.
    pub budget: u32,
}

const fn row(board: &'static str, clock_hz: u64, adders: usize, budget: u32) -> Row {
    Row { board, clock_hz, adders, budget }
}

/// All rows of the page.
pub const ROWS: [Row; 9] = [
    row("orangecrab", 64_000_000, 1, 1550),
    row("orangecrab", 64_000_000, 2, 2200),
    row("orangecrab", 64_000_000, 6, 4200),
    row("colorlight-i5", 62_500_000, 6, 4200),
    row("tang-nano-20k", 48_000_000, 1, 1800),
    row("tang-nano-20k", 48_000_000, 2, 2300),
    row("arty-s7", 64_000_000, 1, 900),
    row("arty-s7", 64_000_000, 2, 1300),
    row("arty-s7", 64_000_000, 6, 2750),
];

/// What the tools make of a row.
pub enum Made {
    /// A bitstream.
    Placed(Built),
    /// The cells of yosys: only the vendor's tools place the part.
    Mapped(Mapped),
}

/// Stands in the place of the clock where nothing was placed.
const NOT_PLACED: &str = "not placed";

impl Row {
    fn board(&self) -> Result<&'static Board, SynthesisError> {
        board(self.board).map_err(failed)
    }

    /// The gateware of the row.
    ///
    /// # Errors
    /// [`SynthesisError::Gateware`] if there is none.
    fn gateware(&self) -> Result<Gateware<'static>, SynthesisError> {
        let board = self.board()?;
        let shipped = shipped_machine(board, &board.clocks[0]).map_err(failed)?;
        let (_, axes) = shipped.split_once("[[machine.axis]]").unwrap_or_default();
        let baud = board.uart(self.clock_hz).map_err(failed)?.baud();
        let Self { clock_hz, adders, .. } = self;
        let text = format!(
            "[machine]\nclock_hz = {clock_hz}\nphases = 4\nadders = {adders}\n\n\
             [machine.guard]\nlimits = \"none\"\n\n[machine.link]\nbaud = {baud}\n\n[[machine.axis]]{axes}"
        );
        let machine = SourceText { path: "machine.toml".into(), text: text.into() };
        Gateware::new(board, &board.parts[0], machine).map_err(failed)
    }

    /// The family by the name of `synth_xilinx`, if only the vendor's tools place its parts.
    fn unplaced(&self) -> Result<Option<&'static str>, SynthesisError> {
        let facts = self.board()?.family.facts();
        Ok(facts.yosys().filter(|_| facts.toolchain().by_hand.is_some()))
    }

    /// Builds the row's gateware to a bitstream, or to cells where no open tool places the part.
    ///
    /// # Errors
    /// [`SynthesisError`] if a tool is missing or fails.
    pub fn made(&self) -> Result<Made, SynthesisError> {
        let gateware = self.gateware()?;
        let files = gateware.files().map_err(failed)?;
        let end = self.board()?.family.facts().toolchain().constraints_end();
        let texts = |extension: &str| -> String {
            let files = files.iter().filter(|file| file.name.ends_with(extension));
            files.map(|file| file.text.as_str()).collect()
        };
        let (verilog, top) = (texts(".v"), gateware.top());
        if let Some(family) = self.unplaced()? {
            return xilinx::cells(&verilog, &top, family).map(Made::Mapped);
        }
        let job = BuildJob {
            verilog: &verilog,
            top: &top,
            constraints: &texts(end),
            part: gateware.part(),
            clock_hz: self.clock_hz,
        };
        build(&job, &mut |_| {}).map(Made::Placed)
    }

    /// The line of the page, from what the tools have made of it.
    ///
    /// # Errors
    /// [`SynthesisError::Gateware`] if there is no such gateware.
    pub fn line(&self, made: &Made) -> Result<String, SynthesisError> {
        let has = self.board()?.parts[0].block_rams;
        let gateware = self.gateware()?;
        let computed = block_rams(gateware.build(), gateware.part().family());
        let (luts, block_rams, reached) = match made {
            Made::Placed(Built { size, mhz, seed, .. }) => {
                let fmax = (mhz * 10.0).floor() / 10.0;
                (size.logic_cells, size.block_rams, format!("{fmax:.1} | {seed}"))
            }
            // yosys counts block RAMs of two sizes; the part has only the larger ones.
            Made::Mapped(Mapped { luts, block_rams, .. }) => {
                let is_computed = *block_rams == computed.of_all_kinds;
                let taken = if is_computed { computed.whole() } else { *block_rams };
                (*luts, taken, format!("{NOT_PLACED} | "))
            }
        };
        let (key, budget) = (self.key()?, self.budget);
        Ok(format!("{key} {luts} ({budget}) | {block_rams} of {has} | {reached} |\n"))
    }

    /// Beginning of the line.
    fn key(&self) -> Result<String, SynthesisError> {
        let (gateware, board) = (self.gateware()?, self.board()?);
        let EngineBuild { timebase, adders, .. } = gateware.build();
        Ok(format!(
            "| `{}` | {} | {adders} | {} | {} |",
            board.name,
            board.parts[0].ordered(),
            timebase.tick_ns(),
            mhz(self.clock_hz)
        ))
    }
}

/// The page with these lines, one for each of [`ROWS`].
pub fn page_of(lines: &str) -> String {
    format!(
        "\
# Several adders

Written by `cargo xtask adders`. Line, link and engine of the shipped machine's six axes on the pins
of the board, without limits, with queues of seven segments, at the shortest tick in four phases. By
the tools of [boards.md](boards.md), with the first of five seeds that reaches the clock. LUTs are
counted with those of carry chains; their budget is in brackets. A Spartan-7 is not placed: LUTs by
yosys (`synth_xilinx -nowidelut -flatten`), without carry chains. None was ever tried on real
hardware.

| board | part | adders | tick, ns | clock, MHz | LUTs (budget) | block RAMs | Fmax, MHz | seed |
|---|---|---|---|---|---|---|---|---|
{lines}"
    )
}

/// Checks that a page has exactly these rows, each within its budget and at its clock, with as many
/// block RAMs as [`block_rams`] tells.
///
/// # Errors
/// A sentence that names the row that is missing or wrong.
pub fn check(page: &str) -> Result<(), String> {
    let lines = page.lines().filter(|line| line.starts_with("| `"));
    if lines.count() != ROWS.len() {
        return Err(format!("{PAGE} has other rows: run `cargo xtask adders`"));
    }
    for row in &ROWS {
        let key = row.key().map_err(|error| error.to_string())?;
        let wrong = |what: &str| format!("{PAGE}: {what} of {key}: run `cargo xtask adders`");
        let found = page.lines().find_map(|line| line.strip_prefix(&key));
        let cells: Vec<&str> = found.ok_or_else(|| wrong("no row"))?.split('|').collect();
        let number = |cell: usize| -> Option<f64> {
            cells.get(cell)?.split_whitespace().next()?.parse().ok()
        };
        if number(0).is_none_or(|luts| luts > f64::from(row.budget))
            || !cells[0].contains(&format!("({})", row.budget))
        {
            return Err(wrong("LUTs"));
        }
        let gateware = row.gateware().map_err(|error| error.to_string())?;
        let taken = block_rams(gateware.build(), gateware.part().family()).whole();
        if number(1) != Some(f64::from(taken)) {
            return Err(wrong("block RAMs"));
        }
        let is_placed = row.unplaced().map_err(|error| error.to_string())?.is_none();
        let reaches = number(2).is_some_and(|mhz| mhz * 1e6 >= row.clock_hz as f64);
        if is_placed && !reaches {
            return Err(wrong("the clock"));
        }
        if !is_placed && cells.get(2).is_none_or(|cell| cell.trim() != NOT_PLACED) {
            return Err(wrong("what is not placed"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ice40::Size;

    /// The page of rows that take this.
    fn page(luts: u32, block_rams_more: u32, mhz: f64) -> String {
        let line = |row: &Row| {
            let gateware = row.gateware().unwrap();
            let taken = block_rams(gateware.build(), gateware.part().family()).whole();
            let size = Size { logic_cells: luts, block_rams: taken + block_rams_more };
            let built = Built { size, seed: 1, mhz, icetime_mhz: None, bitstream: Vec::new() };
            let mapped = || {
                let block_rams =
                    block_rams(gateware.build(), gateware.part().family()).of_all_kinds;
                let luts = luts.min(row.budget);
                Mapped { luts, block_rams: block_rams + block_rams_more, ..Mapped::default() }
            };
            let unplaced = row.unplaced().unwrap().is_some();
            row.line(&if unplaced { Made::Mapped(mapped()) } else { Made::Placed(built) }).unwrap()
        };
        page_of(&ROWS.iter().map(line).collect::<String>())
    }

    #[test]
    fn page_is_checked_against_rows_and_budgets() {
        assert_eq!(check(&page(1500, 0, 64.0)), Ok(()));
        assert!(check(&page(1600, 0, 64.0)).unwrap_err().contains("LUTs"));
        assert!(check(&page(1500, 1, 64.0)).unwrap_err().contains("block RAMs"));
        assert!(check(&page(1500, 0, 63.9)).unwrap_err().contains("the clock"));
        let without = page(1500, 0, 64.0).replace("| 2 | 750 |", "| 2 | 751 |");
        assert!(check(&without).unwrap_err().contains("no row"));
    }
}

//! Writes `hdl-out/resources.md` from measurements, and reads it in the test that checks the
//! budgets.

use super::link::{LINES, LINK_BUDGET};
use super::measure::RowMeasurement;
use super::peers::PEERS;
use super::rows::{BESIDE_OTHERS, ECP5, EngineRow, FAMILIES, FamilyRow, GOWIN, ROWS, SEEDS};
use crate::ice40::Size;
use carrystep_boards::Mapped;

/// Path of the page, from the root of the workspace.
pub const PAGE: &str = "hdl-out/resources.md";

/// All that the page shows.
pub struct Measurements {
    /// Of the [`ROWS`].
    pub rows: Vec<RowMeasurement>,
    /// Of the [`LINES`].
    pub links: [Size; LINES.len()],
    /// Of the [`FAMILIES`].
    pub families: Vec<Mapped>,
    /// Of [`ECP5`].
    pub ecp5: Mapped,
    /// Of [`GOWIN`].
    pub gowin: Mapped,
    /// Of [`BESIDE_OTHERS`].
    pub beside_others: Vec<RowMeasurement>,
}

/// The page.
pub fn page(found: &Measurements) -> String {
    let Measurements { rows, links, families, ecp5, gowin, beside_others } = found;
    let mut text = format!(
        "# What the engine costs\n\n\
         Written by `cargo xtask resources` with yosys 0.70 and nextpnr 0.4;\n\
         `tests/system/engine_fits_its_budget.rs` fails where a change goes over budget.\n\
         The engine is that of `sim/six-axis.toml`, at the clock and tick of the row: third order, 64-bit \
         registers, queues of seven segments, 16 phases, guard, position registers, real drivers' timings.\n\
         Logic cells are those of the core alone; Fmax is that between registers of core and harness, the best of seeds {SEEDS:?}.\n\n\
         ## iCE40\n\n\
         {ICE40}\n\
         |---|---|---|---|---|---|---|---|---|\n"
    );
    for (row, found) in ROWS.iter().zip(rows) {
        text += &line(row, found);
    }
    text += "\nThe schedule needs the clocks of its time slots, and the least clock whose tick holds them and divides into phases.\n\
         *all*: with limits at both ends, both rows of inputs, latch, eight outputs, PWM and cuts, and queues of so many segments.\n\n\
         ## The host link\n\n\
         Beside the engine of the first row: the link and its line, each by itself.\n\n\
         | line | logic cells (budget) | block RAM |\n|---|---|---|\n";
    for (name, found) in LINES.iter().zip(links) {
        text += &link_line(name, found);
    }
    text += "\n## Xilinx\n\n\
         Cells by yosys 0.23 (`synth_xilinx -nowidelut -flatten`), which calls these families\n\
         experimental; not placed. The engine of the first row. A carry cell\n\
         is one bit in xc3s, four in the others. 12 of the 16 block RAMs in xc3s are the wheel's, \
         which is written bit by \
         bit: the boards of that family have it in LUTs\n(decision 38).\n\n\
         | family | LUTs (budget) | flip-flops | carry cells | block RAMs |\n|---|---|---|---|---|\n";
    for (family, found) in FAMILIES.iter().zip(families) {
        text += &cells_line(family, found);
    }
    text += &format!(
        "\n## ECP5\n\n\
         Engine, link and UART together, by yosys 0.23 (`synth_ecp5`): *all*, queues {} deep, {} MHz.\n\
         LUTs as nextpnr counts them: with two for each carry cell. The clock that is reached\n\
         on each board is in [boards.md](boards.md).\n\n\
         | family | LUTs (budget) | flip-flops | carry cells | block RAMs |\n|---|---|---|---|---|\n{}",
        ECP5.of.queue,
        ECP5.of.clock_hz / 1_000_000,
        cells_line(&ECP5, ecp5)
    );
    text += &format!(
        "\n## Gowin\n\n\
         The same by yosys 0.70 (`synth_gowin`), at {} MHz. LUTs as nextpnr counts them: with one for each carry cell.\n\n\
         | family | LUTs (budget) | flip-flops | carry cells | block RAMs |\n|---|---|---|---|---|\n{}",
        GOWIN.of.clock_hz / 1_000_000,
        cells_line(&GOWIN, gowin)
    );
    text += "\n## Beside others\n\n\
         Six axes on one flow: `synth_ice40` of yosys 0.23, nextpnr 0.4, HX8K, three seeds, median, the\n\
         core alone; none of the others has limits or a guard in it. Ours are placed for the clock of\n\
         their row. The scripts of the boards map ours by other commands (decision 114), to the cells of\n\
         the first table.\n\n\
         | core | ramp in hardware | pin timing enforced | queue | logic cells | Fmax, MHz |\n|---|---|---|---|---|---|\n";
    text += &beside(beside_others);
    text
}

const ICE40: &str = "| part | axes | tick | clock, MHz: has, needs | clocks per tick: has, needs | logic cells (budget) | block RAM | Fmax, MHz (each seed) | clock reached |";

/// Beginning of a row's line.
fn key(row: &EngineRow) -> String {
    let (part, axes, us) = (row.part, row.axes, row.tick_ns / 1000);
    let [mhz, least] = [row.clock_hz, row.clock_needed_hz()].map(|hz| hz / 1_000_000);
    let (has, needs) = (row.clocks_per_tick(), row.clocks_needed());
    let built = if row.all { format!(", all, {} deep", row.queue) } else { String::new() };
    format!(
        "| {} {}{built} | {axes} | {us} us | {mhz}, {least} | {has}, {needs} |",
        part.device, part.package
    )
}

fn line(row: &EngineRow, found: &RowMeasurement) -> String {
    let each: Vec<String> = found.mhz.iter().map(|mhz| format!("{mhz:.0}")).collect();
    let reached = if is_met(row, found) { "yes" } else { "**no**" };
    let (cells, rams, budget) =
        (found.size.logic_cells, found.size.block_rams, row.budget.logic_cells);
    format!(
        "{} {cells} ({budget}) | {rams} | {:.1} ({}) | {reached} |\n",
        key(row),
        found.best(),
        each.join(", ")
    )
}

/// Whether the best seed reaches the row's clock.
fn is_met(row: &EngineRow, found: &RowMeasurement) -> bool {
    found.best() * 1e6 >= row.clock_hz as f64
}

fn link_line(name: &str, found: &Size) -> String {
    format!(
        "| {name} | {} ({}) | {} |\n",
        found.logic_cells, LINK_BUDGET.logic_cells, found.block_rams
    )
}

fn cells_line(family: &FamilyRow, found: &Mapped) -> String {
    let (luts, budget) = (found.luts, family.budget.luts);
    format!(
        "| {} | {luts} ({budget}) | {} | {} | {} |\n",
        family.name, found.flip_flops, found.carries, found.block_rams
    )
}

/// The table of our engines beside other cores, sorted by size.
fn beside(ours: &[RowMeasurement]) -> String {
    let mut lines: Vec<(u32, String)> = PEERS
        .iter()
        .map(|peer| {
            let (queue, cells, mhz) = (peer.queue, peer.logic_cells, peer.mhz);
            (
                cells,
                format!(
                    "| {} | {} | {} | {queue} | {cells} | {mhz} |\n",
                    peer.core, peer.ramp, peer.pins
                ),
            )
        })
        .collect();
    lines.extend(BESIDE_OTHERS.iter().zip(ours).map(|(row, found)| {
        let (size, us) = (found.size, row.tick_ns / 1000);
        let name = format!("**carrystep**, {} axes, {us} us, guard included", row.axes);
        let queue = format!("7 deep, in {} block RAMs", size.block_rams);
        let cells = size.logic_cells;
        (
            cells,
            format!(
                "| {name} | 3rd order | all four, owes one step | {queue} | {cells} | {:.0} |\n",
                found.median()
            ),
        )
    }));
    lines.sort_by_key(|(cells, _)| *cells);
    lines.into_iter().map(|(_, line)| line).collect()
}

/// Checks that a page contains exactly these rows, within their budgets.
///
/// # Errors
/// A sentence that names the row that is missing, over budget, or different from its `met`.
pub fn check(page: &str) -> Result<(), String> {
    for row in &ROWS {
        let key = key(row);
        let rest = page.lines().find_map(|line| line.strip_prefix(&key));
        let rest =
            rest.ok_or_else(|| format!("{PAGE} has no row {key}: run `cargo xtask resources`"))?;
        let cells: u32 = number(rest).ok_or_else(|| format!("no logic cells in {key}{rest}"))?;
        let mut wrong = String::new();
        if cells > row.budget.logic_cells
            || !rest.contains(&format!("({})", row.budget.logic_cells))
        {
            wrong += " logic cells";
        }
        if rest.contains("| yes |") != row.met {
            wrong += " clock";
        }
        if !wrong.is_empty() {
            return Err(format!("{PAGE}:{wrong} of {key}{rest} are not those of {row:?}"));
        }
    }
    for name in LINES {
        let rest = page.lines().find_map(|line| line.strip_prefix(&format!("| {name} |")));
        let cells = rest.and_then(number).ok_or_else(|| format!("{PAGE} has no row {name}"))?;
        if cells > LINK_BUDGET.logic_cells {
            return Err(format!(
                "{PAGE}: {cells} logic cells of the link over {name} are over budget"
            ));
        }
    }
    for family in FAMILIES.iter().chain([&ECP5, &GOWIN]) {
        let rest = page.lines().find_map(|line| line.strip_prefix(&format!("| {} |", family.name)));
        let luts =
            rest.and_then(number).ok_or_else(|| format!("{PAGE} has no row {}", family.name))?;
        if luts > family.budget.luts {
            return Err(format!("{PAGE}: {} LUTs in {} are over budget", luts, family.name));
        }
    }
    Ok(())
}

/// The first number in a line.
fn number(text: &str) -> Option<u32> {
    let digits = text.trim_start().split(|c: char| !c.is_ascii_digit()).next()?;
    digits.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Measurements that use the whole budget of a row.
    fn found(row: &EngineRow) -> RowMeasurement {
        let mhz = row.clock_hz as f64 / 1e6 + if row.met { 0.0 } else { -1.0 };
        RowMeasurement { size: row.budget, mhz: [mhz - 2.0, mhz, mhz - 1.0] }
    }

    #[test]
    fn page_is_checked_against_rows_and_budgets() {
        let mut all = Measurements {
            rows: ROWS.map(|row| found(&row)).to_vec(),
            links: [LINK_BUDGET; LINES.len()],
            families: FAMILIES.map(|family| family.budget).to_vec(),
            ecp5: ECP5.budget,
            gowin: GOWIN.budget,
            beside_others: BESIDE_OTHERS.map(|row| found(&row)).to_vec(),
        };
        assert_eq!(check(&page(&all)), Ok(()));
        all.rows[0].size.logic_cells += 1;
        assert!(check(&page(&all)).is_err(), "over budget");
        all.rows[0] = found(&ROWS[0]);
        all.rows[0].mhz = [1.0; 3];
        assert!(check(&page(&all)).is_err(), "too slow");
        all.rows[0] = found(&ROWS[0]);
        all.ecp5.luts += 1;
        assert!(check(&page(&all)).is_err(), "over budget on an ECP5");
        all.ecp5.luts -= 1;
        all.gowin.luts += 1;
        assert!(check(&page(&all)).is_err(), "over budget on a Gowin part");
    }
}

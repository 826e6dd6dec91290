//! `cargo xtask resources` measures every row and writes `hdl-out/resources.md`. With the argument
//! `boards` (from `cargo xtask long boards`) it builds all boards but those of Gowin, and writes
//! `hdl-out/boards.md` and the figures that `carrystep boards` shows. With names behind it, it builds
//! these boards only.

use carrystep_boards::{MEASURED_AT, boards as all_boards};
use carrystep_tools::board::page;
use carrystep_tools::resources::{self, FAMILIES, PAGE, ROWS, RowMeasurement};
use carrystep_tools::xilinx;
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

fn say(line: &str) {
    // If standard error cannot be written, there is nowhere to report it.
    let _ = writeln!(std::io::stderr(), "{line}");
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let written = match arguments.split_first() {
        Some((what, names)) if what == "boards" => boards(names),
        _ => resources(),
    };
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            say(&message);
            ExitCode::FAILURE
        }
    }
}

/// Text above the figures of the boards.
const HEAD: &str = "# What the shipped gateware takes of each board, on its first part with its first clock. Written by `cargo xtask long boards`.\n\n";

/// Builds these boards, or all but those of Gowin. A board that misses its clock is entered in the table, and is an
/// error.
fn boards(names: &[String]) -> Result<(), String> {
    let all = page::measure(names, &say).map_err(|error| error.to_string())?;
    let text = page::page(&all);
    let data = toml::to_string(&all).map_err(|error| error.to_string())?;
    write(MEASURED_AT, &(HEAD.to_owned() + &data))?;
    write(page::PAGE, &text)?;
    if text.contains("**no**") {
        return Err(format!("{}: a clock is not reached", page::PAGE));
    }
    let unasked = || all_boards().iter().filter(|board| page::is_measured_unasked(board)).count();
    say(&format!(
        "FIGURES {} boards, each iCE40 on its pins and in time, each ECP5 with five seeds of five",
        if names.is_empty() { unasked() } else { names.len() }
    ));
    Ok(())
}

/// Writes a file that appears completely or not at all.
fn write(page: &str, text: &str) -> Result<(), String> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(page);
    let next = path.with_extension("new");
    std::fs::write(&next, text)
        .and_then(|()| std::fs::rename(&next, &path))
        .map_err(|error| error.to_string())
}

/// Measures all rows, writes the page, and then checks it against the budgets.
fn resources() -> Result<(), String> {
    let (mut rows, mut families) = (Vec::new(), Vec::new());
    for row in &ROWS {
        let found = RowMeasurement::of(row).map_err(|error| error.to_string())?;
        say(&format!("{} at {} ns: {found:?}", row.part.device, row.tick_ns));
        rows.push(found);
    }
    for family in &FAMILIES {
        let verilog = resources::verilog(&family.of).map_err(|error| error.to_string())?;
        let found = xilinx::cells(&verilog, carrystep_verilog::ENGINE_NAME, family.name);
        let found = found.map_err(|error| error.to_string())?;
        say(&format!("{}: {found:?}", family.name));
        families.push(found);
    }
    let links = resources::links().map_err(|error| error.to_string())?;
    say(&format!("the link: {links:?}"));
    let ecp5 = resources::ecp5().map_err(|error| error.to_string())?;
    say(&format!("ECP5: {ecp5:?}"));
    let gowin = resources::gowin().map_err(|error| error.to_string())?;
    say(&format!("Gowin: {gowin:?}"));
    let text = resources::page(&rows, &links, &families, &ecp5, &gowin);
    write(PAGE, &text)?;
    resources::check(&text)?;
    // A line for the table of `cargo xtask long`.
    say(&format!(
        "FIGURES {} rows of iCE40, {} of Xilinx, one each of ECP5 and Gowin, all within its budget",
        rows.len(),
        families.len()
    ));
    Ok(())
}

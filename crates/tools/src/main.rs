//! `cargo xtask resources` measures every row and writes `hdl-out/resources.md`. With the argument
//! `boards` (from `cargo xtask long boards`) it builds all boards but those of Gowin, and writes
//! `hdl-out/boards.md` and the figures that `carrystep boards` shows. With names behind it, it builds
//! these boards only. With `adders` (from `cargo xtask adders`) it writes `hdl-out/adders.md`. With
//! `unisims FOLDER` (from `cargo xtask unisims`) it checks the clock modules
//! of the Spartans on the models in a folder.

use carrystep_boards::{MEASURED_AT, board, boards as all_boards};
use carrystep_core::tick::mhz;
use carrystep_tools::adders;
use carrystep_tools::board::page;
use carrystep_tools::clock_modules::{CellModels, clock_module, simulated, spartans};
use carrystep_tools::resources::{self, FAMILIES, Measurements, PAGE, ROWS, RowMeasurement};
use carrystep_tools::{SynthesisError, xilinx};
use std::error::Error;
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
        Some((what, [])) if what == "adders" => several_adders(),
        Some((what, [folder, names @ ..])) if what == "unisims" => unisims(folder, names),
        _ => resources(),
    };
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say(&error.to_string());
            match error.downcast_ref() {
                Some(SynthesisError::Missing(_)) => ExitCode::from(MISSING),
                _ => ExitCode::FAILURE,
            }
        }
    }
}

/// Exit code if a program is not installed, that of `carrystep` too.
const MISSING: u8 = 3;

type Outcome = Result<(), Box<dyn Error>>;

/// Text above the figures of the boards.
const HEAD: &str = "# What the shipped gateware takes of each board, on its first part with its first clock. Written by `cargo xtask long boards`.\n\n";

/// Builds these boards, or all but those of Gowin. A board that misses its clock is entered in the
/// table, and is an error.
fn boards(names: &[String]) -> Outcome {
    let all = page::measure(names, &say)?;
    let text = page::page(&all);
    let data = toml::to_string(&all)?;
    write(MEASURED_AT, &(HEAD.to_owned() + &data))?;
    write(page::PAGE, &text)?;
    if text.contains("**no**") {
        return Err(format!("{}: a clock is not reached", page::PAGE).into());
    }
    let unasked = || all_boards().iter().filter(|board| page::is_measured_unasked(board)).count();
    say(&format!(
        "FIGURES {} boards, each iCE40 on its pins and in time, each ECP5 with five seeds of five",
        if names.is_empty() { unasked() } else { names.len() }
    ));
    Ok(())
}

/// Checks the clock modules of these boards, or of all Spartans, on the models in a folder. All are
/// tried; the error counts those that failed.
fn unisims(folder: &str, names: &[String]) -> Outcome {
    let models = CellModels::in_folder(Path::new(folder))?;
    let asked = names.iter().map(|name| board(name)).collect::<Result<Vec<_>, _>>()?;
    if let Some(other) = asked.iter().find(|one| spartans().all(|board| board.name != one.name)) {
        return Err(format!("{} has no Spartan", other.name).into());
    }
    let is_asked = |name: &String| names.is_empty() || names.contains(name);
    let (mut passed, mut failed) = (0, 0);
    for board in spartans().filter(|board| is_asked(&board.name)) {
        let found = simulated(board, &clock_module(board)?, &models)?;
        let wanted = mhz(board.clocks[0].clock_hz);
        let said = match found {
            Ok(figures) => {
                passed += 1;
                format!("passed: {figures}")
            }
            Err(fault) => {
                failed += 1;
                format!("FAILED: {fault}")
            }
        };
        say(&format!("{} ({wanted} MHz) {said}", board.name));
    }
    say(&format!("{passed} passed, {failed} failed"));
    if failed > 0 { Err("not every clock module is right on these models".into()) } else { Ok(()) }
}

/// Writes a file that appears completely or not at all.
fn write(page: &str, text: &str) -> Outcome {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(page);
    let next = path.with_extension("new");
    std::fs::write(&next, text).and_then(|()| std::fs::rename(&next, &path))?;
    Ok(())
}

/// Builds the gateware of all rows of several adders, writes their page, and then checks it.
fn several_adders() -> Outcome {
    let mut lines = String::new();
    for row in &adders::ROWS {
        let line = row.line(&row.made()?)?;
        say(line.trim());
        lines.push_str(&line);
    }
    let text = adders::page_of(&lines);
    write(adders::PAGE, &text)?;
    Ok(adders::check(&text)?)
}

/// Measures all rows, writes the page, and then checks it against the budgets.
fn resources() -> Outcome {
    let (mut rows, mut families) = (Vec::new(), Vec::new());
    for row in &ROWS {
        let found = RowMeasurement::of(row)?;
        say(&format!("{} at {} ns: {found:?}", row.part.device, row.tick_ns));
        rows.push(found);
    }
    for family in &FAMILIES {
        let verilog = resources::verilog(&family.of)?;
        let found = xilinx::cells(&verilog, carrystep_verilog::ENGINE_NAME, family.name);
        let found = found?;
        say(&format!("{}: {found:?}", family.name));
        families.push(found);
    }
    let links = resources::links()?;
    say(&format!("the link: {links:?}"));
    let ecp5 = resources::ecp5()?;
    say(&format!("ECP5: {ecp5:?}"));
    let gowin = resources::gowin()?;
    say(&format!("Gowin: {gowin:?}"));
    let as_others = resources::BESIDE_OTHERS.iter().map(RowMeasurement::as_others);
    let beside_others = as_others.collect::<Result<Vec<_>, _>>()?;
    say(&format!("as other cores: {beside_others:?}"));
    let [all, xilinx] = [rows.len(), families.len()];
    let text = resources::page(&Measurements { rows, links, families, ecp5, gowin, beside_others });
    write(PAGE, &text)?;
    resources::check(&text)?;
    // A line for the table of `cargo xtask long`.
    say(&format!(
        "FIGURES {all} rows of iCE40, {xilinx} of Xilinx, one each of ECP5 and Gowin, all within its budget"
    ));
    Ok(())
}

//! `cargo xtask resources`: measures every row and writes `hdl-out/resources.md`.

use carrystep_synthesis::resources::{self, FAMILIES, Measured, PAGE, ROWS};
use carrystep_synthesis::xilinx;
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

fn say(line: &str) {
    // Nobody is left to tell if this fails.
    let _ = writeln!(std::io::stderr(), "{line}");
}

fn main() -> ExitCode {
    match write() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            say(&format!("resources: {message}"));
            ExitCode::FAILURE
        }
    }
}

/// The page is written as it was measured, then held against its budgets.
fn write() -> Result<(), String> {
    let (mut rows, mut families) = (Vec::new(), Vec::new());
    for row in &ROWS {
        let found = Measured::of(row).map_err(|error| error.to_string())?;
        say(&format!("{} at {} ns: {found:?}", row.part.device, row.tick_ns));
        rows.push(found);
    }
    for family in &FAMILIES {
        let verilog = resources::verilog(&family.of).map_err(|error| error.to_string())?;
        let found = xilinx::cells(&verilog, carrystep_export::ENGINE_NAME, family.name);
        let found = found.map_err(|error| error.to_string())?;
        say(&format!("{}: {found:?}", family.name));
        families.push(found);
    }
    let links = resources::links().map_err(|error| error.to_string())?;
    say(&format!("the link: {links:?}"));
    let text = resources::page(&rows, &links, &families);
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    // Whole or not at all.
    let next = root.join(format!("{PAGE}.new"));
    std::fs::write(&next, &text)
        .and_then(|()| std::fs::rename(&next, root.join(PAGE)))
        .map_err(|error| error.to_string())?;
    resources::check(&text)?;
    // For the row of `cargo xtask long`.
    say(&format!("FIGURES {} rows of iCE40, {} of Xilinx, each within its budget", rows.len(), families.len()));
    Ok(())
}

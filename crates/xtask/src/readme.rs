//! The parts of the README and of `hdl-out/` that show the demo: generated on demand, compared in
//! every test run.

use crate::decisions;
use crate::shell::{self, TaskResult};
use std::fs;
use std::path::PathBuf;

const BEGIN: &str = "<!-- `cargo xtask readme` writes from here ... -->";
const END: &str = "<!-- ... to here -->";
const PLOT: &str = "docs/pictures/demo.svg";
const WAVEFORM: &str = "docs/pictures/demo-waveform.png";
const REPORT: &str = "docs/pictures/report.png";

/// Script that makes GTKWave save a picture of its window.
const GRAB: &str = "gtkwave::/Edit/UnHighlight_All\ngtkwave::/File/Grab_To_File docs/pictures/demo-waveform.png\nexit\n";

/// Generates `hdl-out/` and the files that are made from tables: register map, pages of boards,
/// JSON Schemas. The list of boards in `docs/SUMMARY.md` follows.
pub fn generate() -> TaskResult {
    shell::run_with(
        &[("CARRYSTEP_WRITE_SCHEMAS", "1")],
        "cargo",
        &["test", "--quiet", "--release", "--workspace", "--bin", "carrystep", "documents::"],
    )?;
    shell::run(
        "cargo",
        &["run", "--quiet", "--release", "-p", "carrystep-verilog", "--example", "generated"],
    )?;
    decisions::write()
}

/// Fails if the README or the committed plot differs from the current output of the demo.
pub fn check() -> TaskResult {
    let (table, plot) = demo()?;
    let stale =
        |what: &str| Err(format!("{what} is not what the demo gives: run `cargo xtask readme`"));
    if !read("README.md")?.contains(&block(&table)) {
        return stale("the table in README.md");
    }
    if read(PLOT)? != plot {
        return stale(PLOT);
    }
    for picture in [WAVEFORM, REPORT] {
        if !shell::root().join(picture).is_file() {
            return stale(picture);
        }
    }
    shell::say("README: true");
    Ok(())
}

/// Writes the table of the README and the pictures.
pub fn write() -> TaskResult {
    let (table, plot) = demo()?;
    let readme = read("README.md")?;
    let (before, rest) =
        readme.split_once(BEGIN).ok_or("README.md has lost its mark for the table")?;
    let (_, after) = rest.split_once(END).ok_or("README.md has lost the end of its table")?;
    save("README.md", &format!("{before}{}{after}", block(&table)))?;
    fs::create_dir_all(shell::root().join("docs/pictures")).map_err(|error| error.to_string())?;
    save(PLOT, &plot)?;
    waveform()?;
    report()
}

/// The table of the demo, and its plot.
fn demo() -> Result<(String, String), String> {
    let table = shell::carrystep(&["demo"])?;
    Ok((table, read("sim/out/demo/demo.svg")?))
}

fn block(table: &str) -> String {
    format!("{BEGIN}\n\n```text\n$ cargo run --release -- demo\n{}\n```\n\n{END}", table.trim_end())
}

/// Saves a picture of the waveform in GTKWave with the save file that the demo writes.
fn waveform() -> TaskResult {
    for (tool, package) in [("gtkwave", "gtkwave"), ("xvfb-run", "xvfb xauth")] {
        if !shell::is_there(tool) {
            return Err(format!(
                "{tool} is missing for the picture: sudo apt-get install {package}"
            ));
        }
    }
    let script = shell::root().join("sim/out/grab.tcl");
    fs::write(&script, GRAB).map_err(|error| format!("{}: {error}", script.display()))?;
    let screen = "-screen 0 1600x1100x24";
    let show = [
        "-a",
        "-s",
        screen,
        "gtkwave",
        "-a",
        "sim/out/demo/demo.gtkw",
        "-S",
        "sim/out/grab.tcl",
        "sim/out/demo/demo.vcd",
    ];
    shell::run("xvfb-run", &show)
}

/// Saves a picture of the page of a job.
fn report() -> TaskResult {
    if !shell::is_there("chromium") {
        return Err("chromium is missing for the picture: sudo apt-get install chromium".into());
    }
    let page = shell::root().join("sim/out/report.html");
    let page = page.to_str().ok_or("the path of the folder is not UTF-8")?;
    let (job, machine) = ("sim/jobs/chords_and_star.ngc", "sim/jobs/machine.toml");
    shell::carrystep(&["simulate", job, "--machine", machine, "--report", page])?;
    let show = [
        "--headless=new",
        "--no-sandbox",
        "--disable-gpu",
        "--hide-scrollbars",
        "--virtual-time-budget=4000",
        "--window-size=1180,1760",
        &format!("--screenshot={REPORT}"),
        &format!("file://{page}"),
    ];
    shell::run("chromium", &show)
}

fn path(name: &str) -> PathBuf {
    shell::root().join(name)
}

fn read(name: &str) -> Result<String, String> {
    fs::read_to_string(path(name)).map_err(|error| format!("{name}: {error}"))
}

fn save(name: &str, text: &str) -> TaskResult {
    fs::write(path(name), text).map_err(|error| format!("{name}: {error}"))
}

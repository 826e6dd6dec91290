//! The command with programs: the deviation from the pulses, speeds, and memory with a million
//! lines.

use crate::{child, judge};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

const MACHINE: &str = "sim/jobs/machine.toml";
const RELIEF: &str = include_str!("../../../../sim/jobs/relief.ngc");
/// What is required.
const GROWTH: f64 = 1.3;
const MEGABYTES: f64 = 200.0;
const SIMULATED: f64 = 300.0;
const TO_GRBL: f64 = 1.10;
/// How many times the relief makes an hour.
const AN_HOUR: u64 = 15;

/// What `--json` prints.
fn document(carrystep: &Path, arguments: &[&str]) -> Result<Value, String> {
    let output = Command::new(carrystep).args(arguments).arg("--json").output();
    let output = output.map_err(|error| error.to_string())?;
    serde_json::from_slice(&output.stdout).map_err(|error| format!("{arguments:?}: {error}"))
}

/// The row of LinuxCNC's program, which has words that only the command reads.
pub fn chips(
    carrystep: &Path,
    (path, grbl): &(&str, f64),
    missed: &mut Vec<String>,
) -> Result<(), String> {
    if !Path::new(path).exists() {
        return Err(format!("{path} is missing: sudo apt-get install linuxcnc-uspace"));
    }
    let arguments = ["plan", path, "--machine", MACHINE, "--tolerance", "0.01"];
    let planned = document(carrystep, &arguments)?;
    let seconds = child::seconds(carrystep, &arguments)?;
    let of = |key: &str| planned[key].as_f64().unwrap_or(f64::NAN);
    let (ours, lines) = (of("total_s"), of("lines"));
    let ratio = ours / grbl;
    println!(
        "| `3D_Chips.ngc` | {ours:.3} | {grbl:.2} | {ratio:.3} | 292.1 | | | {:.0} | {:.0} |",
        lines / seconds,
        ours / seconds
    );
    judge(missed, ratio <= TO_GRBL, format!("3D_Chips.ngc: {ratio:.3} of Grbl's time"));
    Ok(())
}

/// The relief so many times, as one program.
fn relief(times: u64) -> String {
    let body: Vec<&str> = RELIEF.lines().filter(|line| *line != "M2").collect();
    let mut text = String::new();
    for _ in 0..times {
        body.iter().for_each(|line| {
            text.push_str(line);
            text.push('\n');
        });
    }
    text
}

/// The tables of commands: deviation from the pulses; processor time for each line from ten
/// thousand lines to a million; an hour; memory.
pub fn speed_and_memory(
    carrystep: &Path,
    smoke: bool,
    missed: &mut Vec<String>,
) -> Result<(), String> {
    println!("\n| program | tool from its pulses, mm | allowed, mm | pulses |\n|---|---|---|---|");
    let mut relief_s = f64::NAN;
    for name in ["square_and_arc", "chords_and_star", "trochoid", "relief"] {
        let job = format!("sim/jobs/{name}.ngc");
        let done = document(carrystep, &["simulate", &job, "--machine", MACHINE])?;
        relief_s = done["plan"]["total_s"].as_f64().unwrap_or(f64::NAN);
        let check = &done["check"];
        let of = |key: &str| check[key].as_f64().unwrap_or(f64::NAN);
        let (off, bound) = (of("deviation_mm"), of("deviation_bound_mm"));
        let axes = check["axes"].as_array().cloned().unwrap_or_default();
        let pulses: u64 = axes.iter().filter_map(|axis| axis["pulses"].as_u64()).sum();
        println!("| `{name}.ngc` | {off:.4} | {bound:.4} | {pulses} |");
        judge(missed, done["passed"] == true && off <= bound, format!("{name}: the check fails"));
    }
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let path = folder.path().join("relief.ngc");
    let file = path.to_string_lossy().into_owned();
    let write = |times| fs::write(&path, relief(times)).map_err(|error| error.to_string());
    let plan = ["plan", &file, "--machine", MACHINE];
    println!(
        "\n| lines of `plan JOB.ngc` | us a line | to the first | memory, MB |\n|---|---|---|---|"
    );
    let mut first = 0.0;
    for times in if smoke { &[1, 3][..] } else { &[1, 10, 97][..] } {
        write(*times)?;
        let lines = times * (RELIEF.lines().count() as u64 - 1);
        let mut seconds = child::seconds(carrystep, &plan)?;
        if *times < 50 {
            seconds = seconds.min(child::seconds(carrystep, &plan)?);
        }
        let each = seconds / lines as f64 * 1e6;
        if first == 0.0 {
            first = each;
        }
        let megabytes = child::memory(carrystep, &plan)? as f64 / 1e6;
        println!("| {lines} | {each:.1} | {:.2} | {megabytes:.0} |", each / first);
        judge(
            missed,
            each <= GROWTH * first,
            format!("{lines} lines: {:.2} of the time a line", each / first),
        );
        judge(missed, megabytes <= MEGABYTES, format!("{lines} lines: {megabytes:.0} MB"));
    }
    let times = if smoke { 1 } else { AN_HOUR };
    write(times)?;
    let begin = Instant::now();
    let processor = child::seconds(carrystep, &["simulate", &file, "--machine", MACHINE])?;
    let wall = begin.elapsed().as_secs_f64();
    let real = relief_s * times as f64 / wall;
    println!(
        "\n`simulate` of {times} times the relief, {:.0} s, with its check: {wall:.1} s on the clock \
         ({real:.0} times real time)\nand {processor:.1} s of processor time.",
        relief_s * times as f64
    );
    judge(missed, real >= SIMULATED, format!("simulate: {real:.0} x real time of {SIMULATED}"));
    Ok(())
}

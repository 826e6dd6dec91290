//! Runs the exported Verilog in Icarus Verilog.

use crate::tool::{self, ICARUS, VVP};
use crate::{Job, LevelError, Observer, Outcome, external};
use std::process::Command;

const BENCH: &str = include_str!("../bench/parallel_bench.v");

/// Everything on which the output of a run depends, apart from Icarus.
pub(crate) fn question(verilog: &str, job: &Job<'_>) -> Vec<String> {
    let numbers = format!("{} {} {}", job.axes, job.tail, job.max_clocks);
    vec![BENCH.to_owned(), verilog.to_owned(), external::program_text(job), numbers]
}

pub(crate) fn run(
    verilog: &str,
    job: &Job<'_>,
    observer: &mut Observer<'_>,
) -> Result<Outcome, LevelError> {
    tool::find(&ICARUS)?;
    let folder = tempfile::tempdir().map_err(tool::io("cannot make a temporary folder"))?;
    let path = |name: &str| folder.path().join(name);
    let write = |name: &str, text: &str| {
        std::fs::write(path(name), text).map_err(tool::io(format!("cannot write {name}")))
    };
    write("core.v", verilog)?;
    write("bench.v", BENCH)?;
    write("program.txt", &external::program_text(job))?;
    let files = ["-o", "bench.vvp", "bench.v", "core.v"];
    let numbers = [
        format!("-DAXES={}", job.axes),
        format!("-DCORE={}", carrystep_verilog::parallel_name(job.axes)),
    ];
    tool::complete(
        &ICARUS,
        Command::new(ICARUS.name)
            .arg("-g2005")
            .args(numbers)
            .args(files)
            .current_dir(folder.path()),
    )?;
    let mut simulation = Command::new(VVP.name);
    simulation.args(["-n", "bench.vvp", "+program=program.txt"]).current_dir(folder.path());
    simulation.args([format!("+tail={}", job.tail), format!("+max={}", job.max_clocks)]);
    external::observe(&ICARUS, &mut simulation, job, observer)
}

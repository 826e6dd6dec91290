//! The exported Verilog in Verilator. A compiled simulation is kept in the user's cache folder, by the hash of all
//! that went into it, because compiling takes far longer than most runs.

use crate::tool::{self, VERILATOR};
use crate::{Job, LevelError, Observer, Outcome, cache, external};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::process::Command;
use std::sync::Mutex;

const BENCH: &str = include_str!("../bench/six_axis_bench.cpp");
/// Verilator's own makefile says -Os behind all flags that are given, but for `OPT_FAST`: by that some have a third of the speed.
const OPTIONS: [&str; 9] =
    ["--cc", "--exe", "--build", "-O3", "--x-assign", "fast", "-Wno-fatal", "-MAKEFLAGS", "OPT_FAST=-O2"];

pub(crate) fn run(verilog: &str, job: &Job<'_>, observer: &mut Observer<'_>) -> Result<Outcome, LevelError> {
    let program_file = tempfile::NamedTempFile::new().map_err(tool::io("cannot make a temporary file"))?;
    let six_axis = Simulation { name: "six_axis", top: "carrystep_six_axis", bench: BENCH, options: &[] };
    let mut simulation = Command::new(six_axis.compiled(verilog)?);
    std::fs::write(&program_file, external::program_text(job)).map_err(tool::io("cannot write the program"))?;
    simulation.arg(program_file.path()).args([job.tail.to_string(), job.max_clocks.to_string()]);
    external::observe(&VERILATOR, &mut simulation, job, observer)
}

/// Two tests of a process may want the same simulation.
static COMPILER: Mutex<()> = Mutex::new(());

/// What Verilator makes of Verilog.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Simulation<'a> {
    /// Before the hash in its name.
    pub name: &'a str,
    /// The top module.
    pub top: &'a str,
    /// What drives it, in C++.
    pub bench: &'a str,
    /// And what else Verilator is told.
    pub options: &'a [&'a str],
}

impl Simulation<'_> {
    /// The compiled simulation of this Verilog, from the cache or made now.
    ///
    /// # Errors
    /// [`LevelError`]: Verilator is missing or fails.
    pub fn compiled(&self, verilog: &str) -> Result<PathBuf, LevelError> {
        let Self { name, top, bench, options } = *self;
        tool::find(&VERILATOR)?;
        let cache = cache::folder()?;
        let mut hash = DefaultHasher::new();
        (verilog, bench, top, options, OPTIONS, env!("CARGO_PKG_VERSION")).hash(&mut hash);
        let binary = cache.join(format!("{name}_{:016x}", hash.finish()));
        let _one_at_a_time = COMPILER.lock();
        if !cache::holds(&binary)? {
            let folder = tempfile::tempdir_in(&cache).map_err(tool::io("cannot make a temporary folder"))?;
            tool::put(folder.path(), &[("core.v", verilog), ("bench.cpp", bench)])?;
            let mut command = Command::new(VERILATOR.name);
            command.args(OPTIONS).args(options).args(["--top-module", top, "-o", "bench", "core.v", "bench.cpp"]);
            tool::complete(&VERILATOR, command.current_dir(folder.path()))?;
            let made = folder.path().join("obj_dir").join("bench");
            cache::only_ours(&made)?;
            // Whole or not at all: another run may be looking for it.
            std::fs::rename(made, &binary).map_err(tool::io("cannot keep the compiled simulation"))?;
        }
        Ok(binary)
    }
}

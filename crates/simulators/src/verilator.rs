//! Simulates the exported Verilog in Verilator. Compiling takes far longer than most runs, so a
//! compiled simulation is kept in the user's cache directory, under the hash of everything that it
//! was made from.

mod runtime;

use crate::tool::{self, VERILATOR};
use crate::{Job, LevelError, Observer, Outcome, cache, external};
use runtime::Runtime;
use sha2::{Digest, Sha256};
use std::path::PathBuf;
use std::process::Command;
use std::sync::Mutex;

const BENCH: &str = include_str!("../bench/parallel_bench.cpp");
/// Verilator's makefile adds -Os behind all other flags, unless `OPT_FAST` is set. With -Os some
/// simulations reach only a third of the speed.
const OPTIONS: [&str; 9] = [
    "--cc",
    "--exe",
    "--build",
    "-O3",
    "--x-assign",
    "fast",
    "-Wno-fatal",
    "-MAKEFLAGS",
    "OPT_FAST=-O2",
];

/// Everything on which the output of a run depends, apart from Verilator.
pub(crate) fn question(verilog: &str, job: &Job<'_>) -> Vec<String> {
    let compiled = with_parallel(job.axes, |parallel| parallel.hash(verilog));
    vec![compiled, external::program_text(job), format!("{} {}", job.tail, job.max_clocks)]
}

pub(crate) fn run(
    verilog: &str,
    job: &Job<'_>,
    observer: &mut Observer<'_>,
) -> Result<Outcome, LevelError> {
    let program_file =
        tempfile::NamedTempFile::new().map_err(tool::io("cannot make a temporary file"))?;
    let compiled = with_parallel(job.axes, |parallel| parallel.compiled(verilog))?;
    std::fs::write(&program_file, external::program_text(job))
        .map_err(tool::io("cannot write the program"))?;
    let mut simulation = Command::new(compiled);
    simulation.arg(program_file.path()).args([job.tail.to_string(), job.max_clocks.to_string()]);
    external::observe(&VERILATOR, &mut simulation, job, observer)
}

/// What a compilation of the parallel core of this many axes gives.
fn with_parallel<T>(axes: usize, asked: impl FnOnce(&Simulation<'_>) -> T) -> T {
    let top = carrystep_verilog::parallel_name(axes);
    let axes = format!("-DAXES={axes}");
    let options = ["--prefix", "Vparallel", "-CFLAGS", &axes];
    asked(&Simulation { name: "parallel", top: &top, bench: BENCH, options: &options })
}

/// Serialises compilations: two tests of a process may need the same simulation.
static COMPILER: Mutex<()> = Mutex::new(());

/// The parameters of a compilation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Simulation<'a> {
    /// Prefix of the file name, in front of the hash.
    pub name: &'a str,
    /// Name of the top module.
    pub top: &'a str,
    /// The bench that drives it, in C++.
    pub bench: &'a str,
    /// Additional options of Verilator.
    pub options: &'a [&'a str],
}

impl Simulation<'_> {
    /// The hash of everything that the simulation of this Verilog is made from.
    pub fn hash(&self, verilog: &str) -> String {
        let of = [verilog, self.bench, self.top, env!("CARGO_PKG_VERSION")].into_iter();
        hash(of.chain(self.options.iter().copied()).chain(OPTIONS))
    }

    /// The compiled simulation of this Verilog, from the cache or newly compiled.
    ///
    /// # Errors
    /// [`LevelError`] if Verilator is missing or fails.
    pub fn compiled(&self, verilog: &str) -> Result<PathBuf, LevelError> {
        let Self { name, top, bench, options } = *self;
        tool::find(&VERILATOR)?;
        let cache = cache::folder()?;
        let binary = cache.join(format!("{name}_{}", self.hash(verilog)));
        let _one_at_a_time = COMPILER.lock();
        if !cache::holds(&binary)? {
            let folder =
                tempfile::tempdir_in(&cache).map_err(tool::io("cannot make a temporary folder"))?;
            tool::put(folder.path(), &[("core.v", verilog), ("bench.cpp", bench)])?;
            let output = folder.path().join("obj_dir");
            let runtime = Runtime::new(&cache, options);
            let lent = runtime.as_ref().map(|runtime| runtime.lend(&output)).transpose();
            let lent = lent.map_err(tool::io("cannot copy Verilator's own code"))?;
            let mut command = Command::new(VERILATOR.name);
            command.args(lent.into_iter().flatten()).args(OPTIONS).args(options).args([
                "--top-module",
                top,
                "-o",
                "bench",
                "core.v",
                "bench.cpp",
            ]);
            tool::complete(&VERILATOR, command.current_dir(folder.path()))?;
            if let Some(runtime) = &runtime {
                runtime.keep(&output);
            }
            let made = output.join("bench");
            cache::only_ours(&made)?;
            // A rename is atomic: another process that looks for the file finds it complete or not
            // at all.
            std::fs::rename(made, &binary)
                .map_err(tool::io("cannot keep the compiled simulation"))?;
        }
        Ok(binary)
    }
}

/// The hash of these texts, in hexadecimal digits.
fn hash<'a>(texts: impl Iterator<Item = &'a str>) -> String {
    let mut hash = Sha256::new();
    for text in texts {
        // The length keeps texts apart that follow each other.
        hash.update((text.len() as u64).to_le_bytes());
        hash.update(text);
    }
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

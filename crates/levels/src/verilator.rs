//! The exported Verilog in Verilator. A compiled simulation is kept, by the hash of all that went into
//! it, because compiling takes far longer than most runs.

use crate::tool::{self, VERILATOR};
use crate::{Job, LevelError, Observer, Outcome, external};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;

const BENCH: &str = include_str!("../bench/six_axis_bench.cpp");
const OPTIONS: [&str; 9] = ["--cc", "--exe", "--build", "-O3", "--x-assign", "fast", "-Wno-fatal", "-CFLAGS", "-O2"];

pub(crate) fn run(verilog: &str, job: &Job<'_>, observer: &mut Observer<'_>) -> Result<Outcome, LevelError> {
    tool::find(&VERILATOR)?;
    let program_file = tempfile::NamedTempFile::new().map_err(tool::io("cannot make a temporary file"))?;
    std::fs::write(&program_file, external::program_text(job)).map_err(tool::io("cannot write the program"))?;
    let mut simulation = Command::new(compiled(verilog)?);
    simulation.arg(program_file.path()).args([job.tail.to_string(), job.max_clocks.to_string()]);
    external::observe(&VERILATOR, &mut simulation, job, observer)
}

/// The compiled simulation of this Verilog, from the cache or made now.
fn compiled(verilog: &str) -> Result<PathBuf, LevelError> {
    let cache = std::env::temp_dir().join("carrystep-verilator");
    std::fs::create_dir_all(&cache).map_err(tool::io("cannot make the cache folder"))?;
    let mut hash = DefaultHasher::new();
    (verilog, BENCH, OPTIONS, env!("CARGO_PKG_VERSION")).hash(&mut hash);
    let binary = cache.join(format!("six_axis_{:016x}", hash.finish()));
    if !binary.is_file() {
        let folder = tempfile::tempdir_in(&cache).map_err(tool::io("cannot make a temporary folder"))?;
        let made = compile(folder.path(), verilog)?;
        // Whole or not at all: another run may be looking for it.
        std::fs::rename(made, &binary).map_err(tool::io("cannot keep the compiled simulation"))?;
    }
    Ok(binary)
}

fn compile(folder: &Path, verilog: &str) -> Result<PathBuf, LevelError> {
    for (name, text) in [("core.v", verilog), ("bench.cpp", BENCH)] {
        std::fs::write(folder.join(name), text).map_err(tool::io(format!("cannot write {name}")))?;
    }
    let mut command = Command::new(VERILATOR.name);
    command.args(OPTIONS).args(["--top-module", "carrystep_six_axis", "-o", "bench", "core.v", "bench.cpp"]);
    tool::complete(&VERILATOR, command.current_dir(folder))?;
    Ok(folder.join("obj_dir").join("bench"))
}

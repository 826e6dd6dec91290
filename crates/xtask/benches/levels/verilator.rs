//! Runs the exported Verilog in Verilator in its fastest configuration: compiled without timing,
//! with a clock that the harness toggles.

use carrystep_core::AXES;
use carrystep_tools::programs::VERILATOR;
use std::path::{Path, PathBuf};
use std::process::Command;

const HARNESS: &str = include_str!("harness/toggle.cpp");

/// Without this flag, g++ 12 packs single bits into vectors and the program is half as fast.
const NO_SLP: &str = "-fno-tree-slp-vectorize";

/// A compiled simulation.
pub struct Verilated {
    folder: tempfile::TempDir,
    binary: PathBuf,
}

/// The result of a run.
pub struct Run {
    pub seconds: f64,
    pub positions: [i32; AXES],
}

impl Verilated {
    /// Compiles Verilog, with or without the code that writes a trace. A run that is `smoke` is
    /// compiled sooner and runs slower.
    pub fn compile(verilog: &str, trace: bool, smoke: bool) -> Result<Self, String> {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let write = |name: &str, text: &str| {
            std::fs::write(folder.path().join(name), text)
                .map_err(|error| format!("{name}: {error}"))
        };
        write("core.v", verilog)?;
        write("toggle.cpp", HARNESS)?;
        let level = if smoke { "-O1" } else { "-O3" };
        let flags = format!("{level} -march=native {NO_SLP}");
        let mut command = Command::new(VERILATOR.name);
        command.args([
            "--cc",
            "--exe",
            "--build",
            "-O3",
            "--x-assign",
            "fast",
            "--x-initial",
            "fast",
            "--noassert",
        ]);
        command.args(["-Wno-fatal", "--top-module", "carrystep_parallel_6", "-o", "toggle"]);
        command.args([
            "-MAKEFLAGS",
            &format!("OPT_FAST='{flags}' OPT_SLOW='{flags}' OPT_GLOBAL='{flags}'"),
        ]);
        command
            .args(trace.then_some("--trace"))
            .args(["core.v", "toggle.cpp"])
            .current_dir(folder.path());
        let missing =
            |_| format!("{} is not installed: {} installs it", VERILATOR.name, VERILATOR.ways());
        let output = command.output().map_err(missing)?;
        if !output.status.success() {
            return Err(format!(
                "verilator failed: {}",
                String::from_utf8_lossy(&output.stderr).trim()
            ));
        }
        let binary = folder.path().join("obj_dir/toggle");
        Ok(Self { folder, binary })
    }

    /// Runs a number of clocks. If `trace` names a file, the trace is written to it.
    ///
    /// Each run has a new copy of the program. A copy is slower than another one by a factor of up to
    /// 1.8, depending on the pages in memory that the system gives it.
    pub fn run(&self, feed: &str, clocks: u64, trace: Option<&Path>) -> Result<Run, String> {
        let file = self.folder.path().join("feed.txt");
        std::fs::write(&file, feed).map_err(|error| error.to_string())?;
        let copied = tempfile::tempdir().map_err(|error| error.to_string())?;
        let program = copied.path().join("toggle");
        std::fs::copy(&self.binary, &program).map_err(|error| error.to_string())?;
        let mut command = Command::new(program);
        command.arg(&file).arg(clocks.to_string()).args(trace);
        let output = command.output().map_err(|error| error.to_string())?;
        let text = String::from_utf8_lossy(&output.stdout);
        let mut numbers = text.split_whitespace();
        let seconds = numbers.next().and_then(|number| number.parse().ok());
        let positions: Vec<i32> = numbers.filter_map(|number| number.parse().ok()).collect();
        match (seconds, positions.try_into()) {
            (Some(seconds), Ok(positions)) if output.status.success() => {
                Ok(Run { seconds, positions })
            }
            _ => Err(format!("the Verilator harness failed ({}): {text}", output.status)),
        }
    }
}

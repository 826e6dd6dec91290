//! What a person does twice, one command each. CI calls nothing else.

mod accuracy;
mod arrows;
mod bench;
mod circles;
mod decisions;
mod ladder;
mod long;
mod pip;
mod readme;
mod shell;
mod testing;
mod tools;

use clap::{Parser, Subcommand};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Chores of the carrystep workspace.
#[derive(Parser)]
#[command(name = "cargo xtask", version)]
struct Arguments {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    /// Install what is missing, then pass every test: the whole ladder. This is what CI runs.
    Test,
    /// Prove the promises on the exported Verilog, and print what is proved and how.
    Prove,
    /// Install what the tests need, by apt: simulators, yosys, z3, Slurm, GNU parallel,
    /// LinuxCNC.
    Tools,
    /// All longer runs, or those that are named, each with its row in `docs/long-runs.md`:
    /// lockstep, rust-hdl, proofs, mutants, resources.
    Long {
        /// The runs; none: all.
        runs: Vec<String>,
        /// Only those runs that depend on a file that has changed since this commit.
        #[arg(long, value_name = "COMMIT", conflicts_with = "runs")]
        since: Option<String>,
    },
    /// Ten million clocks of lock-step for each test of the engine, and its longest golden vectors.
    Lockstep,
    /// Run all mutants of the engine, and say which recording catches how many.
    Mutants {
        /// Write the list of survivors in `docs/mutants.md` anew; reasons that are there stay.
        #[arg(long)]
        write: bool,
    },
    /// Check the arrows between the crates and between the files of a folder, and their drawing in
    /// `docs/architecture.md`.
    Arrows {
        /// Write the drawing anew.
        #[arg(long)]
        write: bool,
    },
    /// Write the index of `docs/decisions/`, and the lists of decisions and boards in
    /// `docs/SUMMARY.md`.
    Decisions,
    /// Formatting and lints, without a warning.
    Lint,
    /// Check that the link's core needs no `std`, on a bare microcontroller.
    Bare,
    /// Time the fast model beside every other level, the writers beside Verilator's, and each
    /// command with growing work. `bench jobs` measures the planner of jobs instead, and writes its
    /// tables into `docs/performance.md`.
    Bench {
        /// `jobs`, or nothing.
        #[arg(value_parser = ["jobs"])]
        what: Option<String>,
        /// One JSON document instead of the table.
        #[arg(long)]
        json: bool,
        /// Only see that everything runs: about a second for each row, and no figure is judged.
        #[arg(long)]
        smoke: bool,
    },
    /// Write `hdl-out/` anew from the Rust-HDL modules, the register map for its clients, the
    /// boards' pages, and the JSON Schemas.
    Generate,
    /// Write the README's table and pictures anew from the demo (the waveform needs gtkwave and
    /// xvfb).
    Readme,
    /// Write the table of `docs/accuracy.md` anew from the checker's figures.
    Accuracy,
    /// Check the clock modules of the Spartan boards on the vendor's own simulation models, which a
    /// person has from ISE, Vivado or their public repository (`docs/spartans.md`).
    Unisims {
        /// The folder of ISE or Vivado, or the one that holds `glbl.v` and `unisims/`.
        folder: PathBuf,
        /// The boards; none: all Spartans.
        boards: Vec<String>,
    },
    /// Measure the engine on every part and write `hdl-out/resources.md` anew (some minutes).
    Resources,
    /// Build engines with several adders for some boards and write `hdl-out/adders.md` anew (some
    /// minutes).
    Adders,
}

/// Size and speed of every row of the table.
fn resources() -> shell::TaskResult {
    tools::install()?;
    shell::run("cargo", &["run", "--quiet", "--release", "-p", "carrystep-tools"])
}

/// What engines with several adders take, and the clocks that they reach.
fn adders() -> shell::TaskResult {
    tools::install()?;
    shell::run("cargo", &["run", "--quiet", "--release", "-p", "carrystep-tools", "--", "adders"])
}

/// Checks the clock modules of boards on the models in a folder.
fn unisims(folder: &Path, boards: &[String]) -> shell::TaskResult {
    // Programs run in the root of the workspace, not in the user's folder.
    let folder =
        std::path::absolute(folder).map_err(|error| shell::cannot("find", folder, &error))?;
    let folder = folder.to_string_lossy();
    let first = ["run", "--quiet", "--release", "-p", "carrystep-tools", "--", "unisims", &folder];
    let boards: Vec<&str> = boards.iter().map(String::as_str).collect();
    shell::run("cargo", &[&first[..], &boards].concat())
}

fn main() -> ExitCode {
    let result = match Arguments::parse().chore {
        Chore::Test => ladder::climb(),
        Chore::Prove => ladder::prove(),
        Chore::Tools => tools::install(),
        Chore::Long { since: Some(base), .. } => long::run_since(&base),
        Chore::Long { runs, .. } => long::run(&runs),
        Chore::Lockstep => ladder::lockstep(),
        Chore::Mutants { write } => ladder::mutants(write),
        Chore::Arrows { write: true } => arrows::write(),
        Chore::Arrows { write: false } => arrows::check(),
        Chore::Decisions => decisions::write(),
        Chore::Lint => ladder::lint(),
        Chore::Bare => ladder::bare(),
        Chore::Bench { what: Some(_), smoke, .. } => bench::jobs(smoke),
        Chore::Bench { what: None, json, smoke } => bench::run(json, smoke),
        Chore::Generate => readme::generate(),
        Chore::Readme => readme::write(),
        Chore::Accuracy => accuracy::write(),
        Chore::Unisims { folder, boards } => unisims(&folder, &boards),
        Chore::Resources => resources(),
        Chore::Adders => adders(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            shell::say(&format!("xtask: {message}"));
            ExitCode::FAILURE
        }
    }
}

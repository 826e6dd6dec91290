//! Simulates the clock module of a Spartan board with models of the cells in it: those of the
//! vendor, which a person has from ISE, Vivado or their public repository, or others with the same
//! file names. Icarus simulates, and [`figures`] judges each change of a level.

mod figures;

pub use figures::{ClockFault, ClockFigures, LEAST_PHASE, MOST_OFF_PPM, WAIT_CLOCKS};

use crate::cells::pattern;
use crate::programs::ICARUS;
use crate::resources::failed;
use crate::{SynthesisError, tool};
use carrystep_boards::{Board, boards};
use carrystep_verilog::Gateware;
use figures::Trace;
use std::path::{Path, PathBuf};
use std::process::Command;
use thiserror::Error;

const BENCH: &str = include_str!("clock_modules/bench.v");
/// The model of an IBUFG for a library that has none.
const IBUFG: (&str, &str) = ("IBUFG", include_str!("clock_modules/ibufg.v"));

/// Clocks that are simulated.
const EDGES: u64 = 1024;

/// A clock module that has not given these clocks then fails: 0.5 ms.
const LIMIT_PS: u64 = 500_000_000;

/// Folders of ISE and Vivado that hold their models, below the folder that a person names.
const BELOW: [&str; 5] =
    ["", "verilog/src", "data/verilog/src", "ISE/verilog/src", "ISE_DS/ISE/verilog/src"];

/// The folders of models in it; Vivado has some cells of older families in the second one.
const LIBRARIES: [&str; 2] = ["unisims", "retarget"];

/// The file of the global reset, which the models refer to.
const GLBL: &str = "glbl.v";

/// A folder with models of cells: `glbl.v`, and `unisims/` with a file for each cell.
#[derive(Debug, Clone)]
pub struct CellModels {
    src: PathBuf,
}

/// There are no models in a folder.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "{} has no models of cells: expected are {GLBL} and the folder unisims, in it or in one of its \
     folders verilog/src, data/verilog/src and ISE/verilog/src; in an installed ISE or Vivado, name \
     the folder with its version",
    .folder.display()
)]
pub struct NoModels {
    /// The folder.
    pub folder: PathBuf,
}

impl CellModels {
    /// Finds the models in a folder.
    ///
    /// # Errors
    /// [`NoModels`] if the folder is not one of ISE, of Vivado, or of their repository.
    pub fn in_folder(folder: &Path) -> Result<Self, NoModels> {
        let mut all = BELOW.iter().map(|below| folder.join(below));
        let src = all.find(|src| src.join(GLBL).is_file() && src.join(LIBRARIES[0]).is_dir());
        // Icarus runs in another folder.
        let src = src.and_then(|src| src.canonicalize().ok());
        src.map(|src| Self { src }).ok_or_else(|| NoModels { folder: folder.to_owned() })
    }

    fn libraries(&self) -> impl Iterator<Item = PathBuf> {
        LIBRARIES.iter().map(|library| self.src.join(library)).filter(|library| library.is_dir())
    }

    fn has(&self, cell: &str) -> bool {
        self.libraries().any(|library| library.join(format!("{cell}.v")).is_file())
    }
}

/// The Spartan boards, in the order of their families.
pub fn spartans() -> impl Iterator<Item = &'static Board> {
    boards().iter().filter(|board| board.family.facts().yosys().is_some())
}

/// The clock module of the gateware that a board ships with.
///
/// # Errors
/// [`SynthesisError::Gateware`] if there is no such gateware.
pub fn clock_module(board: &Board) -> Result<String, SynthesisError> {
    let gateware = Gateware::shipped(board, &board.parts[0]).map_err(failed)?;
    let files = gateware.files().map_err(failed)?;
    let clock = files.into_iter().find(|file| file.name.ends_with("_clock.v"));
    Ok(clock.ok_or_else(|| failed("no clock module"))?.text)
}

/// Simulates a clock module of a board at its first clock, and checks the clock that it makes. The
/// outer error is one of the tools, the inner one a fault of the module.
///
/// # Errors
/// [`SynthesisError`] if Icarus is missing or does not run.
pub fn simulated(
    board: &Board,
    module: &str,
    models: &CellModels,
) -> Result<Result<ClockFigures, ClockFault>, SynthesisError> {
    let unread =
        |what: &str| SynthesisError::Unread { tool: "the clock module", what: what.into() };
    let name = pattern(r"(?m)^module (\w+)").captures(module).ok_or_else(|| unread("its name"))?;
    let folder = tool::folder()?;
    for cell in pattern(r"(?m)^ +([A-Z][A-Z0-9_]+)\b").captures_iter(module) {
        match &cell[1] {
            cell if models.has(cell) => {}
            cell if cell == IBUFG.0 => tool::write(folder.path(), "IBUFG.v", IBUFG.1)?,
            cell => return Ok(Err(ClockFault::NoModel { cell: cell.to_owned() })),
        }
    }
    let period_ps = 1_000_000_000_000 / board.oscillator.hz;
    tool::write(folder.path(), "bench.v", BENCH)?;
    tool::write(folder.path(), "clock.v", module)?;
    let glbl = models.src.join(GLBL);
    let mut compile = command("iverilog", folder.path());
    compile.args(["-g2012", "-o", "bench.vvp", "-s", "bench", "-s", "glbl", "-y", "."]);
    for library in models.libraries() {
        compile.arg("-y").arg(library);
    }
    let low_ps = period_ps / 2;
    for (name, number) in [
        ("LOW_PS", low_ps),
        ("HIGH_PS", period_ps - low_ps),
        ("EDGES", EDGES),
        ("LIMIT_PS", LIMIT_PS),
    ] {
        compile.arg(format!("-D{name}={number}"));
    }
    compile.arg(format!("-DMODULE={}", &name[1]));
    let compiled = run(compile.args(["bench.v", "clock.v"]).arg(glbl))?;
    if let Some(line) = complaint(&compiled.said, &["error", "not found in"]) {
        return Ok(Err(ClockFault::Complaint { line }));
    }
    if !compiled.ended_well {
        return Ok(Err(ClockFault::Complaint { line: compiled.said }));
    }
    let ran = run(command("vvp", folder.path()).args(["-n", "bench.vvp"]))?;
    if let Some(line) = complaint(&ran.said, &["error"]) {
        return Ok(Err(ClockFault::Complaint { line }));
    }
    let trace = Trace::of(&ran.said);
    Ok(trace.and_then(|trace| trace.judged(board.clocks[0].clock_hz)))
}

/// What a program printed, and whether it ended with success.
struct Ran {
    said: String,
    ended_well: bool,
}

fn command(program: &str, folder: &Path) -> Command {
    let mut command = Command::new(program);
    command.current_dir(folder);
    command
}

fn run(command: &mut Command) -> Result<Ran, SynthesisError> {
    // The models are outside the folder, so that an answer cannot be kept by its question.
    let output = command.output().map_err(|_| SynthesisError::Missing(ICARUS))?;
    let said = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
    Ok(Ran { said, ended_well: output.status.success() })
}

/// The first line that contains one of these words.
fn complaint(said: &str, words: &[&str]) -> Option<String> {
    let complains = |line: &&str| {
        let line = line.to_lowercase();
        words.iter().any(|word| line.contains(word))
    };
    said.lines().find(complains).map(|line| line.trim().to_owned())
}

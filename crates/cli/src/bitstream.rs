//! Makes the bitstream of a board from its files, and reports what the tools have told.

use crate::failure::Failure;
use crate::interrupt;
use crate::output;
use crate::progress::Stages;
use carrystep_boards::{Board, Part};
use carrystep_core::tick::mhz;
use carrystep_tools::board::{BuildJob, build};
use carrystep_verilog::TextFile;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// What is said of each bitstream.
pub const NEVER_RUN: &str = "It was never run on a real board: none was at hand.\n";

/// What a bitstream takes of its part, the clock that it reaches, and how it is loaded.
#[derive(Default, JsonSchema, Serialize)]
pub struct Made {
    logic_cells: Use,
    block_rams: Use,
    clock_hz: u64,
    /// By nextpnr.
    mhz: f64,
    /// By icetime, for an iCE40.
    #[serde(skip_serializing_if = "Option::is_none")]
    icetime_mhz: Option<f64>,
    seed: u32,
    /// Present if the clock is reached.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bitstream: Option<PathBuf>,
    pub load: String,
}

#[cfg(test)]
impl Made {
    /// A bitstream that this command loads.
    pub fn loaded_by(load: &str) -> Self {
        Self { bitstream: Some("a.bin".into()), load: load.to_owned(), ..Self::default() }
    }
}

impl fmt::Display for Made {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { logic_cells, block_rams, clock_hz, mhz: reached, icetime_mhz, seed, .. } = self;
        writeln!(f, "logic cells  {logic_cells}\nblock RAMs   {block_rams}")?;
        let icetime = icetime_mhz.map(|mhz| format!("{mhz:.1} by icetime, ")).unwrap_or_default();
        writeln!(
            f,
            "clock        {reached:>6.1}  MHz by nextpnr (seed {seed}), {icetime}{} needed",
            mhz(*clock_hz)
        )
    }
}

/// A used amount and the available amount.
#[derive(Default, JsonSchema, Serialize)]
pub struct Use {
    pub used: u32,
    pub of: Option<u32>,
}

impl fmt::Display for Use {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { used, of } = self;
        match of {
            Some(of) => write!(f, "{used:>6}  of {of}, {} %", used * 100 / of),
            None => write!(f, "{used:>6}"),
        }
    }
}

/// Refuses a board whose toolchain carrystep does not run, after its folder was written.
pub fn by_hand(board: &Board, out: &Path) -> Result<(), Failure> {
    let toolchain = board.family.facts().toolchain();
    let Some(how) = toolchain.by_hand else { return Ok(()) };
    let (name, out) = (toolchain.title, out.display());
    Err(Failure::Tool(format!(
        "{name} makes this board's bitstreams, and carrystep does not run it. All that it needs is \
         in {out}; there: {how}"
    )))
}

/// Builds these files and writes the bitstream into the folder, if the clock is reached. Returns
/// what the tools reported.
pub fn make(
    board: &Board,
    part: &Part,
    top: &str,
    clock_hz: u64,
    files: &[TextFile],
    out: &Path,
) -> Result<Made, Failure> {
    let texts = |extension: &str| {
        files
            .iter()
            .filter(|file| file.name.ends_with(extension))
            .map(|file| file.text.as_str())
            .collect::<String>()
    };
    let job = BuildJob {
        verilog: &texts(".v"),
        top,
        constraints: &texts(board.family.facts().toolchain().constraints_end()),
        part,
        clock_hz,
    };
    let file = out.join(format!("{top}.{}", board.bitstream));
    let mut whole = output::OutputFile::create(&file)?;
    let mut stages = Stages::new();
    let built = build(&job, &mut |stage| stages.next(stage));
    drop(stages);
    // Ctrl-C in a terminal ends the tools, too.
    if interrupt::is_asked() {
        return Err(Failure::Run(format!(
            "interrupted: no bitstream was made; {} has the files that it is made of",
            out.display()
        )));
    }
    let built = built?;
    let mut made = Made {
        logic_cells: Use { used: built.size.logic_cells, of: part.logic_cells },
        block_rams: Use { used: built.size.block_rams, of: Some(part.block_rams) },
        clock_hz,
        mhz: built.mhz,
        icetime_mhz: built.icetime_mhz,
        seed: built.seed,
        bitstream: None,
        load: board.flash.replace("FILE", &file.display().to_string()),
    };
    if built.reaches(clock_hz) {
        whole
            .write_all(&built.bitstream)
            .map_err(|error| Failure::input(format!("cannot write {}: {error}", file.display())))?;
        whole.keep()?;
        made.bitstream = Some(file);
    }
    Ok(made)
}

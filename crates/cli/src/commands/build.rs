//! `carrystep build`: makes a board's bitstream and reports the results of the tools.

use crate::arguments::BuildArguments;
use crate::commands::boards;
use crate::failure::Failure;
use crate::output;
use crate::progress::Stages;
use carrystep_boards::{Board, Part};
use carrystep_core::tick::mhz;
use carrystep_files::{InputError, Machine};
use carrystep_tools::board::{BuildJob, Built, build};
use carrystep_tools::{ice40, kept};
use carrystep_verilog::{Gateware, TextFile};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct BuildReport {
    /// Whether the clock is reached.
    passed: bool,
    /// Whether carrystep was ever tested on real hardware.
    tried_on_hardware: bool,
    board: String,
    part: String,
    build_id: String,
    logic_cells: Use,
    block_rams: Use,
    clock_hz: u64,
    /// By nextpnr.
    mhz: f64,
    icetime_mhz: f64,
    seed: u32,
    /// Present if the clock is reached.
    #[serde(skip_serializing_if = "Option::is_none")]
    bitstream: Option<PathBuf>,
    load: String,
}

/// A used amount and the available amount.
#[derive(JsonSchema, Serialize)]
pub(super) struct Use {
    pub(super) used: u32,
    pub(super) of: Option<u32>,
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

/// Writes the board's folder and the bitstream into it.
pub fn run(arguments: &BuildArguments) -> Result<(), Failure> {
    let board = boards::find(&arguments.board)?;
    if let (Some(path), false) = (&arguments.machine, arguments.try_clock) {
        reachable(&board, arguments.part.as_deref(), path)?;
    }
    // Whoever builds a bitstream expects the tools to be run.
    kept::never();
    let gateware =
        boards::gateware(&board, arguments.part.as_deref(), arguments.machine.as_deref())?;
    let out = arguments.out.clone().unwrap_or_else(|| Path::new("sim/out").join(&board.name));
    let files = gateware.files()?;
    carrystep_verilog::write(&out, &files)?;
    by_hand(&board, &out)?;
    bitstream(arguments, &board, &gateware, &files, &out)
}

/// Refuses a clock that placement has been measured not to reach, because placement would need
/// minutes to find that out.
fn reachable(board: &Board, part: Option<&str>, machine: &Path) -> Result<(), Failure> {
    let part = board.part(part)?;
    let read = Machine::load(machine)?;
    board.may_reach(part, read.timebase.clock_hz(), read.axes.len()).map_err(|error| {
        Failure::Input(
            InputError::new(format!("{}: {error}", machine.display()))
                .help("set clock_hz and tick_ns in [machine]; --try-clock builds all the same"),
        )
    })
}

/// Refuses a board whose toolchain carrystep does not run, after its folder was written.
pub(super) fn by_hand(board: &Board, out: &Path) -> Result<(), Failure> {
    let toolchain = board.family.facts().toolchain();
    let Some(how) = toolchain.by_hand else { return Ok(()) };
    let (name, out) = (toolchain.title, out.display());
    Err(Failure::Tool(format!(
        "{name} makes this board's bitstreams, and carrystep does not run it. All that it needs is in {out}; there: {how}"
    )))
}

/// Builds these files and writes the bitstream into the folder, if the clock is reached. Returns
/// what the tools reported, and the path of the bitstream.
pub(super) fn make(
    board: &Board,
    part: &Part,
    top: &str,
    clock_hz: u64,
    files: &[TextFile],
    out: &Path,
) -> Result<(Built, Option<PathBuf>), Failure> {
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
        pcf: &texts(".pcf"),
        part: ice40::NextpnrPart { device: &part.name, package: &part.package },
        clock_hz,
    };
    let file = out.join(format!("{top}.{}", board.bitstream));
    let mut whole = output::OutputFile::create(&file)?;
    let mut stages = Stages::new();
    let built = build(&job, &mut |stage| stages.next(stage))?;
    drop(stages);
    if !built.reaches(clock_hz) {
        return Ok((built, None));
    }
    whole
        .write_all(&built.bitstream)
        .map_err(|error| Failure::input(format!("cannot write {}: {error}", file.display())))?;
    whole.keep()?;
    Ok((built, Some(file)))
}

fn bitstream(
    arguments: &BuildArguments,
    board: &Board,
    gateware: &Gateware<'_>,
    files: &[TextFile],
    out: &Path,
) -> Result<(), Failure> {
    let (part, top) = (gateware.part(), gateware.top());
    let clock_hz = gateware.build().timebase.clock_hz();
    let (built, made) = make(board, part, &top, clock_hz, files, out)?;
    let (passed, file) = (made.is_some(), out.join(format!("{top}.{}", board.bitstream)));
    let report = BuildReport {
        passed,
        tried_on_hardware: false,
        board: board.name.clone(),
        part: part.ordered(),
        build_id: gateware.build_id().to_string(),
        logic_cells: Use { used: built.size.logic_cells, of: part.logic_cells },
        block_rams: Use { used: built.size.block_rams, of: Some(part.block_rams) },
        clock_hz,
        mhz: built.mhz,
        icetime_mhz: built.icetime_mhz,
        seed: built.seed,
        bitstream: made,
        load: board.flash.replace("FILE", &file.display().to_string()),
    };
    if arguments.json {
        output::print_json(&report)?;
    } else {
        output::print(&told(&report, &built, &board.proposed(Some(gateware.build().axes()))))?;
    }
    if passed { Ok(()) } else { Err(Failure::Check) }
}

fn told(report: &BuildReport, built: &Built, proposed: &str) -> String {
    let BuildReport { board, part, build_id, clock_hz, seed, .. } = report;
    let head = format!(
        "{board}: {part}, build {build_id}\nlogic cells  {}\nblock RAMs   {}\nclock        {:>6.1}  MHz by nextpnr (seed {seed}), {:.1} by icetime, {} needed\n",
        report.logic_cells,
        report.block_rams,
        built.mhz,
        built.icetime_mhz,
        mhz(*clock_hz)
    );
    match &report.bitstream {
        Some(file) => format!(
            "{head}bitstream    {}\nload it with: {}\nIt was never run on a real board: none was at hand.\n",
            file.display(),
            report.load
        ),
        None => format!(
            "{head}THE CLOCK IS NOT REACHED: no bitstream. The board is proposed to run at {proposed}.\n"
        ),
    }
}

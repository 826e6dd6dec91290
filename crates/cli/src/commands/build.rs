//! `carrystep build`: makes a board's bitstream and reports the results of the tools.

use crate::arguments::BuildArguments;
use crate::bitstream::{Made, NEVER_RUN, by_hand, make};
use crate::commands::boards;
use crate::failure::Failure;
use crate::output;
use carrystep_boards::Board;
use carrystep_files::{InputError, Machine};
use carrystep_verilog::{Gateware, TextFile};
use schemars::JsonSchema;
use serde::Serialize;
use std::path::Path;

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
    #[serde(flatten)]
    made: Made,
}

/// Writes the board's folder and the bitstream into it.
pub fn run(arguments: &BuildArguments) -> Result<(), Failure> {
    let board = boards::find(&arguments.board)?;
    if let (Some(path), false) = (&arguments.machine, arguments.try_clock) {
        reachable(&board, arguments.part.as_deref(), path)?;
    }
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

fn bitstream(
    arguments: &BuildArguments,
    board: &Board,
    gateware: &Gateware<'_>,
    files: &[TextFile],
    out: &Path,
) -> Result<(), Failure> {
    let (part, top) = (gateware.part(), gateware.top());
    let clock_hz = gateware.build().timebase.clock_hz();
    let made = make(board, part, &top, clock_hz, files, out)?;
    let report = BuildReport {
        passed: made.bitstream.is_some(),
        tried_on_hardware: false,
        board: board.name.clone(),
        part: part.ordered(),
        build_id: gateware.build_id().to_string(),
        made,
    };
    if arguments.json {
        output::print_json(&report)?;
    } else {
        output::print(&told(&report, &board.proposed(Some(gateware.build().axes()))))?;
    }
    if report.passed { Ok(()) } else { Err(Failure::Check) }
}

fn told(report: &BuildReport, proposed: &str) -> String {
    let BuildReport { board, part, build_id, made, .. } = report;
    let head = format!("{board}: {part}, build {build_id}\n{made}");
    match &made.bitstream {
        Some(file) => format!(
            "{head}bitstream    {}\nload it with: {}\n{NEVER_RUN}",
            file.display(),
            made.load
        ),
        None => format!(
            "{head}THE CLOCK IS NOT REACHED: no bitstream. The board is proposed to run at {proposed}.\n"
        ),
    }
}

//! `carrystep selftest`: makes the self-test of a board, with which a meter and a jumper prove the
//! wiring before a motor is connected (docs/self-test.md).

use super::build::{Use, by_hand, make};
use crate::arguments::SelftestArguments;
use crate::commands::boards;
use crate::failure::Failure;
use crate::output;
use carrystep_core::tick::mhz;
use carrystep_tools::kept;
use carrystep_verilog::SelfTestGateware;
use schemars::JsonSchema;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct SelftestReport {
    /// Whether the clock is reached.
    passed: bool,
    /// Whether carrystep was ever tested on real hardware.
    tried_on_hardware: bool,
    board: String,
    part: String,
    /// Baud rate of the UART.
    baud: u32,
    /// The outputs that become 1 one after the other, in this order.
    outputs: Vec<String>,
    /// The inputs whose changes are reported.
    inputs: Vec<String>,
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

/// What to do before the self-test is loaded.
const WARNING: &str = "Before you load it, disconnect motors, spindle and all else that an output could switch on:\n\
                       each output is 1 for a second.\n";

/// Writes the folder of the self-test and the bitstream into it.
pub fn run(arguments: &SelftestArguments) -> Result<(), Failure> {
    let board = boards::find(&arguments.board)?;
    // Whoever builds a bitstream expects the tools to be run.
    kept::never();
    let part = board.part(arguments.part.as_deref())?;
    let gateware = SelfTestGateware::new(&board, part, arguments.spi)?;
    let usual = || Path::new("sim/out").join(format!("{}-selftest", board.name));
    let out = arguments.out.clone().unwrap_or_else(usual);
    let files = gateware.files()?;
    carrystep_verilog::write(&out, &files)?;
    by_hand(&board, &out)?;
    let (top, clock_hz) = (gateware.top(), gateware.clock_hz());
    let (built, bitstream) = make(&board, part, &top, clock_hz, &files, &out)?;
    let rows = gateware.rows();
    let file = out.join(format!("{top}.{}", board.bitstream));
    let report = SelftestReport {
        passed: bitstream.is_some(),
        tried_on_hardware: false,
        board: board.name.clone(),
        part: part.ordered(),
        baud: gateware.test().uart().baud(),
        outputs: rows.outputs.clone(),
        inputs: rows.inputs.clone(),
        logic_cells: Use { used: built.size.logic_cells, of: part.logic_cells },
        block_rams: Use { used: built.size.block_rams, of: Some(part.block_rams) },
        clock_hz,
        mhz: built.mhz,
        icetime_mhz: built.icetime_mhz,
        seed: built.seed,
        bitstream,
        load: board.flash.replace("FILE", &file.display().to_string()),
    };
    if arguments.json {
        output::print_json(&report)?;
    } else {
        output::print(&told(&report))?;
    }
    if report.passed { Ok(()) } else { Err(Failure::Check) }
}

fn told(report: &SelftestReport) -> String {
    let SelftestReport { board, part, baud, outputs, inputs, clock_hz, mhz: reached, .. } = report;
    let head = format!(
        "{board}: {part}, self-test of {} outputs and {} inputs\nlogic cells  {}\nblock RAMs   {}\nclock        {reached:>6.1}  MHz by nextpnr (seed {}), {:.1} by icetime, {} needed\n",
        outputs.len(),
        inputs.len(),
        report.logic_cells,
        report.block_rams,
        report.seed,
        report.icetime_mhz,
        mhz(*clock_hz)
    );
    match &report.bitstream {
        Some(file) => format!(
            "{head}bitstream    {}\n{WARNING}load it with: {}\nthen open the serial port at {baud} baud\nIt was never run on a real board: none was at hand.\n",
            file.display(),
            report.load
        ),
        None => format!("{head}THE CLOCK IS NOT REACHED: no bitstream.\n"),
    }
}

//! `carrystep selftest`: makes the self-test of a board, with which a meter and a jumper prove the
//! wiring before a motor is connected (docs/self-test.md).

use crate::arguments::SelftestArguments;
use crate::bitstream::{Made, NEVER_RUN, by_hand, make};
use crate::commands::boards;
use crate::failure::Failure;
use crate::output;
use carrystep_verilog::SelfTestGateware;
use schemars::JsonSchema;
use serde::Serialize;
use std::path::Path;

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
    #[serde(flatten)]
    made: Made,
}

/// What to do before the self-test is loaded.
const WARNING: &str = "Before you load it, disconnect motors, spindle and all else that an output could \
                       switch on:\neach output is 1 for a second.\n";

/// Writes the folder of the self-test and the bitstream into it.
pub fn run(arguments: &SelftestArguments) -> Result<(), Failure> {
    let board = boards::find(&arguments.board)?;
    let part = board.part(arguments.part.as_deref())?;
    let gateware = SelfTestGateware::new(&board, part, arguments.spi)?;
    let usual = || Path::new("sim/out").join(format!("{}-selftest", board.name));
    let out = arguments.out.clone().unwrap_or_else(usual);
    let files = gateware.files()?;
    carrystep_verilog::write(&out, &files)?;
    by_hand(&board, &out)?;
    let made = make(&board, part, &gateware.top(), gateware.clock_hz(), &files, &out)?;
    let rows = gateware.rows();
    let report = SelftestReport {
        passed: made.bitstream.is_some(),
        tried_on_hardware: false,
        board: board.name.clone(),
        part: part.ordered(),
        baud: gateware.test().uart().baud(),
        outputs: rows.outputs.clone(),
        inputs: rows.inputs.clone(),
        made,
    };
    if arguments.json {
        output::print_json(&report)?;
    } else {
        output::print(&told(&report))?;
    }
    if report.passed { Ok(()) } else { Err(Failure::Check) }
}

fn told(report: &SelftestReport) -> String {
    let SelftestReport { board, part, baud, outputs, inputs, made, .. } = report;
    let (outputs, inputs) = (outputs.len(), inputs.len());
    let head =
        format!("{board}: {part}, self-test of {outputs} outputs and {inputs} inputs\n{made}");
    match &made.bitstream {
        Some(file) => format!(
            "{head}bitstream    {}\n{WARNING}load it with: {}\nthen open the serial port at {baud} \
             baud\n{NEVER_RUN}",
            file.display(),
            made.load
        ),
        None => format!("{head}THE CLOCK IS NOT REACHED: no bitstream.\n"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warning_stands_before_the_command_that_loads() {
        let made = Made::loaded_by("icesprog a.bin");
        let report = SelftestReport {
            passed: true,
            tried_on_hardware: false,
            board: "icesugar".to_owned(),
            part: "up5k".to_owned(),
            baud: 115_200,
            outputs: vec![],
            inputs: vec![],
            made,
        };
        let said = told(&report);
        let (warning, load) =
            (said.find("disconnect motors"), said.find("load it with: icesprog a.bin"));
        assert!(warning.is_some() && warning < load, "{said}");
    }
}

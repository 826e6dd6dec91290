//! The resources of the host link with its line.

use super::measure::{failed, machine};
use super::rows::{ECP5, EngineRow, GOWIN, ROWS};
use crate::flow::Flow;
use crate::ice40::{self, Size};
use crate::{SynthesisError, ecp5, gowin};
use carrystep_boards::Mapped;
use carrystep_core::link::{LineKind, Uart};
use carrystep_verilog::{
    ENGINE_NAME, LINK_NAME, engine_verilog, line_name, line_verilog, link_verilog,
};

/// Baud rate of the UARTs.
const BAUD: u32 = 3_000_000;

/// Budget of the link: logic cells and block RAMs.
pub const LINK_BUDGET: Size = Size { logic_cells: 350, block_rams: 6 };

/// Name of the line of each row on the page.
pub const LINES: [&str; 2] = ["UART, 3 Mbaud", "SPI"];

/// Engine, link and UART of the row for an ECP5.
///
/// # Errors
/// [`SynthesisError`] if a tool is missing or fails.
pub fn ecp5() -> Result<Mapped, SynthesisError> {
    together(&ECP5.of, &ecp5::FLOW)
}

/// Engine, link and UART of the row for a Gowin part.
///
/// # Errors
/// As [`ecp5`].
pub fn gowin() -> Result<Mapped, SynthesisError> {
    together(&GOWIN.of, &gowin::FLOW)
}

/// Engine, link and UART of a row, each in the cells of these tools.
fn together(row: &EngineRow, flow: &Flow) -> Result<Mapped, SynthesisError> {
    let build = machine(row)?;
    let line = LineKind::Uart(Uart::new(row.clock_hz, BAUD).map_err(failed)?);
    let parts = [
        (engine_verilog(&build, ""), ENGINE_NAME),
        (link_verilog(&build, line, ""), LINK_NAME),
        (line_verilog(line, ""), line_name(line)),
    ];
    let mut all = Mapped::default();
    for (verilog, name) in parts {
        let found = flow.cells(&verilog.map_err(failed)?, name)?;
        all.luts += found.luts;
        all.flip_flops += found.flip_flops;
        all.carries += found.carries;
        all.block_rams += found.block_rams;
    }
    Ok(all)
}

/// The resources of each line with its link, for the engine of the first row.
///
/// # Errors
/// [`SynthesisError`] if a tool is missing or fails.
pub fn links() -> Result<[Size; LINES.len()], SynthesisError> {
    let row = &ROWS[0];
    let build = machine(row)?;
    let uart = Uart::new(row.clock_hz, BAUD).map_err(failed)?;
    let size = |line| {
        let parts = [
            (link_verilog(&build, line, ""), LINK_NAME),
            (line_verilog(line, ""), line_name(line)),
        ];
        let mut all = Size { logic_cells: 0, block_rams: 0 };
        for (verilog, name) in parts {
            let found = ice40::synthesise(&verilog.map_err(failed)?, name, row.part.device)?
                .size(row.part)?;
            all.logic_cells += found.logic_cells;
            all.block_rams += found.block_rams;
        }
        Ok(all)
    };
    Ok([size(LineKind::Uart(uart))?, size(LineKind::Spi)?])
}

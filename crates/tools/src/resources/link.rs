//! The resources of the host link with its line.

use super::measure::{failed, machine};
use super::rows::ROWS;
use crate::SynthesisError;
use crate::ice40::{self, Size};
use carrystep_core::link::{LineKind, Uart};
use carrystep_verilog::{LINK_NAME, line_name, line_verilog, link_verilog};

/// Budget of the link: logic cells and block RAMs.
pub const LINK_BUDGET: Size = Size { logic_cells: 350, block_rams: 6 };

/// Name of the line of each row on the page.
pub const LINES: [&str; 2] = ["UART, 3 Mbaud", "SPI"];

/// The resources of each line with its link, for the engine of the first row.
///
/// # Errors
/// [`SynthesisError`] if a tool is missing or fails.
pub fn links() -> Result<[Size; LINES.len()], SynthesisError> {
    let row = &ROWS[0];
    let build = machine(row)?;
    let uart = Uart::new(row.clock_hz, 3_000_000).map_err(failed)?;
    let size = |line| {
        let parts = [
            (link_verilog(&build, line, ""), LINK_NAME),
            (line_verilog(line, ""), line_name(line)),
        ];
        let mut all = Size { logic_cells: 0, block_rams: 0 };
        for (verilog, name) in parts {
            let found = ice40::synthesise_for(&verilog.map_err(failed)?, name, row.part.device)?
                .size(row.part)?;
            all.logic_cells += found.logic_cells;
            all.block_rams += found.block_rams;
        }
        Ok(all)
    };
    Ok([size(LineKind::Uart(uart))?, size(LineKind::Spi)?])
}

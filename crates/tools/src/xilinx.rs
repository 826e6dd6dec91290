//! Synthesises Verilog to the cells of Xilinx families with yosys. Placement is left to the tools
//! of the vendor.

mod edif;
mod independent;
mod models;

pub use edif::from_edif;
pub use independent::{Compared, Mismatch, ReadTwice};
pub use models::simulated;

use crate::SynthesisError;
use crate::cells::counted;
use crate::tool::{self, YOSYS};
use carrystep_boards::Mapped;

/// Counts the cells to which `synth_xilinx` maps a design for `xc3s`, `xc6s` or `xc7`.
///
/// # Errors
/// [`SynthesisError`] if yosys is missing or refuses the text.
pub fn cells(verilog: &str, top: &str, family: &str) -> Result<Mapped, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", verilog)?;
    let script =
        format!("read_verilog core.v; {}; tee -o stat.txt stat", synthesis(family, "", top));
    tool::yosys(folder.path(), &script)?;
    count(&tool::read(folder.path(), "stat.txt")?)
}

/// The commands of synthesis. They omit wide multiplexers, with which yosys 0.23 needs four times
/// the cells.
fn synthesis(family: &str, more: &str, top: &str) -> String {
    format!("synth_xilinx -family {family}{more} -nowidelut -flatten -top {top}")
}

/// The commands of yosys in a board's build script for ISE, after the Verilog was read.
pub fn script_for_ise(family: &str, top: &str) -> String {
    format!("{}; clean -purge; write_edif -pvector bra {top}.edif", synthesis(family, " -ise", top))
}

/// The EDIF for ISE; the one for other families is made in the same way.
///
/// # Errors
/// [`SynthesisError`] if yosys is missing or refuses the text.
pub fn to_edif(verilog: &str, top: &str, family: &str) -> Result<String, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", verilog)?;
    tool::yosys(folder.path(), &format!("read_verilog core.v; {}", script_for_ise(family, top)))?;
    tool::read(folder.path(), &format!("{top}.edif"))
}

fn count(stat: &str) -> Result<Mapped, SynthesisError> {
    let mut cells = Mapped::default();
    for (name, number) in counted(stat) {
        match name {
            "INV" => cells.luts += number,
            "RAM16X1D" => cells.luts += 2 * number,
            _ if name.starts_with("LUT") => cells.luts += number,
            _ if name.starts_with("FD") => cells.flip_flops += number,
            "MUXCY" | "XORCY" | "CARRY4" => cells.carries += number,
            _ if name.starts_with("RAMB") => cells.block_rams += number,
            _ => {}
        }
    }
    let unread = || SynthesisError::Unread { tool: YOSYS.name, what: "cells".to_owned() };
    if cells.flip_flops == 0 { Err(unread()) } else { Ok(cells) }
}

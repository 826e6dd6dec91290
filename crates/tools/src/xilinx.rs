//! What yosys makes of Verilog for Xilinx families: cells only, for their own tools place them.

mod edif;
mod models;

pub use edif::from_edif;
pub use models::simulated;

use crate::SynthesisError;
use crate::tool::{self, YOSYS};
use carrystep_boards::Mapped;

/// Counts what `synth_xilinx` makes of a design for `xc3s`, `xc6s`, `xc7`.
///
/// # Errors
/// [`SynthesisError`]: yosys is missing or refuses the text.
pub fn cells(verilog: &str, top: &str, family: &str) -> Result<Mapped, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", verilog)?;
    let script = format!("read_verilog core.v; {}; tee -o stat.txt stat", synthesis(family, "", top));
    tool::yosys(folder.path(), &script)?;
    count(&tool::read(folder.path(), "stat.txt")?)
}

/// Wide multiplexers are left out: with them, yosys 0.23 takes four times the cells.
fn synthesis(family: &str, more: &str, top: &str) -> String {
    format!("synth_xilinx -family {family}{more} -nowidelut -flatten -top {top}")
}

/// What a board's build script has yosys do for ISE, after it has read the Verilog.
pub fn script_for_ise(family: &str, top: &str) -> String {
    format!("{}; clean -purge; write_edif -pvector bra {top}.edif", synthesis(family, " -ise", top))
}

/// The EDIF that ISE gets. Other families than ISE's get the same.
///
/// # Errors
/// [`SynthesisError`]: yosys is missing or refuses the text.
pub fn to_edif(verilog: &str, top: &str, family: &str) -> Result<String, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", verilog)?;
    tool::yosys(folder.path(), &format!("read_verilog core.v; {}", script_for_ise(family, top)))?;
    tool::read(folder.path(), &format!("{top}.edif"))
}

fn count(stat: &str) -> Result<Mapped, SynthesisError> {
    let mut cells = Mapped::default();
    for line in stat.lines() {
        let mut words = line.split_whitespace();
        let (Some(name), Some(number), None) = (words.next(), words.next(), words.next()) else { continue };
        let Ok(number) = number.parse::<u32>() else { continue };
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

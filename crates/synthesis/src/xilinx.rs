//! What yosys makes of Verilog for Xilinx families: cells only, for their own tools place them.

use crate::SynthesisError;
use crate::tool::{self, YOSYS};
use carrystep_spec::board::Mapped;

/// Counts what `synth_xilinx` makes of a design for `xc3s`, `xc6s`, `xc7`.
///
/// Wide multiplexers are left out: with them, yosys 0.23 takes four times the cells.
///
/// # Errors
/// [`SynthesisError`]: yosys is missing or refuses the text.
pub fn cells(verilog: &str, top: &str, family: &str) -> Result<Mapped, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", verilog)?;
    let script = format!(
        "read_verilog core.v; synth_xilinx -family {family} -nowidelut -flatten -top {top}; tee -o stat.txt stat"
    );
    tool::yosys(folder.path(), &script)?;
    count(&tool::read(folder.path(), "stat.txt")?)
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

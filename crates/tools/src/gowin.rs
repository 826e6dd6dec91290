//! Turns Verilog into a Gowin bitstream with yosys, nextpnr and gowin_pack, and reads the figures of
//! each stage. The commands are those of the boards' build scripts.

mod models;

pub use models::simulated;

use crate::SynthesisError;
use crate::cells::counted;
use crate::ice40::Size;
use crate::nextpnr_log::NextpnrLog;
use crate::tool::{self, GOWIN_PACK, NEXTPNR_GOWIN, YOSYS_OF_PIP};
use carrystep_boards::{Mapped, Part};

/// A synthesised design.
pub struct Netlist {
    /// The design in the format that nextpnr reads.
    json: String,
    /// The design as Verilog made of cells.
    pub verilog: String,
}

/// A placed and routed design.
pub struct PlacedDesign {
    /// The placed design, as gowin_pack reads it.
    json: String,
    /// The name of the die.
    die: String,
    /// Greatest clock, MHz, at which every path between flip-flops and memories meets its timing,
    /// according to nextpnr.
    pub mhz: f64,
    /// LUTs, with those of carry chains, and block RAMs.
    pub size: Size,
}

/// Synthesises Verilog.
///
/// # Errors
/// [`SynthesisError`] if yosys is missing or refuses the text, or if a file cannot be used.
pub fn synthesise(verilog: &str, top: &str) -> Result<Netlist, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", verilog)?;
    let script = format!(
        "read_verilog core.v; synth_gowin -top {top} -json core.json; write_verilog -noattr netlist.v"
    );
    tool::run(&YOSYS_OF_PIP, folder.path(), &["-q", "-p", &script])?;
    let read = |name| tool::read(folder.path(), name);
    Ok(Netlist { json: read("core.json")?, verilog: read("netlist.v")? })
}

/// Counts the cells to which `synth_gowin` maps a design. The LUTs are those that nextpnr counts:
/// with one for each bit of a carry chain.
///
/// # Errors
/// [`SynthesisError`] if yosys is missing or refuses the text.
pub fn cells(verilog: &str, top: &str) -> Result<Mapped, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", verilog)?;
    let script = format!("read_verilog core.v; synth_gowin -top {top}; tee -o stat.txt stat");
    tool::run(&YOSYS_OF_PIP, folder.path(), &["-q", "-p", &script])?;
    count(&tool::read(folder.path(), "stat.txt")?)
}

/// Reads yosys' `stat`, whose lines have the number first from yosys 0.59 on, or the name.
fn count(stat: &str) -> Result<Mapped, SynthesisError> {
    let turned: String = stat
        .lines()
        .filter_map(|line| {
            let (number, name) = line.trim().split_once(char::is_whitespace)?;
            number.parse::<u32>().ok().map(|number| format!("{} {number}\n", name.trim()))
        })
        .collect();
    let mut cells = Mapped::default();
    for (name, number) in counted(&turned) {
        match name {
            "LUT1" | "LUT2" | "LUT3" | "LUT4" => cells.luts += number,
            "ALU" => {
                cells.luts += number;
                cells.carries += number;
            }
            _ if name.starts_with("DFF") => cells.flip_flops += number,
            "DPB" | "DPX9B" | "SDPB" | "SDPX9B" | "SP" | "SPX9" => cells.block_rams += number,
            _ => {}
        }
    }
    let unread = || SynthesisError::Unread { tool: YOSYS_OF_PIP.name, what: "cells".to_owned() };
    if cells.flip_flops == 0 { Err(unread()) } else { Ok(cells) }
}

impl Netlist {
    /// Places and routes the netlist for a clock, Hz, on the pins of `cst`. A missed clock is not
    /// an error.
    ///
    /// # Errors
    /// [`SynthesisError`] if nextpnr is missing, if the part is too small, or if a pin does not
    /// exist.
    pub fn place_on(
        &self,
        part: &Part,
        cst: &str,
        clock_hz: u64,
        seed: u32,
    ) -> Result<PlacedDesign, SynthesisError> {
        let folder = tool::folder()?;
        tool::write(folder.path(), "core.json", &self.json)?;
        tool::write(folder.path(), "core.cst", cst)?;
        let (mhz, seed) = ((clock_hz as f64 / 1e6).to_string(), seed.to_string());
        let of_part = part.nextpnr();
        let more = [
            "--vopt",
            "cst=core.cst",
            "--router",
            "router2",
            "--freq",
            &mhz,
            "--seed",
            &seed,
            "--json",
            "core.json",
            "--write",
            "placed.json",
            "--timing-allow-fail",
            "--quiet",
            "--log",
            "log.txt",
        ];
        let arguments: Vec<&str> = of_part.iter().map(String::as_str).chain(more).collect();
        tool::run(&NEXTPNR_GOWIN, folder.path(), &arguments)?;
        let log = tool::read(folder.path(), "log.txt")?;
        let log = NextpnrLog { tool: &NEXTPNR_GOWIN, text: &log };
        Ok(PlacedDesign {
            json: tool::read(folder.path(), "placed.json")?,
            die: part.die(),
            mhz: log.greatest_clock()?,
            size: Size { logic_cells: log.used(" LUT4:")?, block_rams: log.used(" BSRAM:")? },
        })
    }
}

impl PlacedDesign {
    /// The bitstream, as the boards' build scripts make it.
    ///
    /// # Errors
    /// [`SynthesisError`] if gowin_pack is missing or fails.
    pub fn bitstream(&self) -> Result<Vec<u8>, SynthesisError> {
        let folder = tool::folder()?;
        tool::write(folder.path(), "placed.json", &self.json)?;
        let arguments = ["-d", &self.die, "-o", "placed.fs", "placed.json"];
        tool::run(&GOWIN_PACK, folder.path(), &arguments)?;
        tool::read_bytes(folder.path(), "placed.fs")
    }
}

#[cfg(test)]
mod tests {
    use super::count;

    #[test]
    fn luts_are_counted_as_nextpnr_counts_them() {
        let stat = "     2513 cells\n      279   ALU\n      164   DFF\n      211   DFFE\n        1   DPB\n        \
                    6   DPX9B\n      122   LUT1\n      200   LUT2\n      431   LUT3\n      563   LUT4\n      \
                    229   MUX2_LUT5\n        6   SDPX9B\n        2   SPX9\n";
        let found = count(stat).expect("cells");
        assert_eq!((found.luts, found.flip_flops), (1595, 375));
        assert_eq!((found.carries, found.block_rams), (279, 15));
        assert!(count("").is_err());
    }
}

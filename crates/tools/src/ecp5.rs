//! Turns Verilog into an ECP5 bitstream with yosys, nextpnr and ecppack, and reads the figures of
//! each stage. The commands are those of the boards' build scripts.

mod models;

pub use models::simulated;

use crate::SynthesisError;
use crate::cells::counted;
use crate::ice40::Size;
use crate::nextpnr_log::NextpnrLog;
use crate::tool::{self, ECPPACK, NEXTPNR_ECP5, YOSYS};
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
    /// The configuration as text, as ecppack reads it.
    pub config: String,
    /// Greatest clock, MHz, at which every path between flip-flops and memories meets its timing,
    /// according to nextpnr.
    pub mhz: f64,
    /// LUTs, with those of carry chains and of memories in LUTs, and block RAMs.
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
        "read_verilog core.v; synth_ecp5 -top {top} -json core.json; write_verilog -noattr netlist.v"
    );
    tool::yosys(folder.path(), &script)?;
    let read = |name| tool::read(folder.path(), name);
    Ok(Netlist { json: read("core.json")?, verilog: read("netlist.v")? })
}

/// Counts the cells to which `synth_ecp5` maps a design. The LUTs are those that nextpnr counts
/// before it packs: with two for each cell of a carry chain, and six for each memory in LUTs.
///
/// # Errors
/// [`SynthesisError`] if yosys is missing or refuses the text.
pub fn cells(verilog: &str, top: &str) -> Result<Mapped, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", verilog)?;
    let script = format!("read_verilog core.v; synth_ecp5 -top {top}; tee -o stat.txt stat");
    tool::yosys(folder.path(), &script)?;
    count(&tool::read(folder.path(), "stat.txt")?)
}

fn count(stat: &str) -> Result<Mapped, SynthesisError> {
    let mut cells = Mapped::default();
    for (name, number) in counted(stat) {
        match name {
            "LUT4" => cells.luts += number,
            "CCU2C" => {
                cells.luts += 2 * number;
                cells.carries += number;
            }
            "TRELLIS_DPR16X4" => cells.luts += 6 * number,
            "TRELLIS_FF" => cells.flip_flops += number,
            "DP16KD" => cells.block_rams += number,
            _ => {}
        }
    }
    let unread = || SynthesisError::Unread { tool: YOSYS.name, what: "cells".to_owned() };
    if cells.flip_flops == 0 { Err(unread()) } else { Ok(cells) }
}

impl Netlist {
    /// Places and routes the netlist for a clock, Hz, on the pins of `lpf`. A missed clock is not
    /// an error.
    ///
    /// # Errors
    /// [`SynthesisError`] if nextpnr is missing, if the part is too small, or if a port has no pin.
    pub fn place_on(
        &self,
        part: &Part,
        lpf: &str,
        clock_hz: u64,
        seed: u32,
    ) -> Result<PlacedDesign, SynthesisError> {
        let folder = tool::folder()?;
        tool::write(folder.path(), "core.json", &self.json)?;
        tool::write(folder.path(), "core.lpf", lpf)?;
        let (mhz, seed) = ((clock_hz as f64 / 1e6).to_string(), seed.to_string());
        let of_part = part.nextpnr();
        let more = [
            "--freq",
            &mhz,
            "--seed",
            &seed,
            "--json",
            "core.json",
            "--lpf",
            "core.lpf",
            "--textcfg",
            "placed.config",
            "--timing-allow-fail",
            "--quiet",
            "--log",
            "log.txt",
        ];
        let arguments: Vec<&str> = of_part.iter().map(String::as_str).chain(more).collect();
        tool::run(&NEXTPNR_ECP5, folder.path(), &arguments)?;
        let log = tool::read(folder.path(), "log.txt")?;
        let log = NextpnrLog { tool: &NEXTPNR_ECP5, text: &log };
        Ok(PlacedDesign {
            config: tool::read(folder.path(), "placed.config")?,
            mhz: log.greatest_clock()?,
            size: Size {
                logic_cells: log.used("TRELLIS_COMB:")?,
                block_rams: log.used("DP16KD:")?,
            },
        })
    }
}

impl PlacedDesign {
    /// The bitstream, compressed as the boards' build scripts make it.
    ///
    /// # Errors
    /// [`SynthesisError`] if ecppack is missing or fails.
    pub fn bitstream(&self) -> Result<Vec<u8>, SynthesisError> {
        let folder = tool::folder()?;
        tool::write(folder.path(), "placed.config", &self.config)?;
        tool::run(
            &ECPPACK,
            folder.path(),
            &["--compress", "placed.config", "--bit", "placed.bit"],
        )?;
        tool::read_bytes(folder.path(), "placed.bit")
    }
}

#[cfg(test)]
mod tests {
    use super::count;

    #[test]
    fn luts_are_counted_as_nextpnr_counts_them() {
        let stat = "   Number of cells:               2494\n     CCU2C                         105\n     \
                    DP16KD                          8\n     LUT4                         1418\n     \
                    PFUMX                         234\n     \
                    TRELLIS_DPR16X4                96\n     TRELLIS_FF                    569\n";
        let found = count(stat).expect("cells");
        assert_eq!((found.luts, found.flip_flops), (2204, 569), "2204 LUT4s according to its log");
        assert_eq!((found.carries, found.block_rams), (105, 8));
        assert!(count("").is_err());
    }
}

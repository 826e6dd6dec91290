//! The way from Verilog to a bitstream for families whose tools differ in names and options only:
//! yosys, a nextpnr, and a program that packs. The commands are those of the boards' build scripts.

use crate::SynthesisError;
use crate::cells::counted;
use crate::ice40::Size;
use crate::nextpnr_log::NextpnrLog;
use crate::programs::Tool;
use crate::tool;
use carrystep_boards::{Mapped, Part};

/// The tools of a family.
pub struct Flow {
    /// yosys.
    pub(crate) yosys: &'static Tool,
    /// Its command that synthesises.
    pub(crate) synth: &'static str,
    /// Adds a number of cells of a kind to those of a design. A LUT is one as nextpnr counts them.
    pub(crate) count: fn(&mut Mapped, &str, u32),
    /// nextpnr.
    pub(crate) nextpnr: &'static Tool,
    /// The file of constraints.
    pub(crate) constraints: &'static str,
    /// Options of nextpnr, with the names of the constraints and of the placed design.
    pub(crate) options: &'static [&'static str],
    /// The file of the placed design.
    pub(crate) placed: &'static str,
    /// The names of LUTs and of block RAMs in nextpnr's log.
    pub(crate) counts: [&'static str; 2],
    /// The program that packs.
    pub(crate) pack: &'static Tool,
    /// Its options. `DIE` stands for the name of the die.
    pub(crate) pack_options: &'static [&'static str],
    /// The file of the bitstream.
    pub(crate) bitstream: &'static str,
}

/// A synthesised design.
pub struct Netlist {
    flow: &'static Flow,
    /// The design in the format that nextpnr reads.
    json: String,
    /// The design as Verilog made of cells.
    pub verilog: String,
}

/// A placed and routed design.
pub struct PlacedDesign {
    flow: &'static Flow,
    /// The placed design, as the program that packs reads it.
    text: String,
    /// The name of the die.
    die: String,
    /// Greatest clock, MHz, at which every path between flip-flops and memories meets its timing,
    /// according to nextpnr.
    pub mhz: f64,
    /// LUTs, with those of carry chains and of memories in LUTs, and block RAMs.
    pub size: Size,
}

impl Flow {
    /// Names of nextpnr and of the program that packs.
    pub(crate) fn stages(&self) -> (&'static str, &'static str) {
        (self.nextpnr.name, self.pack.name)
    }

    /// Synthesises Verilog.
    ///
    /// # Errors
    /// [`SynthesisError`] if yosys is missing or refuses the text, or if a file cannot be used.
    pub fn synthesise(&'static self, verilog: &str, top: &str) -> Result<Netlist, SynthesisError> {
        let folder = tool::folder()?;
        tool::write(folder.path(), "core.v", verilog)?;
        let script = format!(
            "read_verilog core.v; {} -top {top} -json core.json; write_verilog -noattr netlist.v",
            self.synth
        );
        tool::run(self.yosys, folder.path(), &["-q", "-p", &script])?;
        let read = |name| tool::read(folder.path(), name);
        Ok(Netlist { flow: self, json: read("core.json")?, verilog: read("netlist.v")? })
    }

    /// Counts the cells to which yosys maps a design, with LUTs as nextpnr counts them before it
    /// packs.
    ///
    /// # Errors
    /// [`SynthesisError`] if yosys is missing or refuses the text.
    pub fn cells(&self, verilog: &str, top: &str) -> Result<Mapped, SynthesisError> {
        let folder = tool::folder()?;
        tool::write(folder.path(), "core.v", verilog)?;
        let script =
            format!("read_verilog core.v; {} -top {top}; tee -o stat.txt stat", self.synth);
        tool::run(self.yosys, folder.path(), &["-q", "-p", &script])?;
        self.counted(&tool::read(folder.path(), "stat.txt")?)
    }

    /// The cells in the output of yosys' `stat`.
    pub(crate) fn counted(&self, stat: &str) -> Result<Mapped, SynthesisError> {
        let mut cells = Mapped::default();
        for (name, number) in counted(stat) {
            (self.count)(&mut cells, name, number);
        }
        let unread = || SynthesisError::Unread { tool: self.yosys.name, what: "cells".to_owned() };
        if cells.flip_flops == 0 { Err(unread()) } else { Ok(cells) }
    }
}

impl Netlist {
    /// Places and routes the netlist for a clock, Hz, on the pins of these constraints. A missed
    /// clock is not an error.
    ///
    /// # Errors
    /// [`SynthesisError`] if nextpnr is missing, if the part is too small, or if a port has no pin.
    pub fn place_on(
        &self,
        part: &Part,
        constraints: &str,
        clock_hz: u64,
        seed: u32,
    ) -> Result<PlacedDesign, SynthesisError> {
        let (flow, folder) = (self.flow, tool::folder()?);
        tool::write(folder.path(), "core.json", &self.json)?;
        tool::write(folder.path(), flow.constraints, constraints)?;
        let (mhz, seed) = ((clock_hz as f64 / 1e6).to_string(), seed.to_string());
        let of_part = part.nextpnr();
        let mut arguments: Vec<&str> = of_part.iter().map(String::as_str).collect();
        arguments.extend(["--freq", &mhz, "--seed", &seed, "--json", "core.json"]);
        arguments.extend(flow.options);
        arguments.extend(["--timing-allow-fail", "--quiet", "--log", "log.txt"]);
        tool::run(flow.nextpnr, folder.path(), &arguments)?;
        let log = tool::read(folder.path(), "log.txt")?;
        let log = NextpnrLog { tool: flow.nextpnr, text: &log };
        let [luts, block_rams] = flow.counts;
        Ok(PlacedDesign {
            flow,
            text: tool::read(folder.path(), flow.placed)?,
            die: part.die(),
            mhz: log.greatest_clock()?,
            size: Size { logic_cells: log.used(luts)?, block_rams: log.used(block_rams)? },
        })
    }
}

impl PlacedDesign {
    /// The bitstream, as the boards' build scripts make it.
    ///
    /// # Errors
    /// [`SynthesisError`] if the program that packs is missing or fails.
    pub fn bitstream(&self) -> Result<Vec<u8>, SynthesisError> {
        let (flow, folder) = (self.flow, tool::folder()?);
        tool::write(folder.path(), flow.placed, &self.text)?;
        let options = flow.pack_options.iter();
        let arguments: Vec<&str> =
            options.map(|&option| if option == "DIE" { &self.die } else { option }).collect();
        tool::run(flow.pack, folder.path(), &arguments)?;
        tool::read_bytes(folder.path(), flow.bitstream)
    }
}

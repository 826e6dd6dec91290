//! Turns Verilog into an iCE40 bitstream with yosys, nextpnr and icepack, and reads the figures of
//! each stage.

use crate::nextpnr_log::NextpnrLog;
use crate::tool::{self, ICEBOX_VLOG, ICEPACK, ICEUNPACK, NEXTPNR, PYTHON};
use crate::{SynthesisError, cells, read_back};
use carrystep_boards::Ice40Synthesis;
use serde_json::Value;
use std::path::Path;

/// A part: nextpnr's names of its device and of its package.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NextpnrPart<'a> {
    /// Device, such as `hx8k` or `up5k`.
    pub device: &'a str,
    /// Package, such as `ct256`.
    pub package: &'a str,
}

/// Resources of a part that a design uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Logic cells of an iCE40, of which one holds a LUT, a flip-flop, a bit of carry, or all three;
    /// LUTs of an ECP5.
    pub logic_cells: u32,
    /// Block RAMs, of 4 kbit in an iCE40 and 18 kbit in an ECP5.
    pub block_rams: u32,
}

impl Size {
    /// Parses nextpnr's log.
    fn of(log: &str) -> Result<Self, SynthesisError> {
        let log = log_of(log);
        Ok(Self { logic_cells: log.used("ICESTORM_LC:")?, block_rams: log.used("ICESTORM_RAM:")? })
    }
}

/// A synthesised design.
pub struct Netlist {
    top: String,
    /// The commands that made it.
    synthesis: Ice40Synthesis,
    /// The design in the format that nextpnr reads.
    json: String,
    /// The design as Verilog made of cells. Simulators need their models: see
    /// [`Netlist::simulated`].
    pub verilog: String,
}

/// A placed and routed design.
pub struct PlacedDesign {
    /// Configuration bits as text, one tile after the other.
    pub asc: String,
    /// Greatest clock, MHz, at which every path between flip-flops and memories meets its timing,
    /// according to nextpnr.
    pub mhz: f64,
    /// Resources that the design uses.
    pub size: Size,
    /// Delays of all cells and wires, in the format SDF.
    pub sdf: String,
    /// Location of every cell.
    placement: Value,
}

/// Synthesises Verilog for the part of this name, with the commands of the boards' scripts
/// ([`Ice40Synthesis`]).
///
/// # Errors
/// [`SynthesisError`] if yosys is missing or refuses the text, or if a file cannot be used.
pub fn synthesise(verilog: &str, top: &str, device: &str) -> Result<Netlist, SynthesisError> {
    synthesised(verilog, top, Ice40Synthesis::of(device, top), tool::newest_yosys)
}

/// Synthesises Verilog with Debian's yosys and its `synth_ice40` without options, as the cores of
/// other projects were.
pub(crate) fn synthesise_as_others(verilog: &str, top: &str) -> Result<Netlist, SynthesisError> {
    let synth = format!("synth_ice40 -top {top} -run");
    let synthesis = Ice40Synthesis {
        to_flip_flops: format!("{synth} begin:map_luts"),
        to_cells: format!("{synth} map_luts:"),
    };
    synthesised(verilog, top, synthesis, tool::yosys)
}

fn synthesised(
    verilog: &str,
    top: &str,
    synthesis: Ice40Synthesis,
    yosys: impl Fn(&Path, &str) -> Result<String, SynthesisError>,
) -> Result<Netlist, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", verilog)?;
    let script = format!(
        "read_verilog core.v; {} -json core.json; write_verilog -noattr netlist.v",
        synthesis.commands()
    );
    yosys(folder.path(), &script)?;
    let read = |name| tool::read(folder.path(), name);
    let (json, verilog) = (read("core.json")?, read("netlist.v")?);
    Ok(Netlist { top: top.to_owned(), synthesis, json, verilog })
}

impl Netlist {
    /// The netlist with yosys' models of its cells, for simulators.
    ///
    /// # Errors
    /// [`SynthesisError`] if yosys' models are not found.
    pub fn simulated(&self) -> Result<String, SynthesisError> {
        cells::with_models(&self.verilog)
    }

    /// The resources that the netlist uses, without a placement.
    ///
    /// # Errors
    /// [`SynthesisError`] if nextpnr is missing or fails.
    pub fn size(&self, part: NextpnrPart<'_>) -> Result<Size, SynthesisError> {
        let (_, log) = self.nextpnr(part, None, &["--pack-only"])?;
        Size::of(&log)
    }

    /// Places and routes the netlist for a clock, Hz, on pins of nextpnr's choice. A missed clock
    /// is not an error.
    ///
    /// # Errors
    /// [`SynthesisError`] if nextpnr is missing, or if the part is too small.
    pub fn place(
        &self,
        part: NextpnrPart<'_>,
        clock_hz: u64,
        seed: u32,
    ) -> Result<PlacedDesign, SynthesisError> {
        self.placed(part, None, clock_hz, seed)
    }

    /// Places and routes the netlist for a clock, Hz, on the pins of `pcf`, which must list every
    /// port. A missed clock is not an error.
    ///
    /// # Errors
    /// [`SynthesisError`] if nextpnr is missing, if the part is too small, or if a port has no pin.
    pub fn place_on(
        &self,
        part: NextpnrPart<'_>,
        pcf: &str,
        clock_hz: u64,
        seed: u32,
    ) -> Result<PlacedDesign, SynthesisError> {
        self.placed(part, Some(pcf), clock_hz, seed)
    }

    fn placed(
        &self,
        part: NextpnrPart<'_>,
        pcf: Option<&str>,
        clock_hz: u64,
        seed: u32,
    ) -> Result<PlacedDesign, SynthesisError> {
        let (mhz, seed) = ((clock_hz as f64 / 1e6).to_string(), seed.to_string());
        let more = [
            "--freq",
            &mhz,
            "--seed",
            &seed,
            "--timing-allow-fail",
            "--asc",
            "placed.asc",
            "--sdf",
            "placed.sdf",
            "--write",
        ];
        let (folder, log) = self.nextpnr(part, pcf, &[&more[..], &["placed.json"]].concat())?;
        let placement = serde_json::from_str(&tool::read(folder.path(), "placed.json")?);
        Ok(PlacedDesign {
            asc: tool::read(folder.path(), "placed.asc")?,
            mhz: log_of(&log).greatest_clock()?,
            size: Size::of(&log)?,
            sdf: tool::read(folder.path(), "placed.sdf")?,
            placement: placement.map_err(|error| unread(format!("placed.json: {error}")))?,
        })
    }

    /// Runs nextpnr. Returns its directory and its log.
    fn nextpnr(
        &self,
        part: NextpnrPart<'_>,
        pcf: Option<&str>,
        more: &[&str],
    ) -> Result<(tempfile::TempDir, String), SynthesisError> {
        let folder = tool::folder()?;
        tool::write(folder.path(), "core.json", &self.json)?;
        tool::write(folder.path(), "core.pcf", pcf.unwrap_or_default())?;
        let pins: &[&str] =
            if pcf.is_some() { &["--pcf", "core.pcf"] } else { &["--pcf-allow-unconstrained"] };
        let device = format!("--{}", part.device);
        let common = [
            &device,
            "--package",
            part.package,
            "--json",
            "core.json",
            "--quiet",
            "--log",
            "log.txt",
        ];
        tool::run(&NEXTPNR, folder.path(), &[&common[..], pins, more].concat())?;
        let log = tool::read(folder.path(), "log.txt")?;
        Ok((folder, log))
    }

    /// Name of the top module.
    pub(crate) fn top(&self) -> &str {
        &self.top
    }

    /// The commands that made it.
    pub(crate) fn synthesis(&self) -> &Ice40Synthesis {
        &self.synthesis
    }
}

impl PlacedDesign {
    /// nextpnr's description of the placed design: cells with their locations, and nets.
    pub(crate) fn placement(&self) -> &Value {
        &self.placement
    }

    /// Reads the bitstream of these configuration bits back as Verilog. Of the netlist, only the
    /// ports and the names of its flip-flops and memories are used. `asc` is [`PlacedDesign::asc`],
    /// possibly with a bit changed.
    ///
    /// # Errors
    /// [`SynthesisError`] if a tool of icestorm is missing or fails.
    pub fn read_back(&self, netlist: &Netlist, asc: &str) -> Result<String, SynthesisError> {
        let folder = tool::folder()?;
        tool::write(folder.path(), "placed.asc", asc)?;
        tool::run(&ICEPACK, folder.path(), &["placed.asc", "core.bin"])?;
        tool::run(&ICEUNPACK, folder.path(), &["core.bin", "back.asc"])?;
        let text = icebox_vlog(folder.path())?;
        read_back::named(&text, &self.placement, netlist.top())
    }
}

/// Runs icebox_vlog on `back.asc`. Where it stops at the `SB_PLL40_CORE` of a UP5K, the entry that
/// its table lacks is added.
fn icebox_vlog(folder: &Path) -> Result<String, SynthesisError> {
    match tool::run(&ICEBOX_VLOG, folder, &["-S", "back.asc"]) {
        Err(SynthesisError::Tool { message, .. })
            if message.contains("KeyError: 'SHIFTREG_DIV_MODE'") =>
        {
            tool::write(folder, "mended.py", include_str!("icebox_vlog.py"))?;
            tool::run(&PYTHON, folder, &["mended.py", "-S", "back.asc"])
        }
        said => said,
    }
}

/// Verilog that was read back, with yosys' models of the memories, for simulators.
///
/// # Errors
/// [`SynthesisError`] if yosys' models are not found.
pub fn simulated(read_back: &str) -> Result<String, SynthesisError> {
    cells::with_models(read_back)
}

fn unread(what: String) -> SynthesisError {
    SynthesisError::Unread { tool: NEXTPNR.name, what }
}

fn log_of(text: &str) -> NextpnrLog<'_> {
    NextpnrLog { tool: &NEXTPNR, text }
}

//! FPGA families: their toolchains, their clock managers and the electrical standards of their
//! pins. A new family is a variant of [`Family`] and a file of the folder `family`.

use crate::clock::ClockManagers;
use crate::toolchain::Toolchain;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use strum::IntoStaticStr;

mod block_ram;
mod ecp5;
mod gowin;
mod ice40;
mod ice40_synthesis;
mod part;
mod pull_ups;
mod spartan3;
mod spartan3e;
mod spartan6;
mod spartan7;

pub use block_ram::BlockRam;
pub use ice40_synthesis::Ice40Synthesis;
pub use part::Part;
pub use pull_ups::{PullUp, PullUps};

/// An FPGA family. Boards are listed in the order of these variants.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, JsonSchema, Serialize, Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Family {
    /// Lattice iCE40 LP, HX and UltraPlus.
    Ice40,
    /// Lattice ECP5.
    Ecp5,
    /// Gowin GW1N and GW2A.
    Gowin,
    /// Xilinx Spartan-3.
    Spartan3,
    /// Xilinx Spartan-3E.
    Spartan3e,
    /// Xilinx Spartan-6.
    Spartan6,
    /// Xilinx Spartan-7.
    Spartan7,
}

/// What differs between FPGA families. Each family implements it in a file of its own; nothing else
/// asks which family a board has. Names of templates are those of `crates/verilog/templates/board`.
pub trait FpgaFamily: Sync {
    /// Name of the family, as its maker writes it.
    fn title(&self) -> &'static str;

    /// The toolchain that makes the family's bitstreams.
    fn toolchain(&self) -> &'static Toolchain;

    /// The open tools that place designs of this family; `None` if only its maker's tools do.
    fn placer(&self) -> Option<Placer> {
        None
    }

    /// What `logic_cells` of a part counts, for people.
    fn cells(&self) -> &'static str {
        "LUTs"
    }

    /// The name of the family in yosys' `synth_xilinx`; `None` for a family that is not Xilinx'.
    fn yosys(&self) -> Option<&'static str> {
        None
    }

    /// Whether the family's block RAMs can write a part of a word. A Spartan-3 or 3E has only one
    /// write enable per port (Xilinx UG331, 2011, "Using Block RAM"). Memories that are written bit
    /// by bit are then made of LUTs.
    fn writes_parts_of_words(&self) -> bool {
        true
    }

    /// The block RAMs of its parts.
    fn block_rams(&self) -> &'static [BlockRam];

    /// What its pins are until it is configured.
    fn pull_ups(&self) -> PullUps;

    /// Whether engines of this family may have several adders. The small and old families keep one:
    /// it fits them, and they do not reach the clocks for which several are made.
    fn has_several_adders(&self) -> bool {
        true
    }

    /// The family's clock manager. The DCM's ranges are intended to be those of the slowest speed
    /// grade in the low-frequency mode, but they were written from memory. Look them up in the data
    /// sheets (DS099, DS312, DS162) before you rely on a clock near their ends.
    fn clock_managers(&self) -> ClockManagers;

    /// The cell of the clock manager, for a board with this input of its PLL.
    fn clock_cell(&self, pll: Option<PllInput>) -> &'static str;

    /// Template of the clock module.
    fn clock_template(&self) -> &'static str;

    /// Extension of the bitstream.
    fn bitstream(&self) -> &'static str {
        "bit"
    }

    /// Whether its parts are sold in speed grades.
    fn has_speed_grades(&self) -> bool {
        true
    }

    /// Whether a board's file says how the oscillator reaches the PLL.
    fn has_pll_input(&self) -> bool {
        false
    }

    /// The supplies VCCAUX, V, of which a board's file names one; none if it names none.
    fn vccaux(&self) -> &'static [&'static str] {
        &[]
    }

    /// The options with which nextpnr is told a part; none if no nextpnr places the family.
    fn nextpnr(&self, _: &Part) -> Vec<String> {
        Vec::new()
    }

    /// The name of the die within a part; no family but Gowin's has one of its own.
    fn die(&self, part: &Part) -> String {
        part.name.clone()
    }

    /// The order name of a part, as the toolchain uses it.
    fn ordered(&self, part: &Part) -> String {
        format!("{}-{}{}", part.name, part.package, part.speed_suffix())
    }
}

impl Family {
    /// What of a board of this family the tests compare with the Rust-HDL modules on every pin.
    pub fn compared(self) -> &'static str {
        match self.facts().placer() {
            Some(Placer::Ice40) => "bitstream",
            Some(Placer::Ecp5 | Placer::Gowin) => "netlist",
            None => "EDIF",
        }
    }

    /// What differs between this family and others.
    pub fn facts(self) -> &'static dyn FpgaFamily {
        match self {
            Self::Ice40 => &ice40::Ice40,
            Self::Ecp5 => &ecp5::Ecp5,
            Self::Gowin => &gowin::Gowin,
            Self::Spartan3 => &spartan3::Spartan3,
            Self::Spartan3e => &spartan3e::Spartan3e,
            Self::Spartan6 => &spartan6::Spartan6,
            Self::Spartan7 => &spartan7::Spartan7,
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.facts().title())
    }
}

/// A variant of nextpnr, with the tools before and behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Placer {
    /// `synth_ice40`, nextpnr-ice40 and icepack.
    Ice40,
    /// `synth_ecp5`, nextpnr-ecp5 and ecppack.
    Ecp5,
    /// `synth_gowin`, nextpnr-himbaechel-gowin and gowin_pack.
    Gowin,
}

impl Placer {
    /// Whether a board must reach its clock with each seed, and not with one of them: parts of
    /// these families have so much room that a clock which depends on the seed is too fast.
    pub fn needs_each_seed(self) -> bool {
        self != Self::Ice40
    }
}

/// Electrical standard of a pin, which is determined by the voltage of its bank.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, IntoStaticStr, JsonSchema, Serialize, Deserialize,
)]
#[serde(rename_all = "UPPERCASE")]
#[strum(serialize_all = "UPPERCASE")]
pub enum IoStandard {
    /// 3.3 V.
    Lvcmos33,
    /// 3.3 V.
    Lvttl,
    /// 2.5 V.
    Lvcmos25,
    /// 1.8 V.
    Lvcmos18,
}

impl IoStandard {
    /// The standard of this name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let all = [Self::Lvcmos33, Self::Lvttl, Self::Lvcmos25, Self::Lvcmos18];
        all.into_iter().find(|standard| standard.name() == name)
    }

    /// The name of the standard in UCF and XDC files.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Supply voltage of the pin's bank, mV.
    pub const fn millivolts(self) -> u32 {
        match self {
            Self::Lvcmos33 | Self::Lvttl => 3300,
            Self::Lvcmos25 => 2500,
            Self::Lvcmos18 => 1800,
        }
    }
}

/// How the oscillator reaches an iCE40's PLL. The oscillator's pin decides which of the two kinds
/// nextpnr can place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PllInput {
    /// Directly from its pad: `SB_PLL40_PAD`.
    Pad,
    /// By way of the fabric: `SB_PLL40_CORE`.
    Core,
}

//! FPGA families: their toolchains, their clock managers and the electrical standards of their
//! pins.

use crate::clock::ClockManagers;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// An FPGA family. Boards are listed in the order of these variants.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Family {
    /// Lattice iCE40 LP, HX and UltraPlus.
    Ice40,
    /// Xilinx Spartan-3.
    Spartan3,
    /// Xilinx Spartan-3E.
    Spartan3e,
    /// Xilinx Spartan-6.
    Spartan6,
    /// Xilinx Spartan-7.
    Spartan7,
}

/// The tools that make a bitstream.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Toolchain {
    /// yosys, nextpnr and icestorm.
    Open,
    /// ISE 14.7.
    Ise,
    /// Vivado.
    Vivado,
}

impl Family {
    /// The toolchain that makes the family's bitstreams.
    pub const fn toolchain(self) -> Toolchain {
        match self {
            Self::Ice40 => Toolchain::Open,
            Self::Spartan3 | Self::Spartan3e | Self::Spartan6 => Toolchain::Ise,
            Self::Spartan7 => Toolchain::Vivado,
        }
    }

    /// The name of the family in yosys' `synth_xilinx`; `None` for an iCE40, which has a command of
    /// its own.
    pub const fn yosys(self) -> Option<&'static str> {
        match self {
            Self::Ice40 => None,
            Self::Spartan3 => Some("xc3s"),
            Self::Spartan3e => Some("xc3se"),
            Self::Spartan6 => Some("xc6s"),
            Self::Spartan7 => Some("xc7"),
        }
    }

    /// Whether the family's block RAMs can write a part of a word. A Spartan-3 or 3E has only one
    /// write enable per port (Xilinx UG331, 2011, "Using Block RAM"). Memories that are written bit
    /// by bit are then made of LUTs.
    pub const fn writes_parts_of_words(self) -> bool {
        !matches!(self, Self::Spartan3 | Self::Spartan3e)
    }

    /// The family's clock manager. The DCM's ranges are intended to be those of the slowest speed
    /// grade in the low-frequency mode, but they were written from memory. Look them up in the data
    /// sheets (DS099, DS312, DS162) before you rely on a clock near their ends.
    pub const fn clock_managers(self) -> ClockManagers {
        const fn dcm(least_in: u64, least_out: u64, most_out: u64) -> ClockManagers {
            ClockManagers::Dcm { least_in, least_out, most_out }
        }
        match self {
            Self::Ice40 => ClockManagers::Ice40,
            Self::Spartan3 => dcm(1_000_000, 18_000_000, 210_000_000),
            Self::Spartan3e => dcm(1_000_000, 5_000_000, 311_000_000),
            Self::Spartan6 => dcm(1_000_000, 5_000_000, 311_000_000),
            Self::Spartan7 => ClockManagers::Mmcm,
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ice40 => "iCE40",
            Self::Spartan3 => "Spartan-3",
            Self::Spartan3e => "Spartan-3E",
            Self::Spartan6 => "Spartan-6",
            Self::Spartan7 => "Spartan-7",
        })
    }
}

impl fmt::Display for Toolchain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Open => "yosys, nextpnr-ice40, icestorm",
            Self::Ise => "ISE 14.7",
            Self::Vivado => "Vivado",
        })
    }
}

/// Electrical standard of a pin, which is determined by the voltage of its bank.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, JsonSchema, Serialize, Deserialize)]
pub enum IoStandard {
    /// 3.3 V.
    #[serde(rename = "LVCMOS33")]
    Lvcmos33,
    /// 3.3 V.
    #[serde(rename = "LVTTL")]
    Lvttl,
    /// 2.5 V.
    #[serde(rename = "LVCMOS25")]
    Lvcmos25,
    /// 1.8 V.
    #[serde(rename = "LVCMOS18")]
    Lvcmos18,
}

impl IoStandard {
    /// The name of the standard in UCF and XDC files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lvcmos33 => "LVCMOS33",
            Self::Lvttl => "LVTTL",
            Self::Lvcmos25 => "LVCMOS25",
            Self::Lvcmos18 => "LVCMOS18",
        }
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

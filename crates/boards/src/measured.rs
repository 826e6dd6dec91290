//! The resources that the shipped gateware uses on each board, from `data/measured.toml`. The
//! command `cargo xtask long boards` writes that file.

use super::Board;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// Path of the file, from the root of the workspace.
pub const MEASURED_AT: &str = "crates/boards/data/measured.toml";

/// Resources that the shipped gateware uses on the board's first part with its first clock.
#[derive(Debug, Clone, Copy, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Measured {
    /// An iCE40, an ECP5 or a Gowin part, placed with all pins assigned.
    Placed(Placed),
    /// A Spartan, synthesised only. It was not placed with the tools of Xilinx.
    Mapped(Mapped),
}

/// Figures of nextpnr, and of icetime for an iCE40.
#[derive(Debug, Clone, Copy, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Placed {
    /// Logic cells of an iCE40, or LUTs of another family, with those of its carry chains.
    pub logic_cells: u32,
    /// Number of block RAMs.
    pub block_rams: u32,
    /// Greatest clock according to nextpnr, MHz.
    pub nextpnr_mhz: f64,
    /// Greatest clock according to icetime, MHz, which knows iCE40 only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub icetime_mhz: Option<f64>,
    /// The first of nextpnr's seeds that reaches the clock; otherwise the best one.
    pub seed: u32,
    /// Least clock of all five seeds according to nextpnr, MHz, on a board that must reach its clock
    /// with each of them: one with an ECP5 or a Gowin part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least_mhz: Option<f64>,
}

/// Figures of yosys.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mapped {
    /// LUTs of all widths, with inverters and with LUTs used as memory.
    pub luts: u32,
    /// Flip-flops.
    pub flip_flops: u32,
    /// Cells of the carry chain: `MUXCY` and `XORCY` of one bit each up to Spartan-3E, `CARRY4` of
    /// four bits from Spartan-6 on.
    pub carries: u32,
    /// Block RAMs of all sizes.
    pub block_rams: u32,
}

/// Measurements by the name of the board.
pub type AllMeasured = BTreeMap<String, Measured>;

impl Board {
    /// The resources that the gateware uses on this board; `None` for a board that is not shipped.
    pub fn measured(&self) -> Option<Measured> {
        static MEASURED: LazyLock<AllMeasured> = LazyLock::new(|| {
            let text = include_str!("../data/measured.toml");
            toml::from_str(text).unwrap_or_else(|error| unreachable!("{error}"))
        });
        MEASURED.get(&self.name).copied()
    }
}

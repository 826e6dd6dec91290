//! The FPGA of a board, and its names in the tools.

use super::Family;
use schemars::JsonSchema;
use serde::Serialize;

/// An FPGA.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Part {
    #[serde(skip)]
    pub(crate) family: Family,
    /// Name of the part, such as `hx1k` or `xc3s400`.
    pub name: String,
    /// Package, such as `tq144` or `ft256`.
    pub package: String,
    /// Speed grade; an iCE40 has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<u8>,
    /// Logic cells of an iCE40, or LUTs of another family.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub logic_cells: Option<u32>,
    /// Number of block RAMs.
    pub block_rams: u32,
}

impl Part {
    /// The part's order name as ISE and Vivado use it: `xc3s400-ft256-4`, `xc7s25csga324-1`; that of
    /// Lattice for an ECP5: `LFE5U-25F-6BG381C`; that of Gowin: `GW1NR-LV9QN88PC6/I5`. For an
    /// iCE40, its name and package.
    pub fn ordered(&self) -> String {
        self.family.facts().ordered(self)
    }

    /// The options with which nextpnr is told the part: `--hx1k --package tq144`.
    pub fn nextpnr(&self) -> Vec<String> {
        self.family.facts().nextpnr(self)
    }

    /// The name of the die within a Gowin part, such as `GW1N-9C`; otherwise that of the part.
    pub fn die(&self) -> String {
        self.family.facts().die(self)
    }

    /// The family of the part.
    pub fn family(&self) -> Family {
        self.family
    }

    /// The speed grade with a hyphen before it, as the last part of an order name.
    pub(crate) fn speed_suffix(&self) -> String {
        self.speed.map_or_else(String::new, |speed| format!("-{speed}"))
    }
}

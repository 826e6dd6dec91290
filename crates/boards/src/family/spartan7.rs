//! Xilinx Spartan-7.

use super::Part;
use super::block_ram::{BlockRam, OF_18_KBIT};
use super::{FpgaFamily, PllInput, PullUps};
use crate::clock::ClockManagers;
use crate::toolchain::Toolchain;

pub(super) struct Spartan7;

static VIVADO: Toolchain = Toolchain {
    title: "Vivado",
    constraints: "top.xdc",
    scripts: &[("build.tcl", "vivado.tcl")],
    commands: &["vivado -mode batch -source build.tcl"],
    programs: &["vivado"],
    by_hand: Some("vivado -mode batch -source build.tcl"),
};

impl FpgaFamily for Spartan7 {
    fn title(&self) -> &'static str {
        "Spartan-7"
    }

    fn toolchain(&self) -> &'static Toolchain {
        &VIVADO
    }

    fn yosys(&self) -> Option<&'static str> {
        Some("xc7")
    }

    /// A RAMB36 can be two of RAMB18.
    fn block_rams(&self) -> &'static [BlockRam] {
        &[
            BlockRam { halves: 1, widths: OF_18_KBIT, enables: 4 },
            BlockRam { halves: 2, widths: &[(512, 72), (1024, 36), (2048, 18)], enables: 8 },
        ]
    }

    fn pull_ups(&self) -> PullUps {
        // The strength is in DS189, which could not be read.
        PullUps::ChosenBy { pin: "PUDC_B", strongest: None }
    }

    fn clock_managers(&self) -> ClockManagers {
        ClockManagers::Mmcm
    }

    fn clock_cell(&self, _: Option<PllInput>) -> &'static str {
        "MMCME2_BASE"
    }

    fn clock_template(&self) -> &'static str {
        "clock-mmcm.v"
    }

    fn ordered(&self, part: &Part) -> String {
        format!("{}{}{}", part.name, part.package, part.speed_suffix())
    }
}

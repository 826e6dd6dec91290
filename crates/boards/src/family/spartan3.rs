//! Xilinx Spartan-3.

use super::block_ram::{BlockRam, OF_18_KBIT};
use super::{FpgaFamily, PllInput, PullUp, PullUps};
use crate::clock::ClockManagers;
use crate::toolchain::{ISE, Toolchain};

pub(super) struct Spartan3;

impl FpgaFamily for Spartan3 {
    fn title(&self) -> &'static str {
        "Spartan-3"
    }

    fn has_several_adders(&self) -> bool {
        false
    }

    fn toolchain(&self) -> &'static Toolchain {
        &ISE
    }

    fn yosys(&self) -> Option<&'static str> {
        Some("xc3s")
    }

    fn writes_parts_of_words(&self) -> bool {
        false
    }

    fn block_rams(&self) -> &'static [BlockRam] {
        &[BlockRam { halves: 2, widths: OF_18_KBIT, enables: 1 }]
    }

    fn pull_ups(&self) -> PullUps {
        PullUps::ChosenBy {
            pin: "HSWAP_EN",
            strongest: Some(PullUp { most_ua: 2350, source: "Xilinx DS099 v3.1, table 33" }),
        }
    }

    fn clock_managers(&self) -> ClockManagers {
        // From memory: see [`FpgaFamily::clock_managers`]. The data sheet is DS099.
        ClockManagers::Dcm { least_in: 1_000_000, least_out: 18_000_000, most_out: 210_000_000 }
    }

    fn clock_cell(&self, _: Option<PllInput>) -> &'static str {
        "DCM"
    }

    fn clock_template(&self) -> &'static str {
        "clock-dcm.v"
    }
}

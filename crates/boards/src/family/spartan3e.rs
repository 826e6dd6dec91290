//! Xilinx Spartan-3E.

use super::block_ram::{BlockRam, OF_18_KBIT};
use super::{FpgaFamily, PllInput, PullUp, PullUps};
use crate::clock::ClockManagers;
use crate::toolchain::{ISE, Toolchain};

pub(super) struct Spartan3e;

impl FpgaFamily for Spartan3e {
    fn title(&self) -> &'static str {
        "Spartan-3E"
    }

    fn has_several_adders(&self) -> bool {
        false
    }

    fn toolchain(&self) -> &'static Toolchain {
        &ISE
    }

    fn yosys(&self) -> Option<&'static str> {
        Some("xc3se")
    }

    fn writes_parts_of_words(&self) -> bool {
        false
    }

    fn block_rams(&self) -> &'static [BlockRam] {
        &[BlockRam { halves: 2, widths: OF_18_KBIT, enables: 1 }]
    }

    fn pull_ups(&self) -> PullUps {
        PullUps::ChosenBy {
            pin: "HSWAP",
            strongest: Some(PullUp { most_ua: 1240, source: "Xilinx DS312 v4.1, table 78" }),
        }
    }

    fn clock_managers(&self) -> ClockManagers {
        // From memory: see [`FpgaFamily::clock_managers`]. The data sheet is DS312.
        ClockManagers::Dcm { least_in: 1_000_000, least_out: 5_000_000, most_out: 311_000_000 }
    }

    fn clock_cell(&self, _: Option<PllInput>) -> &'static str {
        "DCM_SP"
    }

    fn clock_template(&self) -> &'static str {
        "clock-dcm.v"
    }
}

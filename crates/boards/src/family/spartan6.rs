//! Xilinx Spartan-6.

use super::block_ram::{BlockRam, OF_18_KBIT};
use super::{FpgaFamily, PllInput, PullUp, PullUps};
use crate::clock::ClockManagers;
use crate::toolchain::{ISE, Toolchain};

pub(super) struct Spartan6;

impl FpgaFamily for Spartan6 {
    fn title(&self) -> &'static str {
        "Spartan-6"
    }

    fn has_several_adders(&self) -> bool {
        false
    }

    fn toolchain(&self) -> &'static Toolchain {
        &ISE
    }

    fn yosys(&self) -> Option<&'static str> {
        Some("xc6s")
    }

    /// A RAMB16 can be two of RAMB8.
    fn block_rams(&self) -> &'static [BlockRam] {
        &[
            BlockRam { halves: 1, widths: &[(256, 36), (512, 18), (1024, 9)], enables: 4 },
            BlockRam { halves: 2, widths: OF_18_KBIT, enables: 4 },
        ]
    }

    fn pull_ups(&self) -> PullUps {
        PullUps::ChosenBy {
            pin: "HSWAPEN",
            strongest: Some(PullUp { most_ua: 500, source: "Xilinx DS162 v3.0, table 4" }),
        }
    }

    fn clock_managers(&self) -> ClockManagers {
        // From memory: see [`FpgaFamily::clock_managers`]. The data sheet is DS162.
        ClockManagers::Dcm { least_in: 1_000_000, least_out: 5_000_000, most_out: 311_000_000 }
    }

    fn clock_cell(&self, _: Option<PllInput>) -> &'static str {
        "DCM_SP"
    }

    fn clock_template(&self) -> &'static str {
        "clock-dcm.v"
    }

    fn vccaux(&self) -> &'static [&'static str] {
        &["2.5", "3.3"]
    }
}

//! Lattice iCE40 LP, HX and UltraPlus.

use super::Part;
use super::block_ram::BlockRam;
use super::{FpgaFamily, Placer, PllInput, PullUps};
use crate::clock::ClockManagers;
use crate::toolchain::Toolchain;

pub(super) struct Ice40;

static TOOLCHAIN: Toolchain = Toolchain {
    title: "yosys, nextpnr-ice40, icestorm",
    constraints: "top.pcf",
    scripts: &[("build.sh", "open.sh")],
    commands: &["./build.sh"],
    programs: &["yosys", "nextpnr-ice40", "icepack", "icetime"],
    by_hand: None,
};

impl FpgaFamily for Ice40 {
    fn title(&self) -> &'static str {
        "iCE40"
    }

    fn has_several_adders(&self) -> bool {
        false
    }

    fn toolchain(&self) -> &'static Toolchain {
        &TOOLCHAIN
    }

    fn placer(&self) -> Option<Placer> {
        Some(Placer::Ice40)
    }

    fn cells(&self) -> &'static str {
        "logic cells"
    }

    fn block_rams(&self) -> &'static [BlockRam] {
        const WIDTHS: &[(u32, u32)] = &[(256, 16), (512, 8), (1024, 4), (2048, 2)];
        &[BlockRam { halves: 2, widths: WIDTHS, enables: 16 }]
    }

    fn pull_ups(&self) -> PullUps {
        PullUps::Always
    }

    fn clock_managers(&self) -> ClockManagers {
        ClockManagers::Ice40
    }

    fn clock_cell(&self, pll: Option<PllInput>) -> &'static str {
        if pll == Some(PllInput::Pad) { "SB_PLL40_PAD" } else { "SB_PLL40_CORE" }
    }

    fn clock_template(&self) -> &'static str {
        "clock-ice40.v"
    }

    fn bitstream(&self) -> &'static str {
        "bin"
    }

    fn has_speed_grades(&self) -> bool {
        false
    }

    fn has_pll_input(&self) -> bool {
        true
    }

    fn nextpnr(&self, Part { name, package, .. }: &Part) -> Vec<String> {
        vec![format!("--{name}"), "--package".to_owned(), package.clone()]
    }

    fn ordered(&self, Part { name, package, .. }: &Part) -> String {
        format!("iCE40{}-{}", name.to_uppercase(), package.to_uppercase())
    }
}

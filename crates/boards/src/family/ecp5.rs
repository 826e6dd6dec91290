//! Lattice ECP5.

use super::Part;
use super::block_ram::{BlockRam, OF_18_KBIT};
use super::{FpgaFamily, Placer, PllInput, PullUps};
use crate::clock::ClockManagers;
use crate::toolchain::Toolchain;

pub(super) struct Ecp5;

static TOOLCHAIN: Toolchain = Toolchain {
    title: "yosys, nextpnr-ecp5, prjtrellis",
    constraints: "top.lpf",
    scripts: &[("build.sh", "trellis.sh")],
    commands: &["./build.sh"],
    programs: &["yosys", "nextpnr-ecp5", "ecppack"],
    by_hand: None,
};

impl FpgaFamily for Ecp5 {
    fn title(&self) -> &'static str {
        "ECP5"
    }

    fn toolchain(&self) -> &'static Toolchain {
        &TOOLCHAIN
    }

    fn placer(&self) -> Option<Placer> {
        Some(Placer::Ecp5)
    }

    fn block_rams(&self) -> &'static [BlockRam] {
        &[BlockRam { halves: 2, widths: OF_18_KBIT, enables: 4 }]
    }

    fn pull_ups(&self) -> PullUps {
        PullUps::Unknown
    }

    fn clock_managers(&self) -> ClockManagers {
        ClockManagers::Ecp5
    }

    fn clock_cell(&self, _: Option<PllInput>) -> &'static str {
        "EHXPLLL"
    }

    fn clock_template(&self) -> &'static str {
        "clock-ecp5.v"
    }

    /// nextpnr calls an LFE5U-25F `25k`.
    fn nextpnr(&self, part: &Part) -> Vec<String> {
        let size: String =
            part.name.chars().skip_while(|&c| c != '-').filter(char::is_ascii_digit).collect();
        let speed = part.speed.unwrap_or_default().to_string();
        let options =
            [&format!("--{size}k"), "--package", &part.package.to_uppercase(), "--speed", &speed];
        options.map(str::to_owned).to_vec()
    }

    /// Lattice's order name: `LFE5U-25F-6BG381C`.
    fn ordered(&self, part: &Part) -> String {
        let package = part.package.replace("cabga", "BG").replace("csfbga", "MG");
        format!("{}{}{package}C", part.name.to_uppercase(), part.speed_suffix())
    }
}

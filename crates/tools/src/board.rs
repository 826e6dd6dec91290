//! Builds a board's gateware to a bitstream on its pins, with the figures of the tools.

pub mod page;

use crate::SynthesisError;
use crate::ice40::{self, NextpnrPart, PlacedDesign, Size};
use crate::tool::{self, ICEPACK, ICETIME};

/// Seeds of placement, tried in this order until one reaches the clock. The board's `build.sh` uses
/// the same.
pub const SEEDS: [u32; 5] = [1, 2, 3, 4, 5];

/// A design to be built.
#[derive(Debug, Clone, Copy)]
pub struct BuildJob<'a> {
    /// Verilog of all modules.
    pub verilog: &'a str,
    /// Name of the top module.
    pub top: &'a str,
    /// Constraints that assign each port to a pin.
    pub pcf: &'a str,
    /// The part.
    pub part: NextpnrPart<'a>,
    /// Clock, Hz.
    pub clock_hz: u64,
}

/// A built design.
pub struct Built {
    /// Resources of the part that the design uses.
    pub size: Size,
    /// Seed of the placement that was used.
    pub seed: u32,
    /// Greatest clock according to nextpnr, MHz.
    pub mhz: f64,
    /// Greatest clock according to icetime, MHz.
    pub icetime_mhz: f64,
    /// The bitstream.
    pub bitstream: Vec<u8>,
}

impl Built {
    /// Whether nextpnr reports that a clock, Hz, is reached.
    pub fn reaches(&self, clock_hz: u64) -> bool {
        self.mhz * 1e6 >= clock_hz as f64
    }
}

/// Builds a bitstream. `stage` is called with the name of each program before it is started.
///
/// # Errors
/// [`SynthesisError`] if a tool is missing or refuses the design. If the design is too large, the
/// tool is nextpnr.
pub fn build(job: &BuildJob<'_>, stage: &mut dyn FnMut(&str)) -> Result<Built, SynthesisError> {
    stage("yosys");
    let netlist = ice40::synthesise_for(job.verilog, job.top, job.part.device)?;
    let mut best: Option<(u32, PlacedDesign)> = None;
    let mut failed = None;
    for seed in SEEDS {
        stage(&format!("nextpnr-ice40, seed {seed}"));
        // If a part is nearly full, only some seeds lead to a placement.
        match netlist.place_on(job.part, job.pcf, job.clock_hz, seed) {
            Ok(placed) if best.as_ref().is_none_or(|(_, best)| placed.mhz > best.mhz) => {
                best = Some((seed, placed));
            }
            Ok(_) => {}
            Err(error @ SynthesisError::Tool { .. }) => failed = Some(error),
            Err(error) => return Err(error),
        }
        if best.as_ref().is_some_and(|(_, best)| best.mhz * 1e6 >= job.clock_hz as f64) {
            break;
        }
    }
    let (seed, placed) = match (best, failed) {
        (Some(best), _) => best,
        (None, Some(error)) => return Err(error),
        (None, None) => unreachable!("there are seeds"),
    };
    let folder = tool::folder()?;
    tool::write(folder.path(), "top.asc", &placed.asc)?;
    tool::write(folder.path(), "top.pcf", job.pcf)?;
    stage("icetime");
    let said = tool::run(
        &ICETIME,
        folder.path(),
        &["-d", job.part.device, "-P", job.part.package, "-p", "top.pcf", "-t", "top.asc"],
    )?;
    stage("icepack");
    tool::run(&ICEPACK, folder.path(), &["top.asc", "top.bin"])?;
    let bitstream = std::fs::read(folder.path().join("top.bin")).map_err(|source| {
        SynthesisError::Io { context: "cannot read top.bin".to_owned(), source }
    })?;
    Ok(Built {
        size: placed.size,
        seed,
        mhz: placed.mhz,
        icetime_mhz: slowest_path(&said)?,
        bitstream,
    })
}

/// Reads the line `Total path delay: 11.64 ns (85.92 MHz)`.
fn slowest_path(said: &str) -> Result<f64, SynthesisError> {
    let mhz = said.lines().find_map(|line| {
        line.strip_prefix("Total path delay:")?.split_once('(')?.1.strip_suffix(" MHz)")
    });
    let unread =
        || SynthesisError::Unread { tool: ICETIME.name, what: "the slowest path".to_owned() };
    mhz.and_then(|mhz| mhz.parse().ok()).ok_or_else(unread)
}

#[cfg(test)]
mod tests {
    use super::slowest_path;

    #[test]
    fn output_of_icetime_is_parsed() {
        let said = "// Reading input .asc file..\nTotal number of logic levels: 9\nTotal path delay: 11.64 ns (85.92 MHz)\n";
        assert_eq!(slowest_path(said).unwrap(), 85.92);
        assert!(slowest_path("").is_err());
    }
}

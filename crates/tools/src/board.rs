//! Builds a board's gateware to a bitstream on its pins, with the figures of the tools.

pub mod page;

use crate::flow::Flow;
use crate::ice40::{self, NextpnrPart, Size};
use crate::tool::{self, ICEPACK, ICETIME, NEXTPNR};
use crate::{SynthesisError, ecp5, gowin};
use carrystep_boards::{Part, Placer};

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
    pub constraints: &'a str,
    /// The part.
    pub part: &'a Part,
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
    /// Greatest clock according to icetime, MHz, for an iCE40.
    pub icetime_mhz: Option<f64>,
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
/// [`SynthesisError`] if a tool is missing or refuses the design, or if no open tool places the
/// family. If the design is too large, the tool is nextpnr.
pub fn build(job: &BuildJob<'_>, stage: &mut dyn FnMut(&str)) -> Result<Built, SynthesisError> {
    match job.part.family().facts().placer() {
        Some(Placer::Ice40) => ice40_bitstream(job, stage),
        Some(Placer::Ecp5) => bitstream_of(&ecp5::FLOW, job, stage),
        Some(Placer::Gowin) => bitstream_of(&gowin::FLOW, job, stage),
        None => Err(SynthesisError::Tool {
            tool: NEXTPNR.name,
            message: format!("no open tool places a {}", job.part.family()),
        }),
    }
}

fn ice40_bitstream(
    job: &BuildJob<'_>,
    stage: &mut dyn FnMut(&str),
) -> Result<Built, SynthesisError> {
    let part = NextpnrPart { device: &job.part.name, package: &job.part.package };
    stage("yosys");
    let netlist = ice40::synthesise(job.verilog, job.top, part.device)?;
    let (seed, placed) = first_that_reaches(
        job.clock_hz,
        |seed| {
            stage(&format!("nextpnr-ice40, seed {seed}"));
            netlist.place_on(part, job.constraints, job.clock_hz, seed)
        },
        |placed| placed.mhz,
    )?;
    let folder = tool::folder()?;
    tool::write(folder.path(), "top.asc", &placed.asc)?;
    tool::write(folder.path(), "top.pcf", job.constraints)?;
    stage("icetime");
    let said = tool::run(
        &ICETIME,
        folder.path(),
        &["-d", part.device, "-P", part.package, "-p", "top.pcf", "-t", "top.asc"],
    )?;
    stage("icepack");
    tool::run(&ICEPACK, folder.path(), &["top.asc", "top.bin"])?;
    Ok(Built {
        size: placed.size,
        seed,
        mhz: placed.mhz,
        icetime_mhz: Some(slowest_path(&said)?),
        bitstream: tool::read_bytes(folder.path(), "top.bin")?,
    })
}

fn bitstream_of(
    flow: &'static Flow,
    job: &BuildJob<'_>,
    stage: &mut dyn FnMut(&str),
) -> Result<Built, SynthesisError> {
    let (nextpnr, pack) = flow.stages();
    stage("yosys");
    let netlist = flow.synthesise(job.verilog, job.top)?;
    let (seed, placed) = first_that_reaches(
        job.clock_hz,
        |seed| {
            stage(&format!("{nextpnr}, seed {seed}"));
            netlist.place_on(job.part, job.constraints, job.clock_hz, seed)
        },
        |placed| placed.mhz,
    )?;
    stage(pack);
    let bitstream = placed.bitstream()?;
    Ok(Built { size: placed.size, seed, mhz: placed.mhz, icetime_mhz: None, bitstream })
}

/// The clock, MHz, that each of the [`SEEDS`] reaches on an ECP5 or a Gowin part. `None` for another
/// family, whose boards need one seed only.
///
/// # Errors
/// As [`build`].
pub fn clocks_of_seeds(job: &BuildJob<'_>) -> Result<Option<[f64; SEEDS.len()]>, SynthesisError> {
    let flow = match job.part.family().facts().placer() {
        Some(Placer::Ecp5) => &ecp5::FLOW,
        Some(Placer::Gowin) => &gowin::FLOW,
        Some(Placer::Ice40) | None => return Ok(None),
    };
    let netlist = flow.synthesise(job.verilog, job.top)?;
    let mut clocks = [0.0; SEEDS.len()];
    for (clock, seed) in clocks.iter_mut().zip(SEEDS) {
        *clock = netlist.place_on(job.part, job.constraints, job.clock_hz, seed)?.mhz;
    }
    Ok(Some(clocks))
}

/// The placement of the first seed that reaches a clock, Hz, or else the best one, with its seed.
fn first_that_reaches<P>(
    clock_hz: u64,
    mut place: impl FnMut(u32) -> Result<P, SynthesisError>,
    mhz: impl Fn(&P) -> f64,
) -> Result<(u32, P), SynthesisError> {
    let mut best: Option<(u32, P)> = None;
    let mut failed = None;
    for seed in SEEDS {
        // If a part is nearly full, only some seeds lead to a placement.
        match place(seed) {
            Ok(placed) if best.as_ref().is_none_or(|(_, best)| mhz(&placed) > mhz(best)) => {
                best = Some((seed, placed));
            }
            Ok(_) => {}
            Err(error @ SynthesisError::Tool { .. }) => failed = Some(error),
            Err(error) => return Err(error),
        }
        if best.as_ref().is_some_and(|(_, best)| mhz(best) * 1e6 >= clock_hz as f64) {
            break;
        }
    }
    match (best, failed) {
        (Some(best), _) => Ok(best),
        (None, Some(error)) => Err(error),
        (None, None) => unreachable!("there are seeds"),
    }
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

//! The options of programs in G-code, which `plan`, `simulate`, `check` and `run` share.

use crate::failure::Failure;
use carrystep_program::{AXIS_LETTERS, FromBlock};
use clap::Args;
use std::path::PathBuf;

/// The heading of these options in the help.
pub const HEADING: &str = "Options of G-code programs";

/// The options of programs in G-code, wherever they run.
#[derive(Debug, Args)]
pub struct PlannerArguments {
    /// The machine file. Its axes are called x, y, z, a, b or c.
    #[arg(long, help_heading = HEADING, value_name = "MACHINE.toml")]
    pub machine: Option<PathBuf>,
    /// How far the tool may be from the programmed path, mm; overrides G64 P. Default: G64 P of the
    /// program, otherwise 0.01.
    #[arg(long, help_heading = HEADING, value_name = "MM", value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// How many lines loops and subroutines may run again. Default: 10000000.
    #[arg(long, help_heading = HEADING, value_name = "LINES")]
    pub blocks: Option<u64>,
}

/// The options of a program that does not begin with its first block.
#[derive(Debug, Args)]
pub struct FromArguments {
    /// Begin with this executed block, as `plan --list-blocks` numbers them. The blocks before it
    /// are executed without motion; Z goes up, X and Y to the place, Z down.
    #[arg(
        long,
        help_heading = HEADING,
        value_name = "BLOCK",
        value_parser = clap::value_parser!(u64).range(1..)
    )]
    pub from_block: Option<u64>,
    /// The machine place where the program began, as far as the place of the block depends on it
    /// (G91, G92), mm or degrees.
    #[arg(
        long,
        help_heading = HEADING,
        value_name = "AXIS=PLACE",
        value_delimiter = ',',
        value_parser = place,
        requires = "from_block",
        allow_hyphen_values = true
    )]
    pub began_at: Vec<(usize, f64)>,
    /// The machine height of the way of X and Y to the block, mm. Default: the highest so far.
    #[arg(
        long,
        help_heading = HEADING,
        value_name = "MM",
        value_parser = height,
        requires = "from_block",
        allow_negative_numbers = true
    )]
    pub safe_z: Option<f64>,
    /// How long the spindle turns before Z goes down, s. Default: the G4 behind its M3, otherwise 3.
    #[arg(
        long,
        help_heading = HEADING,
        value_name = "S",
        value_parser = dwell,
        requires = "from_block"
    )]
    pub spindle_dwell: Option<f64>,
}

/// The options of programs in G-code that run on no board.
#[derive(Debug, Args)]
pub struct ProgramArguments {
    #[command(flatten)]
    pub planner: PlannerArguments,
    #[command(flatten)]
    pub from: FromArguments,
    /// The machine place where the program begins, mm or degrees, for example x=10,z=-2. Default: 0.
    /// With --from-block, the machine goes from there to the place of the block.
    #[arg(
        long,
        help_heading = HEADING,
        value_name = "AXIS=PLACE",
        value_delimiter = ',',
        value_parser = place
    )]
    pub at: Vec<(usize, f64)>,
    /// Begin with the work offsets and the tool length that are kept of the board at this port. The
    /// board is not asked. Default: none.
    #[arg(long, help_heading = HEADING, value_name = "PORT")]
    pub offsets_of: Option<String>,
}

/// Reads a tolerance, mm.
pub fn tolerance(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "expected a number of mm".to_owned())?;
    if (1e-6..=1e3).contains(&value) {
        Ok(value)
    } else {
        Err("expected a tolerance from 0.000001 to 1000 mm".to_owned())
    }
}

/// Reads the place of a letter, as the letter's number and mm or degrees.
pub fn place(text: &str) -> Result<(usize, f64), String> {
    let read = text.split_once('=').and_then(|(name, value)| {
        let mut letters = AXIS_LETTERS.iter();
        let letter = letters.position(|letter| name.eq_ignore_ascii_case(&letter.to_string()))?;
        Some((letter, value.parse::<f64>().ok().filter(|value| value.abs() <= 1e9)?))
    });
    read.ok_or_else(|| "expected a letter of x, y, z, a, b, c and a place: x=12.5".to_owned())
}

/// Reads a machine height, mm.
fn height(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|value| value.abs() <= 1e9);
    value.ok_or_else(|| "expected a height in mm".to_owned())
}

/// Reads a dwell, s.
fn dwell(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|value| (0.0..=3600.0).contains(value));
    value.ok_or_else(|| "expected a time from 0 to 3600 s".to_owned())
}

impl FromArguments {
    /// The block with which the program begins, if one is given.
    pub fn from(&self) -> Option<FromBlock> {
        let mut began_at = [None; AXIS_LETTERS.len()];
        for &(letter, at) in &self.began_at {
            began_at[letter] = Some(at);
        }
        let Self { safe_z, spindle_dwell, .. } = *self;
        self.from_block.map(|block| FromBlock { block, began_at, safe_z, spindle_dwell })
    }
}

impl PlannerArguments {
    /// Refuses these options, and other options of programs, for a move file.
    pub fn refuse_for_moves(&self, others: &[(&str, bool)]) -> Result<(), Failure> {
        let own = [
            ("--machine", self.machine.is_some()),
            ("--tolerance", self.tolerance.is_some()),
            ("--blocks", self.blocks.is_some()),
        ];
        match own.iter().chain(others).find(|(_, given)| *given) {
            None => Ok(()),
            Some((option, _)) => Err(Failure::input(format!(
                "{option} is an option of G-code programs: their names end in .ngc, .nc or .gcode"
            ))),
        }
    }
}

impl ProgramArguments {
    /// Refuses options of programs for a move file.
    pub fn refuse_for_moves(&self) -> Result<(), Failure> {
        self.planner.refuse_for_moves(&[
            ("--at", !self.at.is_empty()),
            ("--from-block", self.from.from_block.is_some()),
            ("--offsets-of", self.offsets_of.is_some()),
        ])
    }
}

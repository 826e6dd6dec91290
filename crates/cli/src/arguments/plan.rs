//! The arguments of `carrystep plan`. The docstrings of the fields are the command's help.

use super::program::{HEADING, ProgramArguments};
use clap::Args;
use std::path::PathBuf;

/// The arguments of `carrystep plan`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)] // so that a negative tolerance is refused as one
pub struct PlanArguments {
    /// The move file, or a program in G-code: .ngc, .nc or .gcode.
    #[arg(value_name = "MOVE.toml|JOB.ngc")]
    pub file: PathBuf,
    /// The options of programs.
    #[command(flatten)]
    pub program: ProgramArguments,
    /// Greatest error of an edge where a curve is fitted, ns from 1 up; overrides the moves' own
    /// fit_ns.
    #[arg(long, value_name = "NS", value_parser = clap::value_parser!(u64).range(1..))]
    pub fit_ns: Option<u64>,
    /// List every segment: ticks, V, A, J.
    #[arg(long)]
    pub segments: bool,
    /// List the executed blocks of a program instead: number, line, the time at which the motion
    /// begins, text. With --json-lines, a JSON document in a line for each block.
    #[arg(
        long,
        help_heading = HEADING,
        conflicts_with_all = ["json", "segments", "report", "from_block"]
    )]
    pub list_blocks: bool,
    /// Write a page: the path by speed and by what binds it, the axes beside their limits, where the
    /// time goes. It needs no network.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// One JSON document, segments included (of a program, only the figures).
    #[arg(long)]
    pub json: bool,
    /// A JSON document in a line for each move (of a program for each row: the segments of all axes
    /// for the same ticks), and one for the whole at the end. No move is kept in memory.
    #[arg(long, conflicts_with_all = ["json", "segments"])]
    pub json_lines: bool,
}

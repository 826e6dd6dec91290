//! The arguments of `carrystep machine`. The docstrings of the fields are the command's help.

use clap::{Args, Subcommand};
use std::path::PathBuf;

/// The arguments of `carrystep machine`.
#[derive(Debug, Args)]
pub struct MachineArguments {
    /// What to do with a machine file.
    #[command(subcommand)]
    pub command: MachineCommand,
}

/// The subcommands for machine files.
#[derive(Debug, Subcommand)]
pub enum MachineCommand {
    /// Write a commented machine file. On a terminal it asks for missing options.
    New(MachineNew),
}

/// The arguments of `carrystep machine new`.
#[derive(Debug, Args)]
#[command(after_help = NOTES)]
pub struct MachineNew {
    /// The file that is written.
    #[arg(value_name = "MACHINE.toml")]
    pub file: PathBuf,
    /// The board that the machine is built with: its clock, tick and baud rate are written.
    #[arg(long, value_name = "BOARD", conflicts_with = "clock_hz")]
    pub board: Option<String>,
    /// The FPGA's clock, if carrystep does not know the board; the tick is the shortest that the
    /// engine allows.
    #[arg(long, value_name = "HZ")]
    pub clock_hz: Option<u64>,
    /// How the limit switches are wired: two switches per axis, one per axis, one for all axes, or
    /// none.
    #[arg(long, value_name = "WIRING", value_parser = ["pair", "each", "one", "none"])]
    pub limits: Option<String>,
    /// An axis: its name, then keys of [[machine.axis]]. Repeat for each axis.
    #[arg(long = "axis", value_name = "NAME,KEY=VALUE,...")]
    pub axes: Vec<String>,
    /// Replace an existing file.
    #[arg(long)]
    pub force: bool,
    /// One JSON document instead of the text.
    #[arg(long)]
    pub json: bool,
}

const NOTES: &str = "Example:
  carrystep machine new mill.toml --board icebreaker --limits each \\
    --axis x,unit=mm,lead=40,steps_per_rev=200,microsteps=16,speed_limit=200,accel_limit=3000,driver=tmc2209 \\
    --axis z,unit=mm,lead=8,steps_per_rev=200,microsteps=16,speed_limit_per_min=900,accel_limit=500,driver=tmc2209";

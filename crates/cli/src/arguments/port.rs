//! The arguments of the commands that talk to a board. The docstrings of the fields are the
//! command's help.

use super::program::{FromArguments, HEADING, PlannerArguments};
use clap::{ArgGroup, Args};
use std::path::PathBuf;

/// The port of the board.
#[derive(Debug, Args)]
pub struct PortArguments {
    /// The serial port of the board; `carrystep doctor` lists them.
    #[arg(long = "port", value_name = "PORT")]
    pub name: String,
}

/// The board, for commands that do not need a machine.
#[derive(Debug, Args)]
pub struct PeerArguments {
    #[command(flatten)]
    pub port: PortArguments,
    /// The machine from which the board's gateware must be built; it names the axes. Default: any.
    #[arg(long, value_name = "MACHINE.toml")]
    pub machine: Option<PathBuf>,
    /// The baud rate, if no machine is given.
    #[arg(
        long,
        value_name = "BAUD",
        conflicts_with = "machine",
        default_value_t = carrystep_core::link::DEFAULT_BAUD
    )]
    pub baud: u32,
}

/// The arguments of `carrystep run`.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// The move file, or a program in G-code: .ngc, .nc or .gcode.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    #[command(flatten)]
    pub port: PortArguments,
    #[command(flatten)]
    pub planner: PlannerArguments,
    #[command(flatten)]
    pub from: FromArguments,
    /// Do not ask before a program begins with --from-block.
    #[arg(long, help_heading = HEADING, requires = "from_block")]
    pub yes: bool,
    /// Take the place where the machine is for its zero, although it has limit switches and is not
    /// homed, and ignore `travel`.
    #[arg(long, help_heading = HEADING)]
    pub unhomed: bool,
    /// Greatest error of an edge where a curve is fitted, ns from 1 up; overrides the moves' own
    /// fit_ns.
    #[arg(long, value_name = "NS", value_parser = clap::value_parser!(u64).range(1..))]
    pub fit_ns: Option<u64>,
    /// Begin even if an axis moves further toward a limit that it has just met, although the
    /// gateware may not detect the closed switch.
    #[arg(long)]
    pub into_limit: bool,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `carrystep hold` and `resume`.
#[derive(Debug, Args)]
pub struct ProgramPortArguments {
    #[command(flatten)]
    pub port: PortArguments,
}

/// The arguments of `carrystep override`.
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("what").required(true).multiple(true).args(["feed", "rapid", "spindle"])))]
pub struct OverrideArguments {
    /// The feed, in percent of what the program says: 10 to 200.
    #[arg(long, value_name = "PERCENT", value_parser = clap::value_parser!(u8).range(10..=200))]
    pub feed: Option<u8>,
    /// The speed of rapid moves, in percent of the planned one: 10 to 100.
    #[arg(long, value_name = "PERCENT", value_parser = clap::value_parser!(u8).range(10..=100))]
    pub rapid: Option<u8>,
    /// The speed of the spindle, in percent of what the program says: 10 to 200, at most the
    /// spindle_rpm of the machine file.
    #[arg(long, value_name = "PERCENT", value_parser = clap::value_parser!(u8).range(10..=200))]
    pub spindle: Option<u8>,
    #[command(flatten)]
    pub port: PortArguments,
}

/// The arguments of `carrystep home`.
#[derive(Debug, Args)]
pub struct HomeArguments {
    /// Axes to home, by their names; default: all that have `home = { ... }` in their table. They
    /// go in the order of home_order.
    #[arg(value_name = "AXIS")]
    pub axes: Vec<String>,
    /// The machine.
    #[arg(long, value_name = "MACHINE.toml")]
    pub machine: PathBuf,
    #[command(flatten)]
    pub port: PortArguments,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `carrystep status`.
#[derive(Debug, Args)]
pub struct StatusArguments {
    #[command(flatten)]
    pub peer: PeerArguments,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `carrystep stop`.
#[derive(Debug, Args)]
pub struct Stop {
    #[command(flatten)]
    pub peer: PeerArguments,
    /// Then clear the stop and its cause: the queues are emptied, the positions stay. A `run`,
    /// `jog`, `probe` or `home` that is stopped clears its own stop.
    #[arg(long)]
    pub clear: bool,
    /// Then switch the drivers off. If segments of a stopped move wait, this needs --clear too.
    #[arg(long)]
    pub off: bool,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// The implementation of a virtual board. The values have no docstrings, because clap would then
/// print the help of all options in its long form.
#[cfg(unix)]
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub enum BoardLevel {
    Model,
    Verilator,
}

/// The arguments of `carrystep virtual-board`.
#[cfg(unix)]
#[derive(Debug, Args)]
pub struct VirtualBoard {
    /// The machine whose gateware the board runs.
    #[arg(long, value_name = "MACHINE.toml")]
    pub machine: PathBuf,
    /// The implementation: models, or the exported Verilog, which is far slower than a real board.
    #[arg(long, value_enum, default_value_t = BoardLevel::Model)]
    pub level: BoardLevel,
    /// Run as fast as possible and not in real time, and wait for a host that is late.
    #[arg(long)]
    pub fast: bool,
    /// Write the pins and positions, from the first start to the end: `carrystep check` reads it.
    #[arg(long, value_name = "FILE")]
    pub vcd: Option<PathBuf>,
    /// A limit switch at the low end of an axis, at this position in steps: x=-200. Repeat for each
    /// axis.
    #[arg(long = "min", value_name = "AXIS=STEPS")]
    pub min: Vec<String>,
    /// A limit switch at the high end of an axis, at this position in steps.
    #[arg(long = "max", value_name = "AXIS=STEPS")]
    pub max: Vec<String>,
    /// A plate for the probe: the probe touches it where this axis is at this position in steps, or
    /// below.
    #[arg(long = "probe", value_name = "AXIS=STEPS")]
    pub probe: Vec<String>,
    /// One JSON document at the end; the port is printed on standard error.
    #[arg(long)]
    pub json: bool,
}

//! The definition of the command line. The parser and the help are both made from it, so every
//! change here changes tests/transcripts/help.md.

mod linuxcnc;
mod machine;
mod place;
mod plan;
mod port;
mod profile;
mod program;
mod selftest;
#[cfg(unix)]
mod serve;
mod sweep;
mod table;

use carrystep_simulators::Level;
use carrystep_sweep::Shard;
use carrystep_verilog::Prefix;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{ArgGroup, Args, Parser};
pub use linuxcnc::LinuxcncArguments;
pub use machine::{MachineArguments, MachineCommand, MachineNew};
pub use place::{Jog, OffsetArguments, ProbeArguments};
pub use plan::PlanArguments;
#[cfg(unix)]
pub use port::{BoardLevel, VirtualBoard};
pub use port::{
    HomeArguments, OverrideArguments, PeerArguments, PortArguments, ProgramPortArguments,
    RunArguments, StatusArguments, Stop,
};
pub use profile::ProfileArguments;
pub use program::{PlannerArguments, ProgramArguments};
pub use selftest::SelftestArguments;
#[cfg(unix)]
pub use serve::{ServeArguments, WhenGone};
use std::path::PathBuf;
use std::str::FromStr;
use strum::{EnumString, IntoStaticStr, VariantArray};
pub use sweep::Sweep;
pub use table::{TableArguments, TableKind};

/// Every carry is a step: plan stepper moves for an FPGA that only adds, simulate its gateware
/// cycle by cycle, and check every pulse.
///
/// Begin with `carrystep demo`. A move file names a machine and moves; `carrystep simulate` says
/// whether every pulse is where it should be. Exit status: 0 all is well, 1 the check or the run
/// failed, 2 bad input or an impossible move, 3 a tool is missing, 4 no case of a sweep ran.
#[derive(Debug, Parser)]
#[command(name = "carrystep", version)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Subcommand,
}

/// The subcommands; each has its own file in `commands`.
#[derive(Debug, clap::Subcommand)]
pub enum Subcommand {
    /// The main job on the shipped six-axis machine: plan, Verilog, simulation, check, waveform,
    /// plot.
    Demo(Demo),
    /// Step times, delays and speeds of the curves of the literature: figures, CSV, JSON, plot.
    Profile(ProfileArguments),
    /// Make a C header with a timer compare table for a microcontroller, and the player for it.
    Table(TableArguments),
    /// Show the integer segments of a move file or of a G-code program, the limits reached and the
    /// times.
    Plan(PlanArguments),
    /// Run a move file or a G-code program through the gateware, cycle by cycle, and check every
    /// pulse.
    Simulate(Simulate),
    /// Check a VCD from any simulator or logic analyser against a move file or a G-code program.
    Check(CheckArguments),
    /// Write the gateware as Verilog.
    Verilog(Verilog),
    /// Run many machines and moves on all processors of this computer and report the worst of each
    /// figure.
    Sweep(Sweep),
    /// Run a move file or a G-code program on a board: plan, stream, keep its queues full. Ctrl-C
    /// ramps the axes down; it brings a program to rest on its path, and ends it if it comes again.
    Run(RunArguments),
    /// Let senders drive a board, programs that speak Grbl 1.1: they stream their lines to a
    /// pseudo-terminal or to TCP. Ctrl-C brings the machine to rest on its path and ends it.
    #[cfg(unix)]
    Serve(ServeArguments),
    /// Bring the program of a `run` in another terminal to rest, on its path.
    Hold(ProgramPortArguments),
    /// Let a program go on that is held, or that waits at M0, M1 or M6.
    Resume(ProgramPortArguments),
    /// Change the feed, the speed of rapid moves and that of the spindle while the program of a
    /// `run` in another terminal runs. The limits of the axes stay as they are.
    Override(OverrideArguments),
    /// Move axes of a board, also while the program of a `run` waits at M0, M1 or M6, and set the
    /// work offset of the place where they rest.
    Jog(Jog),
    /// Touch off: move an axis until the probe closes, and set the work offset or the length of the
    /// tool; also while the program of a `run` waits at M0, M1 or M6.
    Probe(ProbeArguments),
    /// Show the work offsets of a board, or set them: the place where the machine is gets these
    /// coordinates. Programs on the board begin with them.
    Offset(OffsetArguments),
    /// Home axes by their limit switches: move off, seek fast, back off, approach slowly, pull off.
    /// If one wire serves both ends of an axis, or all axes, a switch that is still closed after
    /// moving off is not detected (docs/homing.md).
    Home(HomeArguments),
    /// Show the state of a board, the positions of its axes, and the cause of a stop.
    Status(StatusArguments),
    /// Stop all axes of a board, also while `run`, `jog`, `probe` or `home` in another terminal
    /// drives it; resume after a stop (--clear), switch the drivers off (--off).
    Stop(Stop),
    /// Run a virtual board: the gateware of a machine behind a pseudo-terminal, for `run` and the
    /// other commands. Lines on standard input press and release switches (`estop 1`, `min x 1`,
    /// `max x 0`); Ctrl-C or `end` ends it.
    #[cfg(unix)]
    VirtualBoard(VirtualBoard),
    /// Write the configuration of LinuxCNC for a machine: INI, HAL and tool table, for the HAL
    /// component (docs/linuxcnc.md).
    Linuxcnc(LinuxcncArguments),
    /// Write a new machine file.
    Machine(MachineArguments),
    /// Make a board's bitstream: synthesis, placement, timing, with the open tools.
    Build(BuildArguments),
    /// Make the self-test of a board: a bitstream that moves nothing, with which a meter and a
    /// jumper prove the wiring before a motor is connected (docs/self-test.md).
    Selftest(SelftestArguments),
    /// Show the boards, or one of them: part, clock, ticks, and which pin does what.
    Boards(Boards),
    /// Check tools, serial ports and permissions, and name the cause of each problem.
    Doctor(Doctor),
    /// Print the script that completes this command in a shell.
    Completions(Completions),
}

/// The core that the gateware is built from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, EnumString, IntoStaticStr, VariantArray)]
#[strum(serialize_all = "lowercase")]
pub enum Core {
    /// One adder for all axes, with queues and a guard: the product, on boards and everywhere else.
    Engine,
    /// An adder an axis: the article's picture, and what the engine is compared with.
    Parallel,
}

impl Core {
    /// The name of the core on the command line.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// The arguments of `carrystep demo`.
#[derive(Debug, Args)]
pub struct Demo {
    /// Folder for everything that the demo writes.
    #[arg(long, default_value = "sim/out/demo", value_name = "DIR")]
    pub out: PathBuf,
    /// Which gateware: the engine, one adder for all axes with queues and a guard; or its sibling,
    /// an adder an axis.
    #[arg(long, default_value = "engine", value_name = "CORE", value_parser = core())]
    pub core: Core,
    /// Where the gateware runs.
    #[arg(long, default_value = "fast", value_name = "LEVEL", value_parser = level())]
    pub level: Level,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `carrystep simulate`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("waves").args(["vcd", "fst"]).multiple(true))]
#[command(allow_negative_numbers = true)] // so that a negative time is refused as a time
pub struct Simulate {
    /// The move file, or a program in G-code: .ngc, .nc or .gcode.
    #[arg(value_name = "MOVE.toml|JOB.ngc")]
    pub file: PathBuf,
    /// The options of programs.
    #[command(flatten)]
    pub program: ProgramArguments,
    /// Which gateware: the engine, one adder for all axes with queues and a guard; or its sibling,
    /// an adder an axis.
    #[arg(long, default_value = "engine", value_name = "CORE", value_parser = core())]
    pub core: Core,
    /// Where the gateware runs.
    #[arg(long, default_value = "fast", value_name = "LEVEL", value_parser = level())]
    pub level: Level,
    /// Greatest error of an edge where a curve is fitted, ns from 1 up; overrides the moves' own
    /// fit_ns.
    #[arg(long, value_name = "NS", value_parser = clap::value_parser!(u64).range(1..))]
    pub fit_ns: Option<u64>,
    /// Write the waveform: pins, position and V beside the float profile; of a program, pins and
    /// position.
    #[arg(long, value_name = "FILE")]
    pub vcd: Option<PathBuf>,
    /// Write the same waveform as FST, which has a fraction of the size and opens in GTKWave at
    /// once.
    #[arg(long, value_name = "FILE")]
    pub fst: Option<PathBuf>,
    /// Write a GTKWave save file for the waveform (needs --vcd).
    #[arg(long, value_name = "FILE", requires = "vcd")]
    pub save: Option<PathBuf>,
    /// The waveform begins this long after the start of the first move, s (needs --vcd or --fst).
    #[arg(long, value_name = "SECONDS", value_parser = seconds, requires = "waves")]
    pub from: Option<f64>,
    /// The waveform ends this long after the start of the first move, s (needs --vcd or --fst).
    #[arg(long, value_name = "SECONDS", value_parser = seconds, requires = "waves")]
    pub to: Option<f64>,
    /// The waveform shows only these axes, for example x,y (needs --vcd or --fst).
    #[arg(long, value_name = "AXIS", value_delimiter = ',', requires = "waves")]
    pub axes: Vec<String>,
    /// Write time, speed and error of each pulse; of a program, without the error.
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Draw speed and error of each axis as SVG.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Write a page: the path by speed and by what binds it, the axes beside their limits, where the
    /// time goes. It needs no network.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// Reads a time that is not negative, s.
fn seconds(text: &str) -> Result<f64, String> {
    let time = text.parse().map_err(|_| "expected a number of seconds".to_owned())?;
    if (0.0..=4e6).contains(&time) {
        Ok(time)
    } else {
        Err("expected a time from 0 to 4000000 s".to_owned())
    }
}

/// The arguments of `carrystep check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    /// The capture: a VCD.
    #[arg(value_name = "CAPTURE.vcd")]
    pub capture: PathBuf,
    /// The move file that the pulses should follow, or a program in G-code: .ngc, .nc or .gcode.
    #[arg(value_name = "MOVE.toml|JOB.ngc")]
    pub file: PathBuf,
    /// The options of programs.
    #[command(flatten)]
    pub program: ProgramArguments,
    /// Do not compare the times of pulses with the plan: for a capture of another controller. Path,
    /// order, end, places of outputs and pin times are checked.
    #[arg(long, help_heading = program::HEADING)]
    pub path_only: bool,
    /// Greatest error of an edge where a curve is fitted, ns from 1 up; overrides the moves' own
    /// fit_ns.
    #[arg(long, value_name = "NS", value_parser = clap::value_parser!(u64).range(1..))]
    pub fit_ns: Option<u64>,
    /// The signal of a pin in the capture: x.step=top.la.D0, or output_2=top.la.D7 with a program.
    /// Repeat for each pin.
    #[arg(long = "map", value_name = "PIN=SIGNAL")]
    pub map: Vec<String>,
    /// Time of the move's start in the capture; default: found from the pulses, or read from a
    /// capture by carrystep.
    #[arg(long, value_name = "PS", allow_negative_numbers = true)]
    pub origin_ps: Option<i64>,
    /// Uncertainty of the capture's times; for a logic analyser one sample period.
    #[arg(long, default_value_t = 0, value_name = "NS")]
    pub slack_ns: u64,
    /// Check only this slice of the capture: 3/64 is the third of sixty-four. It is kept in the file
    /// of --out, and gives no verdict.
    #[arg(long, value_name = "N/OF", requires = "out", conflicts_with_all = ["junit", "json"])]
    pub slice: Option<Shard>,
    /// The file of the slice.
    #[arg(long, value_name = "SLICE", requires = "slice")]
    pub out: Option<PathBuf>,
    /// Make one report of all slices, from their files.
    #[arg(long, value_name = "SLICE", num_args = 1.., conflicts_with = "slice")]
    pub merge: Vec<PathBuf>,
    /// Also write the result as JUnit XML, a test case for each axis.
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `carrystep verilog`.
#[derive(Debug, Args)]
pub struct Verilog {
    /// Which gateware: the engine, one adder for all axes with queues and a guard; or its sibling,
    /// an adder an axis.
    #[arg(long, default_value = "engine", value_name = "CORE", value_parser = core())]
    pub core: Core,
    /// All gateware of a board instead: a top level with clock, host link and engine, constraints,
    /// a build script.
    #[arg(long, value_name = "BOARD", conflicts_with = "core")]
    pub board: Option<String>,
    /// Which of the board's parts; default: its first.
    #[arg(long, value_name = "PART", requires = "board")]
    pub part: Option<String>,
    /// The machine whose clock, phases, pin timings and guard are built in; default: the shipped
    /// machine, for a board at the board's clock.
    #[arg(long, value_name = "MACHINE.toml")]
    pub machine: Option<PathBuf>,
    /// The beginning of the names of all modules and files: two configurations with different
    /// prefixes can be in one design.
    #[arg(long, default_value_t = Prefix::default(), value_name = "NAME")]
    pub prefix: Prefix,
    /// Folder for all files; default: hdl-out/core, or sim/out/BOARD.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `carrystep build`.
#[derive(Debug, Args)]
pub struct BuildArguments {
    /// The board, by its name or by the file of your own board.
    #[arg(long, value_name = "BOARD")]
    pub board: String,
    /// Which of its parts; default: its first.
    #[arg(long, value_name = "PART")]
    pub part: Option<String>,
    /// The machine whose gateware is built; default: the shipped machine at the board's clock and
    /// tick.
    #[arg(long, value_name = "MACHINE.toml")]
    pub machine: Option<PathBuf>,
    /// Try a clock that is more than 10 % above the one that the board was measured to reach.
    #[arg(long)]
    pub try_clock: bool,
    /// Folder for all files; default: sim/out/BOARD.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `carrystep boards`.
#[derive(Debug, Args)]
pub struct Boards {
    /// One board in full, by its name or by the file of your own board.
    #[arg(value_name = "BOARD")]
    pub board: Option<String>,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `carrystep doctor`.
#[derive(Debug, Args)]
pub struct Doctor {
    /// Check what this board needs; without it, check simulators and the open tools.
    #[arg(value_name = "BOARD")]
    pub board: Option<String>,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `carrystep completions`.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell.
    #[arg(value_name = "SHELL")]
    pub shell: clap_complete::Shell,
}

fn core() -> impl TypedValueParser<Value = Core> {
    named()
}

fn level() -> impl TypedValueParser<Value = Level> {
    named()
}

/// Accepts the names of an enumeration's variants. `ValueEnum` would add the variants' own texts to
/// the help.
fn named<T>() -> impl TypedValueParser<Value = T>
where
    T: VariantArray + Copy + Into<&'static str> + FromStr<Err = strum::ParseError> + Send + Sync,
{
    PossibleValuesParser::new(T::VARIANTS.iter().map(|&variant| variant.into()))
        .try_map(|name| name.parse::<T>())
}

//! One program at any level: model, Rust-HDL, the exported Verilog in Icarus and in Verilator.
//!
//! Every level is fed by the same host (docs/clock-by-clock.md) and reports the same thing: all
//! outputs of the core, in each cycle in which any of them changed. Equal reports are equal pins in
//! every clock.

pub mod board;
mod cache;
pub mod engine;
mod external;
pub mod fast;
pub mod host;
mod how_far;
mod icarus;
pub mod pins;
pub mod replay;
mod tool;
pub mod vectors;
mod verilator;

use carrystep_core::ports::Outputs;
use carrystep_core::{Build, Program};
use carrystep_tools::programs::Tool;
use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};
use thiserror::Error;

pub use how_far::{HowFar, Stage};

/// Where a program is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Level {
    /// `crates/model`, from edge to edge.
    Fast,
    /// `crates/model`, clock by clock.
    Model,
    /// `crates/hdl`, simulated by Rust-HDL itself.
    RustHdl,
    /// The exported Verilog in Icarus Verilog.
    Icarus,
    /// The exported Verilog in Verilator.
    Verilator,
}

impl Level {
    /// All levels, from the fastest down.
    pub const ALL: [Self; 5] = [Self::Fast, Self::Model, Self::RustHdl, Self::Icarus, Self::Verilator];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Model => "model",
            Self::RustHdl => "rust-hdl",
            Self::Icarus => "icarus",
            Self::Verilator => "verilator",
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Level {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|level| level.name() == name).ok_or_else(|| format!("no level is called '{name}'"))
    }
}

/// What is to be run.
#[derive(Debug, Clone, Copy)]
pub struct Job<'a> {
    /// Build parameters of the gateware.
    pub build: &'a Build,
    /// What the host sends.
    pub program: &'a Program,
    /// Cycles in a row with nothing left to do after which the run is over; at least 1.
    pub tail: u64,
    /// The run fails after this many cycles.
    pub max_clocks: u64,
    /// Ends it before its end.
    pub halt: Halt<'a>,
    /// Hears how far it is.
    pub how_far: Option<&'a HowFar>,
}

/// Flags of which any one ends a run with [`LevelError::Halted`]; the loops look at them wherever they come by.
pub type Halt<'a> = &'a [&'a AtomicBool];

/// Whether one of them is set.
pub(crate) fn halted(halt: Halt<'_>) -> bool {
    halt.iter().any(|flag| flag.load(Ordering::Relaxed))
}

impl<'a> Job<'a> {
    /// A job that may take `ticks` ticks of motion, with time for the pipeline and the last pulse.
    pub fn new(build: &'a Build, program: &'a Program, ticks: u64) -> Self {
        let clocks = u64::from(build.timebase.clocks_per_tick());
        let slack = 4 * clocks + build.pins.iter().map(|p| u64::from(p.width + p.gap)).max().unwrap_or(0);
        Self { build, program, tail: slack, max_clocks: (ticks + 8) * clocks + 4 * slack, halt: &[], how_far: None }
    }
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outcome {
    /// Clock cycles run.
    pub clocks: u64,
    /// First cycle in which the first started move's segments are loaded, if any started.
    pub origin: Option<u64>,
    /// The outputs in the last cycle.
    pub last: Outputs,
}

/// Why a run failed.
#[derive(Debug, Error)]
pub enum LevelError {
    /// A program that the level needs is not installed.
    #[error("{} is not installed: {} installs it", .0.name, .0.ways())]
    Missing(Tool),
    /// A program failed.
    #[error("{tool} failed: {message}")]
    Tool {
        /// Its name.
        tool: &'static str,
        /// What it said.
        message: String,
    },
    /// The run did not come to its end.
    #[error("the run was not over after {0} clocks")]
    Endless(u64),
    /// Somebody asked for it.
    #[error("the run was stopped before its end")]
    Halted,
    /// The gateware for these build parameters cannot be made.
    #[error("{0}")]
    Gateware(String),
    /// What is kept of a simulation would be executed, and may be somebody else's.
    #[error("{}: {why}; compiled simulations are executed from there (CARRYSTEP_CACHE names another folder)", .path.display())]
    Cache {
        /// The folder, or a simulation in it.
        path: PathBuf,
        /// What is wrong with it.
        why: &'static str,
    },
    /// A file could not be read or written.
    #[error("{context}: {source}")]
    Io {
        /// What was tried.
        context: String,
        /// The system's answer.
        source: std::io::Error,
    },
}

/// Hears of each cycle in which any output changed, cycle 0 included.
pub type Observer<'a> = dyn FnMut(u64, &Outputs) + 'a;

/// Runs a job at a level.
///
/// # Errors
/// [`LevelError`]: a tool is missing or fails, or the run does not end.
pub fn run(level: Level, job: &Job<'_>, observer: &mut Observer<'_>) -> Result<Outcome, LevelError> {
    match level {
        Level::Fast => fast::replay(job, observer),
        Level::Model => host::run(&mut carrystep_model::SixAxis::new(job.build), job, observer),
        Level::RustHdl => {
            let mut core =
                carrystep_hdl::SixAxisSim::new(job.build).map_err(|e| LevelError::Gateware(e.to_string()))?;
            host::run(&mut core, job, observer)
        }
        Level::Icarus | Level::Verilator => {
            let verilog = carrystep_verilog::six_axis_verilog(job.build, "a simulation")
                .map_err(|e| LevelError::Gateware(e.to_string()))?;
            run_verilog(level, &verilog, job, observer)
        }
    }
}

/// Runs a job on Verilog text whose top is `carrystep_six_axis`, in Icarus or in Verilator.
///
/// # Errors
/// [`LevelError`]: a tool is missing or fails, the level has no Verilog, or the run does not end.
pub fn run_verilog(
    level: Level,
    verilog: &str,
    job: &Job<'_>,
    observer: &mut Observer<'_>,
) -> Result<Outcome, LevelError> {
    match level {
        Level::Icarus => icarus::run(verilog, job, observer),
        Level::Verilator => verilator::run(verilog, job, observer),
        Level::Fast | Level::Model | Level::RustHdl => {
            Err(LevelError::Gateware(format!("the level {level} does not run Verilog")))
        }
    }
}

/// The cycle in which a job's first segments are loaded: the same at every level, so the model is asked.
///
/// # Errors
/// [`LevelError::Endless`]: the program starts nothing.
pub fn origin(job: &Job<'_>) -> Result<u64, LevelError> {
    host::first_start(&mut carrystep_model::SixAxis::new(job.build), job).ok_or(LevelError::Endless(job.max_clocks))
}

/// Whether the tools of a level are installed.
///
/// # Errors
/// [`LevelError::Missing`] names the tool and the line that installs it.
pub fn available(level: Level) -> Result<(), LevelError> {
    match level {
        Level::Fast | Level::Model | Level::RustHdl => Ok(()),
        Level::Icarus => tool::find(&tool::ICARUS),
        Level::Verilator => tool::find(&tool::VERILATOR),
    }
}

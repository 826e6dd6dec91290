//! Runs a program at any level: model, Rust-HDL, or the exported Verilog in Icarus and in
//! Verilator.
//!
//! Every level has the same host (docs/clock-by-clock.md), and reports all outputs of the core in
//! each cycle in which any of them changed. If two reports are equal, the pins are equal in every
//! clock.

mod bench;
pub mod board;
mod cache;
mod commands;
pub mod engine;
mod external;
pub mod fast;
pub mod host;
mod how_far;
mod icarus;
mod listener;
pub mod pins;
pub mod replay;
pub mod timed;
mod tool;
pub mod vectors;
mod verilator;

use carrystep_core::build::{ParallelAxesError, check_parallel_axes};
use carrystep_core::ports::Outputs;
use carrystep_core::{AXES, Build};
use carrystep_tools::programs::Tool;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use strum::{Display, EnumString, IntoStaticStr, VariantArray};
use thiserror::Error;

pub use commands::Commands;
pub use how_far::{HowFar, RunStage};

/// A level: the implementation on which a program is run. The fastest is the first.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Display, EnumString, IntoStaticStr, VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Level {
    /// The fast model of `crates/model`, which computes from edge to edge.
    Fast,
    /// The reference model of `crates/model`, clock by clock.
    Model,
    /// `crates/hdl`, simulated by Rust-HDL itself.
    RustHdl,
    /// The exported Verilog in Icarus Verilog.
    Icarus,
    /// The exported Verilog in Verilator.
    Verilator,
}

impl Level {
    /// Name of the level on the command line.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// A program for the parallel core, and the conditions of its run.
#[derive(Debug, Clone, Copy)]
pub struct Job<'a> {
    /// Build parameters of the gateware.
    pub build: &'a Build,
    /// Number of axes of the core, 1 to 6.
    pub axes: usize,
    /// Commands that the host sends.
    pub program: &'a dyn Commands,
    /// Number of consecutive cycles with nothing left to do after which the run is over; at least
    /// 1.
    pub tail: u64,
    /// The run fails after this number of cycles.
    pub max_clocks: u64,
    /// What the commands that have been read add to this number, if they are planned while they are
    /// run. Only the fast level has such runs.
    pub more_clocks: Option<&'a AtomicU64>,
    /// Flags that end the run early.
    pub halt: Halt<'a>,
    /// Receives the progress of the run.
    pub how_far: Option<&'a HowFar>,
}

/// Flags. If any one is set, the run ends with [`LevelError::Halted`]; the loops test them
/// regularly.
pub type Halt<'a> = &'a [&'a AtomicBool];

/// Whether any of the flags is set.
pub(crate) fn halted(halt: Halt<'_>) -> bool {
    halt.iter().any(|flag| flag.load(Ordering::Relaxed))
}

impl<'a> Job<'a> {
    /// A job of `ticks` ticks of motion on a core of six axes. Its limit of cycles includes time
    /// for the pipeline and the last pulse.
    pub fn new(build: &'a Build, program: &'a dyn Commands, ticks: u64) -> Self {
        let clocks = u64::from(build.timebase.clocks_per_tick());
        let slack = 4 * clocks
            + build.pins.iter().map(|p| u64::from(p.step_high + p.step_low)).max().unwrap_or(0);
        Self {
            build,
            axes: AXES,
            program,
            tail: slack,
            max_clocks: (ticks + 8) * clocks + 4 * slack,
            more_clocks: None,
            halt: &[],
            how_far: None,
        }
    }

    /// Everything on which the output of this job's Verilog depends in Icarus or Verilator, apart
    /// from the simulator itself.
    ///
    /// # Errors
    /// [`LevelError::Gateware`] if there is no such Verilog, or if the level does not run Verilog.
    pub fn question(&self, level: Level) -> Result<Vec<String>, LevelError> {
        let verilog = self.verilog()?;
        match level {
            Level::Icarus => Ok(icarus::question(&verilog, self)),
            Level::Verilator => Ok(verilator::question(&verilog, self)),
            Level::Fast | Level::Model | Level::RustHdl => Err(no_verilog(level)),
        }
    }

    /// The exported Verilog of the core. Hundreds of jobs may follow each other on the same core,
    /// so the last one is remembered: exporting it takes longer than some of them.
    fn verilog(&self) -> Result<Arc<str>, LevelError> {
        static LAST: Mutex<Option<(Build, usize, Arc<str>)>> = Mutex::new(None);
        let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((build, axes, text)) = &*last
            && (build, *axes) == (self.build, self.axes)
        {
            return Ok(Arc::clone(text));
        }
        let text: Arc<str> =
            carrystep_verilog::parallel_verilog(self.build, self.axes, "a simulation")
                .map_err(|e| LevelError::Gateware(e.to_string()))?
                .into();
        *last = Some((self.build.clone(), self.axes, Arc::clone(&text)));
        Ok(text)
    }

    /// The greatest number of cycles, as far as it is known.
    pub(crate) fn limit(&self) -> u64 {
        limit(self.max_clocks, self.more_clocks)
    }
}

/// A greatest number of cycles, with what is added to it while commands are read.
pub(crate) fn limit(max_clocks: u64, more_clocks: Option<&AtomicU64>) -> u64 {
    let more = more_clocks.map_or(0, |more| more.load(Ordering::Relaxed));
    max_clocks.saturating_add(more)
}

/// Result of a run.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Outcome {
    /// Number of clock cycles run.
    pub clocks: u64,
    /// The cycle in which the first started move's segments are loaded; `None` if no start was
    /// executed.
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
    /// An external program failed.
    #[error("{tool} failed: {message}")]
    Tool {
        /// Name of the program.
        tool: &'static str,
        /// The output of the program.
        message: String,
    },
    /// The run did not end within its limit of cycles.
    #[error("the run was not over after {0} clocks")]
    Endless(u64),
    /// The run was halted by a flag.
    #[error("the run was stopped before its end")]
    Halted,
    /// The parallel core cannot have the number of axes of the job.
    #[error(transparent)]
    Axes(#[from] ParallelAxesError),
    /// No gateware can be made for these build parameters.
    #[error("{0}")]
    Gateware(String),
    /// The directory of compiled simulations may have been written by another user; its files would
    /// be executed.
    #[error("{}: {why}; compiled simulations are executed from there (CARRYSTEP_CACHE names another folder)", .path.display())]
    Cache {
        /// The directory, or a simulation in it.
        path: PathBuf,
        /// The reason.
        why: &'static str,
    },
    /// A file could not be read or written.
    #[error("{context}: {source}")]
    Io {
        /// The operation that failed.
        context: String,
        /// The error of the operating system.
        source: std::io::Error,
    },
}

/// Called for each cycle in which any output changed, cycle 0 included.
pub type Observer<'a> = dyn FnMut(u64, &Outputs) + 'a;

/// Runs a job at a level.
///
/// # Errors
/// [`LevelError`] if a tool is missing or fails, or if the run does not end.
pub fn run(
    level: Level,
    job: &Job<'_>,
    observer: &mut Observer<'_>,
) -> Result<Outcome, LevelError> {
    match level {
        Level::Fast => fast::replay(job, observer),
        Level::Model => host::run(&mut model(job)?, job, observer),
        Level::RustHdl => {
            let mut core = carrystep_hdl::ParallelSim::new(job.build, job.axes)
                .map_err(|e| LevelError::Gateware(e.to_string()))?;
            host::run(&mut core, job, observer)
        }
        Level::Icarus | Level::Verilator => run_verilog(level, &job.verilog()?, job, observer),
    }
}

/// Runs a job in Icarus or Verilator on Verilog text whose top is `carrystep_parallel_N` for the N
/// axes of the job.
///
/// # Errors
/// [`LevelError`] if a tool is missing or fails, if the level has no Verilog, or if the run does
/// not end.
pub fn run_verilog(
    level: Level,
    verilog: &str,
    job: &Job<'_>,
    observer: &mut Observer<'_>,
) -> Result<Outcome, LevelError> {
    match level {
        Level::Icarus => icarus::run(verilog, job, observer),
        Level::Verilator => verilator::run(verilog, job, observer),
        Level::Fast | Level::Model | Level::RustHdl => Err(no_verilog(level)),
    }
}

fn no_verilog(level: Level) -> LevelError {
    LevelError::Gateware(format!("the level {level} does not run Verilog"))
}

/// The cycle in which a job's first segments are loaded. It is the same at every level, so the
/// model computes it.
///
/// # Errors
/// [`LevelError::Endless`] if the program has no start; [`LevelError::Axes`] if no core has the
/// number of axes of the job.
pub fn origin(job: &Job<'_>) -> Result<u64, LevelError> {
    host::first_start(&mut model(job)?, job).ok_or_else(|| LevelError::Endless(job.limit()))
}

/// The clock-by-clock model of a job's core.
fn model(job: &Job<'_>) -> Result<carrystep_model::ParallelCore, LevelError> {
    check_parallel_axes(job.axes)?;
    Ok(carrystep_model::ParallelCore::new(job.build, job.axes))
}

/// Checks that the tools of a level are installed.
///
/// # Errors
/// [`LevelError::Missing`] names the tool and the command that installs it.
pub fn available(level: Level) -> Result<(), LevelError> {
    match level {
        Level::Fast | Level::Model | Level::RustHdl => Ok(()),
        Level::Icarus => tool::find(&tool::ICARUS),
        Level::Verilator => tool::find(&tool::VERILATOR),
    }
}

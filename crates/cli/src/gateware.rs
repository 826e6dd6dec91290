//! A common interface to the two cores: the cycle in which a plan's first segments are loaded, and
//! a run with a callback for the pins.

use crate::failure::Failure;
use carrystep_core::EngineBuild;
use carrystep_core::engine::{Cause, EngineError};
use carrystep_files::Machine;
use carrystep_simulators::engine::run::EngineJob;
use carrystep_simulators::{Job, Level, LevelError};

/// A plan on one of the cores.
#[derive(Clone, Copy)]
pub enum CorePlan<'a> {
    Parallel(Job<'a>),
    Engine(EngineJob<'a>),
}

/// The end of a run.
pub struct RunEnd {
    pub clocks: u64,
    /// Position registers in steps, at least of the machine's axes.
    pub positions: Vec<i32>,
    /// The fault that the gateware latched, if there is one.
    pub fault: Option<String>,
}

impl CorePlan<'_> {
    /// The cycle in which the first segments are loaded.
    pub fn origin(&self) -> Result<u64, LevelError> {
        match self {
            Self::Parallel(job) => carrystep_simulators::origin(job),
            Self::Engine(job) => job.origin(),
        }
    }

    /// Runs the plan. `watch` is called with cycle, STEP and DIR (bit i is axis i) in each cycle in
    /// which any output has changed.
    pub fn run(
        &self,
        level: Level,
        watch: &mut dyn FnMut(u64, u8, u8),
    ) -> Result<RunEnd, LevelError> {
        match self {
            Self::Parallel(job) => {
                let outcome = carrystep_simulators::run(level, job, &mut |cycle, outputs| {
                    watch(cycle, outputs.step, outputs.dir);
                })?;
                let (positions, faults) = (outcome.last.position.to_vec(), outcome.last.faults);
                Ok(RunEnd {
                    clocks: outcome.clocks,
                    positions,
                    fault: faults.any().then(|| faults.to_string()),
                })
            }
            Self::Engine(job) => {
                let outcome =
                    job.run(level, &mut |cycle, outputs| watch(cycle, outputs.step, outputs.dir))?;
                Ok(RunEnd {
                    clocks: outcome.clocks,
                    positions: outcome.positions,
                    fault: outcome.fault.map(told),
                })
            }
        }
    }
}

/// The engine of the machine in this file.
///
/// # Errors
/// Status 2, with what would do: another tick, another clock, the parallel core where that can hold
/// the machine.
pub fn engine(machine: &Machine, name: &str) -> Result<EngineBuild, Failure> {
    let engine = machine.engine();
    match engine.check() {
        Ok(()) => Ok(engine),
        Err(error) => Err(Failure::input(format!("{name}: {error}{}", sibling(machine, &error)))),
    }
}

/// What is said of the parallel core where only the engine's time slots do not fit.
fn sibling(machine: &Machine, error: &EngineError) -> &'static str {
    let by_time_slots =
        matches!(error, EngineError::Schedule { .. } | EngineError::ShortPhase { .. });
    if by_time_slots && machine.build().is_ok() {
        "; the parallel core holds it as it is: `--core parallel`"
    } else {
        ""
    }
}

/// A cause, and the axes that it came from.
pub fn told((cause, culprits): (Cause, u8)) -> String {
    let axes: Vec<String> =
        (0..8).filter(|axis| culprits >> axis & 1 == 1).map(|axis| axis.to_string()).collect();
    if axes.is_empty() { cause.to_string() } else { format!("{cause} on axis {}", axes.join(", ")) }
}

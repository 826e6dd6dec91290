//! The two cores behind one face: when a plan's first segments are loaded, and a run whose pins are watched.

use carrystep_core::engine::Cause;
use carrystep_simulators::engine::run::EngineJob;
use carrystep_simulators::{Job, Level, LevelError};

/// A plan on one of the cores.
#[derive(Clone, Copy)]
pub enum Gateware<'a> {
    Parallel(Job<'a>),
    Engine(EngineJob<'a>),
}

/// How a run ended.
pub struct Ended {
    pub clocks: u64,
    /// Position registers, steps; of the machine's axes at least.
    pub positions: Vec<i32>,
    /// What the gateware latched.
    pub fault: Option<String>,
}

impl Gateware<'_> {
    /// The cycle in which the first segments are loaded.
    pub fn origin(&self) -> Result<u64, LevelError> {
        match self {
            Self::Parallel(job) => carrystep_simulators::origin(job),
            Self::Engine(job) => job.origin(),
        }
    }

    /// Runs it; hears of STEP and DIR, bit i is axis i, in each cycle in which any output changed.
    pub fn run(&self, level: Level, watch: &mut dyn FnMut(u64, u8, u8)) -> Result<Ended, LevelError> {
        match self {
            Self::Parallel(job) => {
                let outcome = carrystep_simulators::run(level, job, &mut |cycle, outputs| {
                    watch(cycle, outputs.step, outputs.dir)
                })?;
                let (positions, faults) = (outcome.last.position.to_vec(), outcome.last.faults);
                Ok(Ended { clocks: outcome.clocks, positions, fault: faults.any().then(|| faults.to_string()) })
            }
            Self::Engine(job) => {
                let outcome = job.run(level, &mut |cycle, outputs| watch(cycle, outputs.step, outputs.dir))?;
                Ok(Ended { clocks: outcome.clocks, positions: outcome.positions, fault: outcome.fault.map(told) })
            }
        }
    }
}

/// A cause, and the axes that it came from.
pub fn told((cause, culprits): (Cause, u8)) -> String {
    let axes: Vec<String> = (0..8).filter(|axis| culprits >> axis & 1 == 1).map(|axis| axis.to_string()).collect();
    if axes.is_empty() { cause.to_string() } else { format!("{cause} on axis {}", axes.join(", ")) }
}

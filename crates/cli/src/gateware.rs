//! A common interface to the two cores: the cycle in which a plan's first segments are loaded, and
//! a run with a callback for the pins.

use crate::failure::Failure;
use crate::interrupt;
use carrystep_check::{OutputPins, PinSink};
use carrystep_core::engine::{Cause, EngineError, EngineOutputs};
use carrystep_core::{EngineBuild, Timebase};
use carrystep_files::Machine;
use carrystep_simulators::engine::run::EngineJob;
use carrystep_simulators::pins::PinFeed;
use carrystep_simulators::{HowFar, Job, Level, LevelError};
use std::sync::atomic::{AtomicBool, Ordering};

/// A plan on one of the cores.
#[derive(Clone, Copy)]
pub enum CorePlan<'a> {
    Parallel(Job<'a>),
    Engine(EngineJob<'a>),
}

/// The pins of a core in a cycle: STEP and DIR of each axis, and its outputs, one bit each.
#[derive(Clone, Copy)]
struct Pins {
    step: u8,
    dir: u8,
    outputs: u8,
    pwm: bool,
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

    /// Runs the plan and sends the pins of the first `axes` axes to a sink. If the sink fails, `deaf`
    /// is set, which ends the run early if it is one of the plan's reasons to halt.
    ///
    /// # Errors
    /// The run was interrupted or has failed, or the sink has failed; an error of the sink goes
    /// before the end of the run that it causes.
    pub fn run_into(
        &self,
        level: Level,
        timebase: Timebase,
        axes: usize,
        sink: &mut dyn PinSink,
        (how_far, deaf): (&HowFar, &AtomicBool),
    ) -> Result<RunEnd, Failure> {
        let mut feed = PinFeed::new(timebase, axes, sink);
        let end = self.run(level, &mut |cycle, pins| {
            how_far.at(cycle);
            feed.pins(cycle, pins.step, pins.dir);
            feed.outputs(cycle, pins.outputs);
            feed.pwm(cycle, pins.pwm);
            if feed.has_failed() {
                deaf.store(true, Ordering::Relaxed);
            }
        });
        interrupt::check()?;
        if let Err(LevelError::Halted) = end {
            // The feed holds the cause.
            return Err(feed.end(0).err().map_or(LevelError::Halted.into(), Failure::from));
        }
        let end = end?;
        feed.end(end.clocks)?;
        Ok(end)
    }

    /// Runs the plan. `watch` is called with the cycle and the pins in each cycle in which any of the
    /// core's outputs has changed.
    fn run(&self, level: Level, watch: &mut dyn FnMut(u64, Pins)) -> Result<RunEnd, LevelError> {
        match self {
            Self::Parallel(job) => {
                let outcome = carrystep_simulators::run(level, job, &mut |cycle, outputs| {
                    let (step, dir) = (outputs.step, outputs.dir);
                    watch(cycle, Pins { step, dir, outputs: 0, pwm: false });
                })?;
                let (positions, faults) = (outcome.last.position.to_vec(), outcome.last.faults);
                Ok(RunEnd {
                    clocks: outcome.clocks,
                    positions,
                    fault: faults.any().then(|| faults.to_string()),
                })
            }
            Self::Engine(job) => {
                let outcome = job.run(level, &mut |cycle, outputs| {
                    let EngineOutputs { step, dir, outputs, pwm, .. } = *outputs;
                    watch(cycle, Pins { step, dir, outputs, pwm });
                })?;
                Ok(RunEnd {
                    clocks: outcome.clocks,
                    positions: outcome.positions,
                    fault: outcome.fault.map(told),
                })
            }
        }
    }
}

/// The output pins of an engine.
pub const fn output_pins(build: &EngineBuild) -> OutputPins {
    OutputPins { outputs: build.outputs.exist, pwm: build.outputs.pwm_divider > 0 }
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

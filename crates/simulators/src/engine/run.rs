//! Runs planned moves on the engine, at any level that has one.

use super::replay::{self, Recording};
use super::{EngineCore, EngineHost};
use crate::{Commands, Halt, HowFar, Level, LevelError, RunStage, halted, how_far};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{Cause, EngineOutputs};
use carrystep_hdl::EngineSim;
use carrystep_model::Engine;
use std::sync::atomic::AtomicU64;

/// Ticks that a host may need for the words of one segment, with a reserve. Runs are limited by it.
pub const TICKS_TO_SEND: u64 = 10;

/// Index of the position in what is kept of an axis.
const POSITION: usize = 2;

/// Planned moves for an engine, with a host that keeps its queues full.
#[derive(Debug, Clone, Copy)]
pub struct EngineJob<'a> {
    /// Build parameters of the engine.
    pub build: &'a EngineBuild,
    /// Commands of the moves.
    pub program: &'a dyn Commands,
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

/// Result of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EngineOutcome {
    /// Number of clock cycles run.
    pub clocks: u64,
    /// Position registers, in steps.
    pub positions: Vec<i32>,
    /// The stop in force at the end: its cause, and the mask of the axes that caused it.
    pub fault: Option<(Cause, u8)>,
}

/// Called for each cycle in which any output changed; words of state are left out. At the fast
/// level, changes of `put_ready` and `start_ready` are ignored, and both are reported as 0.
pub type EngineObserver<'a> = dyn FnMut(u64, &EngineOutputs) + 'a;

impl<'a> EngineJob<'a> {
    /// A job of `ticks` ticks of motion. Its limit of cycles includes time for the drivers' power
    /// and for the words of all segments.
    pub fn new(build: &'a EngineBuild, program: &'a dyn Commands, ticks: u64) -> Self {
        let warm = u64::from(build.guard.enable + 1) * u64::from(build.guard.round);
        let pins = build
            .pins
            .iter()
            .map(|pins| u64::from(pins.step_high + pins.step_low))
            .max()
            .unwrap_or(0);
        let clocks = u64::from(build.timebase.clocks_per_tick());
        let max_clocks =
            (ticks + warm + TICKS_TO_SEND * program.segments() + 100) * clocks + 4 * pins;
        Self { build, program, max_clocks, more_clocks: None, halt: &[], how_far: None }
    }

    pub(super) fn host(&self) -> EngineHost<'_> {
        EngineHost::feeding(self.build, self.program)
    }

    /// Runs the job at a level.
    ///
    /// The Verilog of an engine is compared with the model in every output of every clock, so that
    /// the reported outputs are those of both.
    ///
    /// # Errors
    /// [`LevelError`] if a tool is missing or fails, if the run does not end or is halted, or if
    /// the Verilog differs.
    pub fn run(
        &self,
        level: Level,
        observer: &mut EngineObserver<'_>,
    ) -> Result<EngineOutcome, LevelError> {
        let axes = 0..self.build.axes();
        let gateware = |error: &dyn std::fmt::Display| LevelError::Gateware(error.to_string());
        match level {
            Level::Fast => self.observe_fast(observer),
            Level::Model => {
                let mut model = Engine::new(self.build);
                let (clocks, fault) = self.drive(&mut model, observer)?;
                let positions = axes.map(|axis| model.shaper(axis).position).collect();
                Ok(EngineOutcome { clocks, positions, fault })
            }
            Level::RustHdl => {
                let mut sim = EngineSim::new(self.build).map_err(|error| gateware(&error))?;
                let (clocks, fault) = self.drive(&mut sim, observer)?;
                let positions = axes.map(|axis| sim.kept(axis, POSITION).cast_signed()).collect();
                Ok(EngineOutcome { clocks, positions, fault })
            }
            Level::Icarus | Level::Verilator => {
                let verilog = carrystep_verilog::engine_verilog(self.build, "a simulation")
                    .map_err(|error| gateware(&error))?;
                let begin =
                    |stage| self.how_far.into_iter().for_each(|how_far| how_far.begin(stage));
                begin(RunStage::ModelRuns);
                let recording = Recording::of(
                    self.build,
                    self.host(),
                    self.max_clocks,
                    self.halt,
                    self.how_far,
                );
                begin(RunStage::VerilogRuns);
                if halted(self.halt) {
                    return Err(LevelError::Halted);
                }
                if recording.clocks == self.max_clocks {
                    return Err(LevelError::Endless(self.max_clocks));
                }
                if let Some(found) = replay::difference(level, &verilog, &recording)? {
                    return Err(LevelError::Gateware(format!(
                        "{level} differs from the model: {found}"
                    )));
                }
                recording.outputs.iter().for_each(|(cycle, outputs)| observer(*cycle, outputs));
                let positions =
                    axes.map(|axis| recording.kept[axis][POSITION].cast_signed()).collect();
                let fault = recording.outputs.last().and_then(|(_, outputs)| outputs.fault);
                Ok(EngineOutcome { clocks: recording.clocks, positions, fault })
            }
        }
    }

    /// Runs to the end, and for as many ticks of rest as are needed until every step has been
    /// counted.
    fn drive(
        &self,
        core: &mut impl EngineCore,
        observer: &mut EngineObserver<'_>,
    ) -> Result<(u64, Option<(Cause, u8)>), LevelError> {
        let mut host = self.host();
        let settle = replay::settle(self.build);
        let (mut quiet, mut before) = (0, None);
        for cycle in 0..self.max_clocks {
            if halted(self.halt) {
                return Err(LevelError::Halted);
            }
            how_far::tell(self.how_far, cycle);
            let (_, outputs) = host.step(core);
            let recorded = outputs.recorded();
            if before != Some(recorded) {
                observer(cycle, &recorded);
                before = Some(recorded);
            }
            quiet = if host.is_done() && (outputs.idle || outputs.halted) { quiet + 1 } else { 0 };
            if quiet == settle {
                return Ok((cycle + 1, outputs.fault));
            }
        }
        Err(LevelError::Endless(self.max_clocks))
    }
}

//! The fast engine under its host, which waits for many cycles at once.

use super::run::{EngineJob, EngineObserver, EngineOutcome};
use super::{EngineHost, replay};
use crate::fast::{EdgesOnly, Listener};
use crate::replay::Replay;
use crate::{LevelError, halted, how_far};
use carrystep_core::engine::EngineOutputs;
use carrystep_model::FastEngine;

/// A host and its engine, from cycle to cycle or over many of them.
struct Fed {
    core: FastEngine,
    host: EngineHost,
}

impl Fed {
    /// Goes on by a cycle at least, `most` at the most, or `most_at_rest` where nothing is left to be done; how many
    /// cycles, and the outputs in the first of them.
    fn advance(
        &mut self,
        most: u64,
        most_at_rest: u64,
        listener: &mut impl Listener<EngineOutputs>,
    ) -> (u64, EngineOutputs) {
        let (inputs, outputs) = self.host.meet(|inputs| self.core.outputs(inputs));
        // They change several times a tick, or while nothing else does, whether or not anybody offers anything.
        let quiet = EngineOutputs { put_ready: false, start_ready: false, ready: false, ..outputs };
        let told = EngineOutputs { latch: None, room: None, ..quiet };
        listener.outputs(self.core.cycle(), &told);
        let rests = self.host.is_done() && (outputs.idle || outputs.halted);
        let patience = self.host.patience(&outputs).min(if rests { most_at_rest.min(most) } else { most });
        let cycles = if patience > 0 { self.core.leap(&inputs, patience, listener) } else { 0 };
        if cycles > 0 {
            self.host.wait(cycles);
        } else {
            self.host.advance(&outputs);
            self.core.clock(&inputs, listener);
        }
        (cycles.max(1), outputs)
    }
}

impl EngineJob<'_> {
    fn fed(&self) -> Fed {
        Fed { core: FastEngine::new(self.build), host: self.host() }
    }

    /// Runs it on the fast engine; the edges stream by.
    ///
    /// # Errors
    /// [`LevelError::Endless`]: the run does not end; [`LevelError::Halted`]: it is to.
    pub fn run_fast(&self, listener: &mut impl Listener<EngineOutputs>) -> Result<EngineOutcome, LevelError> {
        let mut fed = self.fed();
        let settle = replay::settle(self.build);
        let mut quiet = 0;
        while fed.core.cycle() < self.max_clocks {
            if halted(self.halt) {
                return Err(LevelError::Halted);
            }
            how_far::tell(self.how_far, fed.core.cycle());
            let (cycles, outputs) = fed.advance(self.max_clocks - fed.core.cycle(), settle - quiet, listener);
            quiet = if fed.host.is_done() && (outputs.idle || outputs.halted) { quiet + cycles } else { 0 };
            if quiet == settle {
                let positions = (0..self.build.axes()).map(|axis| fed.core.core().shaper(axis).position).collect();
                return Ok(EngineOutcome { clocks: fed.core.cycle(), positions, fault: outputs.fault });
            }
        }
        Err(LevelError::Endless(self.max_clocks))
    }

    /// The same for an observer, who hears of each cycle in which any output changed but the two `ready`s,
    /// which are told to be 0.
    pub(super) fn observe_fast(&self, observer: &mut EngineObserver<'_>) -> Result<EngineOutcome, LevelError> {
        let mut replay = Replay::new(&self.build.pins, observer);
        let end = self.run_fast(&mut replay);
        replay.reach(end.as_ref().map_or(self.max_clocks, |outcome| outcome.clocks));
        end
    }

    /// The cycle in which the first segments are loaded: the same at every level, so the fast model is asked.
    ///
    /// # Errors
    /// [`LevelError::Endless`]: nothing starts.
    pub fn origin(&self) -> Result<u64, LevelError> {
        let mut fed = self.fed();
        while fed.core.cycle() < self.max_clocks {
            let most = self.max_clocks - fed.core.cycle();
            // A leap starts nothing.
            if fed.advance(most, most, &mut EdgesOnly(())).1.started {
                return Ok(fed.core.cycle());
            }
        }
        Err(LevelError::Endless(self.max_clocks))
    }
}

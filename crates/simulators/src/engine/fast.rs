//! Runs the fast engine under its host, which can wait for many cycles at once.

use super::run::{EngineJob, EngineObserver, EngineOutcome};
use super::{EngineHost, replay};
use crate::fast::{EdgesOnly, Listener};
use crate::replay::Replay;
use crate::{LevelError, halted, how_far, limit};
use carrystep_core::engine::EngineOutputs;
use carrystep_model::FastEngine;

/// A host and its engine, advanced by one cycle or by many.
struct Fed<'a> {
    core: FastEngine,
    host: EngineHost<'a>,
}

impl Fed<'_> {
    /// Advances by at least one cycle, and by at most `most`, or `most_at_rest` if nothing is left
    /// to do. Returns the number of cycles and the outputs in the first of them.
    fn advance(
        &mut self,
        most: u64,
        most_at_rest: u64,
        listener: &mut impl Listener<EngineOutputs>,
    ) -> (u64, EngineOutputs) {
        let (inputs, outputs) = self.host.meet(|inputs| self.core.outputs(inputs));
        // These outputs change several times per tick, or while nothing else does, whether or not
        // the host offers anything.
        let quiet = EngineOutputs { put_ready: false, start_ready: false, ready: false, ..outputs };
        let told = EngineOutputs { room: None, ..quiet };
        listener.outputs(self.core.cycle(), &told);
        let rests = self.host.is_done() && (outputs.idle || outputs.halted);
        let most = if rests { most_at_rest.min(most) } else { most };
        let patience = self.host.patience_but_for_words(&outputs).min(most);
        let (cycles, words) = if patience > 0 {
            self.core.leap_taking(&inputs, self.host.offered(), patience, listener)
        } else {
            (0, 0)
        };
        if cycles > 0 {
            self.host.wait(cycles);
            self.host.accepted(words);
        } else {
            self.host.advance(&outputs);
            self.core.clock(&inputs, listener);
        }
        (cycles.max(1), outputs)
    }
}

impl EngineJob<'_> {
    /// The greatest number of cycles, as far as it is known.
    fn limit(&self) -> u64 {
        limit(self.max_clocks, self.more_clocks)
    }

    fn fed(&self) -> Fed<'_> {
        Fed { core: FastEngine::new(self.build), host: self.host() }
    }

    /// Runs the program on the fast engine; `listener` receives the edges as they occur.
    ///
    /// # Errors
    /// [`LevelError::Endless`] if the run does not end; [`LevelError::Halted`] if it was halted.
    pub fn run_fast(
        &self,
        listener: &mut impl Listener<EngineOutputs>,
    ) -> Result<EngineOutcome, LevelError> {
        let mut fed = self.fed();
        let settle = replay::settle(self.build);
        let mut quiet = 0;
        while fed.core.cycle() < self.limit() {
            if halted(self.halt) {
                return Err(LevelError::Halted);
            }
            how_far::tell(self.how_far, fed.core.cycle());
            let (cycles, outputs) =
                fed.advance(self.limit() - fed.core.cycle(), settle - quiet, listener);
            quiet = if fed.host.is_done() && (outputs.idle || outputs.halted) {
                quiet + cycles
            } else {
                0
            };
            if quiet == settle {
                let positions = (0..self.build.axes())
                    .map(|axis| fed.core.core().shaper(axis).position)
                    .collect();
                return Ok(EngineOutcome {
                    clocks: fed.core.cycle(),
                    positions,
                    fault: outputs.fault,
                });
            }
        }
        Err(LevelError::Endless(self.limit()))
    }

    /// As [`Self::run_fast`], for an observer. It is called for each cycle in which any output
    /// changed except `put_ready` and `start_ready`, which are reported as 0.
    pub(super) fn observe_fast(
        &self,
        observer: &mut EngineObserver<'_>,
    ) -> Result<EngineOutcome, LevelError> {
        let mut replay =
            Replay::new(&self.build.pins, observer).with_pwm(self.build.outputs.pwm_divider);
        let end = self.run_fast(&mut replay);
        replay.reach(end.as_ref().map_or(self.limit(), |outcome| outcome.clocks));
        end
    }

    /// The cycle in which the first segments are loaded. It is the same at every level, so the fast
    /// model computes it.
    ///
    /// # Errors
    /// [`LevelError::Endless`] if no start is executed.
    pub fn origin(&self) -> Result<u64, LevelError> {
        let mut fed = self.fed();
        while fed.core.cycle() < self.limit() {
            let most = self.limit() - fed.core.cycle();
            // A leap over several cycles contains no start.
            if fed.advance(most, most, &mut EdgesOnly(())).1.started {
                return Ok(fed.core.cycle());
            }
        }
        Err(LevelError::Endless(self.limit()))
    }
}

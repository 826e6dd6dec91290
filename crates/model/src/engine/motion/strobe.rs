//! The strobe of the engine: it commits the results of a tick for all axes together, and decides
//! about an armed start and about the stop. It must stay equal to "The host" and "Stops" in
//! docs/clock-by-clock.md.

use super::axis_model::AxisModel;
use super::guard::Stop;
use super::{Motion, bits};
use carrystep_core::engine::{Cause, EngineInputs};
use std::sync::Arc;

impl Motion {
    /// The axes after this tick, and the causes of stops that they found, in the order of the axes.
    pub(super) fn ticked(&self) -> (Vec<AxisModel>, Vec<(Cause, usize)>) {
        let tick = self.tick();
        let mut found = Vec::new();
        let axis_models = self.axis_models.iter().enumerate().map(|(axis, axis_model)| {
            let (next, cause) = axis_model.tick(tick, self.sample_of(axis));
            found.extend(cause.map(|cause| (cause, axis)));
            next
        });
        (axis_models.collect(), found)
    }

    /// Decides at this strobe about the armed start. A start of an axis whose seek had hit when
    /// this tick began is dropped. A hit in this very tick does not change the decision.
    pub(super) fn decision(
        &self,
        (ticked, found): &(Vec<AxisModel>, Vec<(Cause, usize)>),
    ) -> Decision {
        let free = self.stop.fault.is_none() && found.is_empty();
        let Some(mask) = self.armed.filter(|_| free) else { return Decision::Wait };
        let masked = |axes: u8| mask & axes != 0;
        if masked(bits(&self.axis_models, |axis_model| axis_model.seek.ramps)) {
            Decision::Drop
        } else if masked(bits(&self.axis_models, |axis_model| axis_model.queue.is_empty())) {
            // A start needs a segment that was in the queue before this tick.
            Decision::Unfed
        } else if masked(bits(ticked, |axis_model| axis_model.running.is_some())) {
            Decision::Wait
        } else {
            Decision::Go(mask)
        }
    }

    /// Executes the strobe: commits the results of the tick, and returns the state of the stop
    /// after it. A start that the host asks for is accepted if `start_ready`.
    pub(super) fn end_tick(
        &mut self,
        inputs: &EngineInputs,
        start_ready: bool,
        mut stop: Stop,
        busy: bool,
    ) -> Stop {
        let before = self.stop;
        let build = Arc::clone(&self.build);
        let guard = &build.guard;
        let ticked = self.ticked();
        let decision = self.decision(&ticked);
        let (mut axis_models, found) = ticked;
        let ran = self.axis_models.iter().any(|axis_model| axis_model.running.is_some())
            && !before.halted;
        let active = ran || self.axis_models.iter().any(|axis_model| !axis_model.queue.is_empty());
        self.rest = if active { 0 } else { (self.rest + 1).min(2) };
        for axis_model in &mut axis_models {
            axis_model.queue.extend(axis_model.fresh.take());
        }
        self.decide_cut(&mut axis_models);
        match decision {
            Decision::Wait => {}
            Decision::Drop => self.armed = None,
            Decision::Unfed => stop.call(Cause::Protocol, 0, guard),
            Decision::Go(mask) => {
                self.armed = None;
                for (axis, axis_model) in
                    axis_models.iter_mut().enumerate().filter(|(axis, _)| mask >> axis & 1 == 1)
                {
                    debug_assert!(axis_model.running.is_none(), "axis {axis} runs");
                    axis_model.load();
                }
            }
        }
        // The decision above was about the start that was armed before. The start that is accepted
        // now is decided about at the next strobe at the earliest.
        if start_ready {
            self.armed = inputs.start;
        }
        for (cause, axis) in &found {
            stop.call(*cause, 1 << axis, guard);
        }
        self.axis_models = axis_models;
        self.time_slots = true;
        let freezes = found.iter().any(|(cause, _)| cause.freezes(guard.limit_freezes));
        // The engine is halted: after a freeze, from the first strobe before which `frozen` was
        // set; for a freezing cause found in a tick, from the strobe that ends this tick; in a
        // ramp, from the first strobe at which the ramp was in force and no axis ran in the tick.
        // At the next strobe the stop is settled. From the strobe after that one a clear is
        // accepted (`clearing`), and takes effect one strobe later.
        Stop {
            ramp: before.fault.is_some() || !found.is_empty(),
            halted: before.frozen || freezes || (before.ramp && !ran),
            settled: before.halted,
            clearing: inputs.clear
                && before.settled
                && !before.clearing
                && !self.reset.ending
                && !busy
                && !self.supervisor.pressed()
                && !self.interlock,
            ..stop
        }
    }

    /// Sets P of every axis to its start value, and removes all queued segments and the words of
    /// segments that are not committed. Positions, discarded steps, pins and debounced switches
    /// stay as they are.
    pub(super) fn empty(&mut self) {
        for axis_model in &mut self.axis_models {
            axis_model.p = self.build.phase.start_value();
            axis_model.queue.clear();
            axis_model.slot = 0;
            axis_model.next_word = 0;
            axis_model.named = None;
        }
    }
}

/// The decision about an armed start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Decision {
    Wait,
    /// The seek of a masked axis has hit: the start is no longer armed.
    Drop,
    /// A masked axis has no segment in its queue: a protocol fault.
    Unfed,
    Go(u8),
}

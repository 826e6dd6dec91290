//! The engine's registers that can be read without visiting every clock, for the host link and the
//! virtual board.

use super::axis_model::AxisModel;
use super::{Engine, bits};
use carrystep_core::engine::{Cause, TIME_SLOT_CLOCKS};

/// The beat of a time slot in which `get_data` is valid.
const GET_BEAT: u32 = 11;

impl Engine {
    /// The stop that was called: its first cause, and the axes that caused it (one bit each).
    pub fn fault(&self) -> Option<(Cause, u8)> {
        self.stop.fault
    }

    /// True if axes have time slots in this tick, which they have in every tick but the first.
    pub fn has_time_slots(&self) -> bool {
        self.time_slots
    }

    /// True if `get_data` is valid in this cycle.
    pub fn answers(&self) -> bool {
        self.time_slot_at(GET_BEAT).is_some()
    }

    /// The number of cycles with valid `get_data` among the `clocks` cycles before this one. All of
    /// these cycles must be later than the first tick.
    pub fn answers_before(&self, clocks: u64) -> u64 {
        let per_tick = u64::from(self.build.timebase.clocks_per_tick());
        let axes = self.axis_models.len() as u64;
        // Valid cycles before cycle `clock`, counted from the beginning of a tick: those of its own
        // tick and those of all ticks before it.
        let before = |clock: u64| {
            let time_slots = (clock % per_tick + u64::from(TIME_SLOT_CLOCKS - 1 - GET_BEAT))
                / u64::from(TIME_SLOT_CLOCKS);
            clock / per_tick * axes + time_slots.min(axes)
        };
        let now = u64::from(self.clock) + clocks.next_multiple_of(per_tick);
        before(now) - before(now - clocks)
    }

    /// The number of ticks until one of the axes has only `kept` segments waiting beside the
    /// running one; 0 if it has no more than that already. Only axes count whose queue does not
    /// reach the end of their move. The result is `None` if no axis needs the host: every axis is
    /// at rest, or has the end of its move in its queue, or a stop has been called. While a start
    /// is armed, waiting moves count as started.
    pub fn ticks_without_host(&self, kept: usize) -> Option<u64> {
        let armed = self.armed.is_some();
        let of_axis_model = |axis_model: &AxisModel| {
            let all = || axis_model.running.iter().chain(&axis_model.queue);
            let begun = armed || axis_model.running.is_some();
            let ended =
                if armed { all().next_back()?.last } else { all().any(|segment| segment.last) };
            if !begun || ended {
                return None;
            }
            let spare = axis_model.queue.len().saturating_sub(kept);
            Some(all().take(spare).map(|segment| u64::from(segment.left) + 1).sum())
        };
        self.axis_models
            .iter()
            .filter_map(of_axis_model)
            .min()
            .filter(|_| self.stop.fault.is_none())
    }

    /// Number of segments in the queue of an axis, beside the running one.
    pub fn waiting(&self, axis: usize) -> usize {
        self.axis_models[axis].queue.len()
    }

    /// The axes that run a segment which is not the last of its move, one bit each.
    pub fn in_a_move(&self) -> u8 {
        bits(&self.axis_models, |axis_model| {
            axis_model.running.is_some_and(|segment| !segment.last)
        })
    }

    /// The axes that wait for their limit, one bit each.
    pub fn homing(&self) -> u8 {
        bits(&self.axis_models, |axis_model| axis_model.homing.waits)
    }

    /// The word that `get_item` selects for an axis: 0 and 1 are the low and the high half of P
    /// (2^-64 step), 2 is the position (steps), 3 the number of discarded steps. The word of an
    /// axis that does not exist is 0.
    pub fn item(&self, axis: u8, item: u8) -> u32 {
        let Some(axis_model) = self.axis_models.get(usize::from(axis)) else { return 0 };
        match item {
            0 => axis_model.p as u32,
            1 => (axis_model.p >> 32) as u32,
            2 => axis_model.shaper.position.cast_unsigned(),
            _ => axis_model.shaper.discarded,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_core::engine::EngineInputs;
    use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};

    #[test]
    fn answers_before_counts_the_cycles_with_valid_get_data() {
        let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let mut engine = Engine::new(&EngineBuild::minimal(&build, 1));
        let mut answers = Vec::new();
        for _ in 0..500 {
            answers.push(u64::from(engine.answers()));
            engine.clock(&EngineInputs::default());
            // The loop begins with the second tick; the first has no time slots.
            for clocks in 0..answers.len() as u64 - 96.min(answers.len() as u64) {
                let counted: u64 = answers.iter().rev().take(clocks as usize).sum();
                assert_eq!(
                    engine.answers_before(clocks),
                    counted,
                    "{clocks} before {}",
                    answers.len()
                );
            }
        }
    }
}

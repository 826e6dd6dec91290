//! What the engine tells whoever carries its host's frames: registers, each at its time.

use super::lane::Lane;
use super::{Engine, bits};
use carrystep_core::engine::{Cause, TURN};

/// The beat of a turn in which `get` is answered.
const GET_BEAT: u32 = 11;

impl Engine {
    /// The stop that was called: the cause, and the axes that it came from.
    pub fn fault(&self) -> Option<(Cause, u8)> {
        self.stop.fault
    }

    /// Turns have begun: all but the first tick has them.
    pub fn has_turns(&self) -> bool {
        self.turns
    }

    /// Whether `get_data` is an answer in this cycle.
    pub fn answers(&self) -> bool {
        self.turn_at(GET_BEAT).is_some()
    }

    /// How many answers there were in the `clocks` cycles before this one; turns must have begun before them.
    pub fn answers_before(&self, clocks: u64) -> u64 {
        let per_tick = u64::from(self.build.timebase.clocks_per_tick());
        let axes = self.lanes.len() as u64;
        // Answers in the clocks before this one, of a tick, and of all ticks before it.
        let before = |clock: u64| {
            let turns = (clock % per_tick + u64::from(TURN - 1 - GET_BEAT)) / u64::from(TURN);
            clock / per_tick * axes + turns.min(axes)
        };
        let now = u64::from(self.clock) + clocks.next_multiple_of(per_tick);
        before(now) - before(now - clocks)
    }

    /// Ticks until some axis has only `kept` segments waiting beside the one that runs, of those axes whose queue does not
    /// reach the end of its move; 0 where one has no more than that already. `None` where no axis needs its host: all rest,
    /// or have the end of their moves, or stop. Where a start is armed, moves that wait count as begun.
    pub fn ticks_without_host(&self, kept: usize) -> Option<u64> {
        let armed = self.armed.is_some();
        let of_lane = |lane: &Lane| {
            let all = || lane.running.iter().chain(&lane.queue);
            let begun = armed || lane.running.is_some();
            let ended = if armed { all().next_back()?.last } else { all().any(|segment| segment.last) };
            if !begun || ended {
                return None;
            }
            let spare = lane.queue.len().saturating_sub(kept);
            Some(all().take(spare).map(|segment| u64::from(segment.left) + 1).sum())
        };
        self.lanes.iter().filter_map(of_lane).min().filter(|_| self.stop.fault.is_none())
    }

    /// Segments that wait for an axis, beside the one that runs.
    pub fn waiting(&self, axis: usize) -> usize {
        self.lanes[axis].queue.len()
    }

    /// The axes that are in the middle of a move: they run a segment that is not its last.
    pub fn in_a_move(&self) -> u8 {
        bits(&self.lanes, |lane| lane.running.is_some_and(|segment| !segment.last))
    }

    /// The axes that wait for their limit, a bit each.
    pub fn homing(&self) -> u8 {
        bits(&self.lanes, |lane| lane.homing.waits)
    }

    /// An item of an axis: 0 1 P, low and high, 2 position, 3 discarded steps; of an axis that there is not, 0.
    pub fn item(&self, axis: u8, item: u8) -> u32 {
        let Some(lane) = self.lanes.get(usize::from(axis)) else { return 0 };
        match item {
            0 => lane.p as u32,
            1 => (lane.p >> 32) as u32,
            2 => lane.shaper.position.cast_unsigned(),
            _ => lane.shaper.discarded,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_core::engine::EngineInputs;
    use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};

    #[test]
    fn answers_are_counted_as_they_come() {
        let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let mut engine = Engine::new(&EngineBuild::minimal(&build, 1));
        let mut answers = Vec::new();
        for _ in 0..500 {
            answers.push(u64::from(engine.answers()));
            engine.clock(&EngineInputs::default());
            // From the second tick on.
            for clocks in 0..answers.len() as u64 - 96.min(answers.len() as u64) {
                let counted: u64 = answers.iter().rev().take(clocks as usize).sum();
                assert_eq!(engine.answers_before(clocks), counted, "{clocks} before {}", answers.len());
            }
        }
    }
}

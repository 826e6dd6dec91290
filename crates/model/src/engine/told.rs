//! What the engine tells whoever carries its host's frames: registers, each at its time.

use super::Engine;
use carrystep_spec::engine::TURN;

/// The beat of a turn in which `get` is answered.
const GET_BEAT: u32 = 11;

impl Engine {
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

    /// An axis waits for its limit.
    pub fn waits_for_limits(&self) -> bool {
        self.lanes.iter().any(|lane| lane.homing.waits)
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

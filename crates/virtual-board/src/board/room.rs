//! The free queue space that an axis reports while the link runs ahead of the engine.

use carrystep_core::EngineBuild;
use carrystep_core::engine::{PUT_BEAT, QUEUE, TIME_SLOT_CLOCKS};
use carrystep_model::engine::Motion;

/// A cycle in which an axis reports its free queue space to the link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Reported {
    /// The cycle.
    pub(super) cycle: u64,
    axis: u8,
}

impl Reported {
    /// The last cycle in which this axis reports, among `clocks` cycles from `from` on; `None` if
    /// it does not report in them, or does not exist.
    pub(super) fn among(build: &EngineBuild, axis: u8, from: u64, clocks: u64) -> Option<Self> {
        let per_tick = u64::from(build.timebase.clocks_per_tick());
        let beat = u64::from(u32::from(axis) * TIME_SLOT_CLOCKS + PUT_BEAT);
        let last = from + clocks - 1;
        let cycle = last.checked_sub((last + per_tick - beat % per_tick) % per_tick)?;
        // There are no time slots in the first tick.
        let reports = usize::from(axis) < build.axes() && cycle >= from.max(per_tick);
        reports.then_some(Self { cycle, axis })
    }

    /// The room that the axis reports, in segments, if its queue is as it is now.
    pub(super) fn room(self, motion: &Motion) -> u8 {
        (QUEUE - motion.waiting(usize::from(self.axis))) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_core::{AXES, Build, PinTiming, StartPhase, Timebase};

    /// One cycle after the other, from the end on.
    #[test]
    fn last_report_is_found_among_any_cycles() {
        let timebase = Timebase::new(80_000_000, 1000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let build = EngineBuild::minimal(&build, 1);
        let per_tick = 80;
        for axis in 0..8 {
            let beat = u64::from(u32::from(axis) * TIME_SLOT_CLOCKS + PUT_BEAT);
            let reports = |cycle: &u64| {
                usize::from(axis) < AXES && *cycle >= per_tick && cycle % per_tick == beat
            };
            for from in 0..3 * per_tick {
                for clocks in 1..=2 * per_tick + 1 {
                    let last = (from..from + clocks).rev().find(reports);
                    let found = Reported::among(&build, axis, from, clocks);
                    assert_eq!(found.map(|found| found.cycle), last, "{axis}, {from}, {clocks}");
                }
            }
        }
    }
}

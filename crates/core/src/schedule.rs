//! How many clocks a tick of an engine needs at least.

/// Clocks in a time slot. Each axis has one time slot in each tick.
pub const TIME_SLOT_CLOCKS: u32 = 13;

/// Clocks of the time slots of this number of axes, plus the two clocks that close the
/// tick: in them the engine counts the tick.
pub const fn clocks_of_time_slots(axes: usize) -> u32 {
    axes as u32 * TIME_SLOT_CLOCKS + 2
}

/// Fewest clocks of a tick: enough for the time slots of all axes and for the events of all phases.
pub const fn least_clocks(axes: usize, phases: u32) -> u32 {
    let (time_slots, events) = (clocks_of_time_slots(axes), phases * MIN_CLOCKS_PER_PHASE);
    if time_slots > events { time_slots } else { events }
}

/// Fewest clocks of a phase. In one clock its events are read; in the others new events are
/// written.
pub const MIN_CLOCKS_PER_PHASE: u32 = 2;

//! How many clocks a tick of an engine needs at least.

/// Clocks in a time slot. Each axis has one time slot in each tick, which it shares with one axis of
/// each other adder.
pub const TIME_SLOT_CLOCKS: u32 = 13;

/// Clocks of the time slots of this number of axes, plus the two clocks that close the
/// tick: in them the engine counts the tick.
pub const fn clocks_of_time_slots(axes: usize) -> u32 {
    axes as u32 * TIME_SLOT_CLOCKS + 2
}

/// Number of time slots of a tick in an engine of so many axes with this number of adders, which is
/// at least 1. Axis i is computed in time slot i / adders, by the adder i % adders.
pub const fn time_slots(axes: usize, adders: usize) -> usize {
    axes.div_ceil(adders)
}

/// Clocks of the time slots of an engine of so many axes with this number of adders, plus those that
/// close the tick: two, and with several adders one more, because the causes of stops of one time
/// slot are then told in two clocks.
pub const fn clocks_of_adders(axes: usize, adders: usize) -> u32 {
    clocks_of_time_slots(time_slots(axes, adders)) + (adders > 1) as u32
}

/// Fewest clocks of a tick of an engine with this number of adders; as [`least_clocks`].
pub const fn least_clocks_of_adders(axes: usize, adders: usize, phases: u32) -> u32 {
    let (time_slots, events) = (clocks_of_adders(axes, adders), phases * MIN_CLOCKS_PER_PHASE);
    if time_slots > events { time_slots } else { events }
}

/// Fewest clocks of a tick: enough for the time slots of all axes and for the events of all phases.
pub const fn least_clocks(axes: usize, phases: u32) -> u32 {
    let (time_slots, events) = (clocks_of_time_slots(axes), phases * MIN_CLOCKS_PER_PHASE);
    if time_slots > events { time_slots } else { events }
}

/// Fewest clocks of a phase. In one clock its events are read; in the others new events are
/// written.
pub const MIN_CLOCKS_PER_PHASE: u32 = 2;

//! How many clocks a tick of an engine needs at least.

/// Clocks in a turn, the time slot of one axis in each tick.
pub const TURN: u32 = 13;

/// Clocks of the turns of this number of axes, plus the clock that closes the tick.
pub const fn clocks_of_turns(axes: usize) -> u32 {
    axes as u32 * TURN + 1
}

/// Fewest clocks of a tick: enough for the turns of all axes and for the events of all phases.
pub const fn least_clocks(axes: usize, phases: u32) -> u32 {
    let (turns, events) = (clocks_of_turns(axes), phases * MIN_CLOCKS_PER_PHASE);
    if turns > events { turns } else { events }
}

/// Fewest clocks of a phase. In one clock its events are read; in the others new events are
/// written.
pub const MIN_CLOCKS_PER_PHASE: u32 = 2;

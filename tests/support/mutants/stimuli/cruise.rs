//! The times and the moves that the stimuli have in common.

use carrystep_core::{AXES, Command, Program, Segment};

/// Clocks of a tick of the mutants' build.
pub(super) const TICK: u64 = 96;
/// Clocks between two samples of a limit.
pub(super) const ROUND: u64 = 64 * TICK;
/// A clock in which the drivers are warm and all axes cruise.
pub(super) const THEN: u64 = 64_000;

/// All axes move at these speeds.
pub(super) fn cruise(ticks: u32, v: [i64; AXES]) -> Program {
    let segment = |v| Segment { ticks, v, a: 0, j: 0, last: true };
    let segments = (0..).zip(v).map(|(axis, v)| Command::Segment { axis, segment: segment(v) });
    segments.chain([Command::Start { mask: 0x3f }]).collect()
}

/// A speed for every axis, the odd ones backward.
pub(super) fn both_ways(v: i64) -> [i64; AXES] {
    std::array::from_fn(|axis| if axis % 2 == 0 { v } else { -v })
}

/// A clear, and a short move after it.
pub(super) fn again(wait: u32) -> Program {
    [vec![Command::Wait { clocks: wait }, Command::Clear], cruise(40, both_ways(-(1 << 59)))]
        .concat()
}

//! Computes the clock of a pin edge exactly, from the integers of a plan.
//!
//! These functions repeat the arithmetic of the gateware (docs/clock-by-clock.md) in closed form;
//! they may change only together with it.

use carrystep_core::fixed::ONE_STEP;
use carrystep_core::{Segment, Timebase};

/// The number of pairs among `n` things, n(n-1)/2; `n` is below 2^32.
pub(crate) fn pairs(n: u64) -> i64 {
    (n * n.saturating_sub(1) / 2).cast_signed()
}

/// The number of triples among `n` things, n(n-1)(n-2)/6; `n` is below 2^32. One of the two factors
/// is a multiple of 3, so that no 128-bit division is needed.
pub(crate) fn triples(n: u64) -> i128 {
    let (pairs, third) = (pairs(n), n.saturating_sub(2).cast_signed());
    let (pairs, third) = if third % 3 == 0 { (pairs, third / 3) } else { (pairs / 3, third) };
    i128::from(pairs) * i128::from(third)
}

/// Units travelled in the first `n` ticks of a segment, at most all of them.
pub fn travel(segment: &Segment, n: u64) -> i128 {
    let (v, a, j) = (i128::from(segment.v), i128::from(segment.a), i128::from(segment.j));
    // The product is skipped where J is 0, because for a long segment it may not fit into an i128.
    let by_jerk = if j == 0 { 0 } else { triples(n) * j };
    i128::from(n) * v + i128::from(pairs(n)) * a + by_jerk
}

/// V in tick `k` of a segment, counted from 0, in units per tick.
pub(crate) fn speed(segment: &Segment, k: u64) -> i128 {
    let (v, a, j) = (i128::from(segment.v), i128::from(segment.a), i128::from(segment.j));
    v + i128::from(k) * a + i128::from(pairs(k)) * j
}

/// The first tick in which V is not 0, counted from 0. A segment that starts at V = 0 moves from
/// its second tick on if A is not 0, and from its third tick on if only J is not 0.
pub(crate) fn first_motion(segments: &[Segment]) -> u64 {
    let mut before = 0;
    for segment in segments {
        let first = [segment.v, segment.a, segment.j].iter().position(|&r| r != 0);
        if let Some(k) = first.and_then(|k| u32::try_from(k).ok()).filter(|&k| k < segment.ticks) {
            return before + u64::from(k);
        }
        before += u64::from(segment.ticks);
    }
    before
}

/// Clocks from the start of the segments to the rising edge of pulse `k` (counted from 1), without
/// the latency of the build.
///
/// The segments must travel in one direction only; `start` is the value of P before them. Returns
/// `None` if the segments have fewer than `k` pulses.
pub(crate) fn edge(
    segments: &[Segment],
    start: u64,
    backward: bool,
    k: u64,
    timebase: &Timebase,
) -> Option<i128> {
    let target = i128::from(k) * ONE_STEP;
    let passed = |p: i128| if backward { p < ONE_STEP - target } else { p >= target };
    let mut p = i128::from(start);
    let mut before = 0_u64;
    for segment in segments {
        let ticks = u64::from(segment.ticks);
        let end = p + travel(segment, ticks);
        if passed(end) {
            // Bisects for the least n for which the edge is at or before the end of tick n.
            let (mut low, mut high) = (0, ticks);
            while high - low > 1 {
                let middle = low + (high - low) / 2;
                *(if passed(p + travel(segment, middle)) { &mut high } else { &mut low }) = middle;
            }
            let old = p + travel(segment, low);
            let q = phase(old, speed(segment, low), timebase.phase_bits());
            let clocks = i128::from(timebase.clocks_per_tick());
            return Some(
                i128::from(before + low) * clocks + q * i128::from(timebase.clocks_per_phase()),
            );
        }
        p = end;
        before += ticks;
    }
    None
}

/// The phase that the gateware's bisection finds: it uses the top 32 bits of P and V, and halves V
/// once for each phase bit.
fn phase(p: i128, v: i128, bits: u32) -> i128 {
    let mut p = (p >> 32) & 0xffff_ffff;
    let v = v >> 32;
    let mut q = 0;
    for k in 1..=bits {
        let t = p + (v >> k);
        if (0..1 << 32).contains(&t) {
            p = t;
            q |= 1 << (bits - k);
        }
    }
    q
}

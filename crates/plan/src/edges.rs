//! Computes the clock of a pin edge exactly, from the integers of a plan.
//!
//! These functions repeat the arithmetic of the gateware (docs/clock-by-clock.md) in closed form;
//! they may change only together with it.

use carrystep_core::fixed::ONE_STEP;
use carrystep_core::{Segment, Timebase};

/// The product of two numbers of 64 bits. It always fits, so that it takes one multiplication of the
/// processor, where one of two i128 takes several and a test for overflow.
pub(crate) const fn product(a: i64, b: i64) -> i128 {
    a as i128 * b as i128
}

/// The number of pairs among `n` things, n(n-1)/2; `n` is at most 2^32.
pub(crate) fn pairs(n: u64) -> i64 {
    (n * n.saturating_sub(1) / 2).cast_signed()
}

/// The number of triples among `n` things, n(n-1)(n-2)/6; `n` is at most 2^32. One of the two
/// factors is a multiple of 3, so that no 128-bit division is needed.
pub(crate) fn triples(n: u64) -> i128 {
    let (pairs, third) = (pairs(n).cast_unsigned(), n.saturating_sub(2));
    let (pairs, third) = if third % 3 == 0 { (pairs, third / 3) } else { (pairs / 3, third) };
    product(pairs.cast_signed(), third.cast_signed())
}

/// Units travelled in the first `n` ticks of a segment, at most all of them.
pub fn travel(segment: &Segment, n: u64) -> i128 {
    let &Segment { v, a, j, .. } = segment;
    // The product is skipped where J is 0, because for a long segment it may not fit into an i128.
    let by_jerk = if j == 0 { 0 } else { by_triples(n, j) };
    product(n.cast_signed(), v) + product(pairs(n), a) + by_jerk
}

/// The distance that J adds in `n` ticks, units.
fn by_triples(n: u64, j: i64) -> i128 {
    let triples = triples(n);
    i64::try_from(triples).map_or_else(|_| triples * i128::from(j), |few| product(few, j))
}

/// V in tick `k` of a segment, counted from 0, in units per tick.
pub(crate) fn speed(segment: &Segment, k: u64) -> i128 {
    let &Segment { v, a, j, .. } = segment;
    i128::from(v) + product(k.cast_signed(), a) + product(pairs(k), j)
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
/// the latency of the build. `guess` is a tick near the edge, counted from 0; it only decides how
/// soon the edge is found.
///
/// The segments must travel in one direction only; `start` is the value of P before them. Returns
/// `None` if the segments have fewer than `k` pulses.
pub(crate) fn edge(
    segments: &[Segment],
    start: u64,
    backward: bool,
    (k, guess): (u64, u64),
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
            let low =
                last_not(ticks, guess.saturating_sub(before), |n| passed(p + travel(segment, n)));
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

/// The greatest number below `most` for which `holds` is false. It is false at 0, true at `most`,
/// and stays true from where it becomes so. The search goes away from `guess` in steps that become
/// twice as long each time, and bisects what they enclose.
fn last_not(most: u64, guess: u64, holds: impl Fn(u64) -> bool) -> u64 {
    let (mut low, mut high) = (0, most);
    let (mut next, mut step) = (guess, 1);
    while high - low > 1 {
        let middle = if low < next && next < high { next } else { low + (high - low) / 2 };
        if holds(middle) {
            high = middle;
            next = middle.saturating_sub(step);
        } else {
            low = middle;
            next = middle + step;
        }
        step *= 2;
    }
    low
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_guess_finds_the_same_number() {
        for most in [1, 2, 3, 1000, u64::from(u32::MAX)] {
            for last in [0, 1, 2, 499, 998, 999, u64::from(u32::MAX) - 1] {
                let last = last.min(most - 1);
                for guess in [0, 1, 2, 498, 499, 500, 998, 999, 1000, u64::MAX] {
                    assert_eq!(last_not(most, guess, |n| n > last), last, "{most} {guess}");
                }
            }
        }
    }
}

//! Computes the clock of a pin edge exactly, from the integers of a plan.
//!
//! These functions repeat the arithmetic of the gateware (docs/clock-by-clock.md) in closed form;
//! they may change only together with it.

use carrystep_core::fixed::ONE_STEP;
use carrystep_core::{Segment, Timebase};

/// The product of two numbers of 64 bits. It always fits, and takes one multiplication of the
/// processor; a product of two i128 takes several, and a test for overflow.
#[inline]
pub(crate) const fn product(a: i64, b: i64) -> i128 {
    a as i128 * b as i128
}

/// The number of pairs among `n` things, n(n-1)/2; `n` is at most 2^32.
#[inline]
pub(crate) fn pairs(n: u64) -> i64 {
    (n * n.saturating_sub(1) / 2).cast_signed()
}

/// The number of triples among `n` things, n(n-1)(n-2)/6; `n` is at most 2^32. One of the two
/// factors is a multiple of 3, so that no 128-bit division is needed.
#[inline]
pub(crate) fn triples(n: u64) -> i128 {
    let (pairs, third) = (pairs(n).cast_unsigned(), n.saturating_sub(2));
    let (pairs, third) = if third % 3 == 0 { (pairs, third / 3) } else { (pairs / 3, third) };
    product(pairs.cast_signed(), third.cast_signed())
}

/// Units travelled in the first `n` ticks of a segment, at most all of them.
#[inline]
pub fn travel(segment: &Segment, n: u64) -> i128 {
    let &Segment { v, a, j, .. } = segment;
    // The product is skipped where J is 0, because for a long segment it may not fit into an i128.
    let by_jerk = if j == 0 { 0 } else { by_triples(n, j) };
    product(n.cast_signed(), v) + product(pairs(n), a) + by_jerk
}

/// The distance that J adds in `n` ticks, units.
#[inline]
pub(crate) fn by_triples(n: u64, j: i64) -> i128 {
    let triples = triples(n);
    i64::try_from(triples).map_or_else(|_| triples * i128::from(j), |few| product(few, j))
}

/// V in tick `k` of a segment, counted from 0, in units per tick.
#[inline]
pub(crate) fn speed(segment: &Segment, k: u64) -> i128 {
    let &Segment { v, a, j, .. } = segment;
    let by_jerk = if j == 0 { 0 } else { product(pairs(k), j) };
    i128::from(v) + product(k.cast_signed(), a) + by_jerk
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

/// The pulses of one axis in one move, as the gateware makes them of segments that travel in one
/// direction only.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edges<'a> {
    pub segments: &'a [Segment],
    /// The value of P before the segments.
    pub start: u64,
    pub backward: bool,
    pub timebase: &'a Timebase,
}

impl Edges<'_> {
    /// Clocks from the start of the segments to the rising edge of the first pulse, without the
    /// latency of the build. `guess` is a tick near the edge, counted from 0; it only decides how
    /// soon the edge is found. Returns `None` if the segments have no pulse.
    pub fn first(&self, guess: u64) -> Option<i128> {
        let (mut p, mut before) = (i128::from(self.start), 0);
        let target = self.target(1);
        for segment in self.segments {
            let end = p + travel(segment, segment.ticks.into());
            if self.passed(target, end) {
                return Some(self.edge(target, segment, (p, before), guess));
            }
            p = end;
            before += u64::from(segment.ticks);
        }
        None
    }

    /// The same for the last of `count` pulses, from the end of the segments, where P has travelled
    /// as many steps. The exact check, which comes later, refuses segments that end elsewhere.
    pub fn last(&self, count: u64, guess: u64) -> Option<i128> {
        let steps = i128::from(count) * ONE_STEP;
        let mut p = i128::from(self.start) + if self.backward { -steps } else { steps };
        let mut before = self.segments.iter().map(|segment| u64::from(segment.ticks)).sum();
        let target = self.target(count);
        for segment in self.segments.iter().rev() {
            p -= travel(segment, segment.ticks.into());
            before -= u64::from(segment.ticks);
            if !self.passed(target, p) {
                return Some(self.edge(target, segment, (p, before), guess));
            }
        }
        None
    }

    /// The position at which pulse `k` is due, 2^-64 step. Forward, P reaches it; backward, P falls
    /// below it.
    fn target(&self, k: u64) -> i128 {
        let steps = i128::from(k) * ONE_STEP;
        if self.backward { ONE_STEP - steps } else { steps }
    }

    /// Whether the pulse with this target is given when P is `p`.
    fn passed(&self, target: i128, p: i128) -> bool {
        if self.backward { p < target } else { p >= target }
    }

    /// The clocks of the pulse with this target, whose edge is in this segment. Before the segment,
    /// P is `p` and `before` ticks have passed. The search goes away from `guess` in steps that
    /// become twice as long each time, and bisects what they enclose.
    fn edge(&self, target: i128, segment: &Segment, (p, before): (i128, u64), guess: u64) -> i128 {
        // The edge is after `low` ticks, where P is `old`, and not after the end of tick `high`.
        let (mut low, mut old, mut high) = (0, p, u64::from(segment.ticks));
        let (mut next, mut step) = (guess.saturating_sub(before), 1);
        while high - low > 1 {
            let middle = if low < next && next < high { next } else { low + (high - low) / 2 };
            let there = p + travel(segment, middle);
            if self.passed(target, there) {
                high = middle;
                next = middle.saturating_sub(step);
            } else {
                (low, old) = (middle, there);
                next = middle.saturating_add(step);
            }
            step = step.saturating_mul(2);
        }
        let q = phase(old, speed(segment, low), self.timebase.phase_bits());
        i128::from(before + low) * i128::from(self.timebase.clocks_per_tick())
            + i128::from(q * self.timebase.clocks_per_phase())
    }
}

/// The phase that the gateware's bisection finds: it uses the top 32 bits of P and V, and halves V
/// once for each phase bit.
fn phase(p: i128, v: i128, bits: u32) -> u32 {
    // A plan whose V does not fit is refused later.
    let v = i64::try_from(v >> 32).unwrap_or(i64::MAX);
    let (mut p, mut part, mut q) = (i64::from((p >> 32) as u32), v, 0);
    for _ in 0..bits {
        (part, q) = (part >> 1, q << 1);
        let t = p + part;
        if (0..1 << 32).contains(&t) {
            (p, q) = (t, q | 1);
        }
    }
    q
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_guess_finds_the_same_edges() {
        let timebase = Timebase::new(80_000_000, 1000, 16).unwrap();
        let up = Segment { ticks: 1000, v: 1 << 40, a: 1 << 50, j: 1 << 30, last: false };
        let [v, a] = [speed(&up, 1000), i128::from(up.a) + 1000 * i128::from(up.j)]
            .map(|x| i64::try_from(x).unwrap());
        let down = Segment { v, a: -a, j: 0, ..up };
        let segments = [up, down];
        let edges =
            Edges { segments: &segments, start: 1 << 63, backward: false, timebase: &timebase };
        let whole = segments.iter().map(|one| travel(one, 1000)).sum::<i128>();
        let count = u64::try_from(whole / ONE_STEP).unwrap();
        let exact = Edges { start: (whole % ONE_STEP) as u64, ..edges };
        let [first, last] = [edges.first(0), exact.last(count, 0)];
        assert!(first.is_some() && last.is_some() && first < last);
        for guess in (0..2100).chain([u64::MAX]) {
            assert_eq!([edges.first(guess), exact.last(count, guess)], [first, last], "{guess}");
        }
    }
}

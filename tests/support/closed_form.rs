//! The arithmetic contract as closed formulas in exact integers. They are independent of every
//! tick-by-tick implementation and serve as its reference.

use carrystep_core::Segment;
use num_bigint::BigInt;

/// Exact position of a segment after `n` ticks relative to its start, in 2^-64 step: n V + n(n-1)/2
/// A + n(n-1)(n-2)/6 J.
pub fn distance(segment: &Segment, n: u32) -> BigInt {
    let n = BigInt::from(n);
    let second = &n * (&n - 1) / 2;
    let third = &n * (&n - 1) * (&n - 2) / 6;
    &n * segment.v + second * segment.a + third * segment.j
}

/// Exact speed of a segment before its tick `n` (from 0), in 2^-64 step per tick: V + n A +
/// n(n-1)/2 J.
pub fn speed(segment: &Segment, n: u32) -> BigInt {
    let n = BigInt::from(n);
    segment.v + &n * segment.a + &n * (&n - 1) / 2 * segment.j
}

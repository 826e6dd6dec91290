//! Finds the ticks of a stretch that step, by jumping from one to the next or by adding tick by
//! tick. Guesses in floating point may be wrong; every result is verified in integers before it is
//! used.

use crate::parts::cubic::{Cubic, first};
use crate::parts::phase::bisect_all;

/// If a step is expected in this many ticks or fewer, the stretch is added tick by tick: there an
/// addition per tick costs less than a root per edge.
const DENSE: u32 = 6;

/// Number of steps whose roots are computed together. The roots do not depend on each other, so the
/// processor can overlap them.
pub(super) const BATCH: usize = 32;

/// Number of steps that one vector operation handles; a short batch is rounded up to a multiple of
/// it.
const LANES: usize = 8;

/// Number of Newton refinements of a guess if the jerk is not 0.
const REFINEMENTS: usize = 3;

/// One step in units of 2^-64 step.
const STEP: f64 = 18_446_744_073_709_551_616.0;

/// The inverse of 3 modulo 2^64. A multiple of 3 is divided by 3 by multiplying with it.
const INVERSE_OF_3: i64 = 0xaaaa_aaaa_aaaa_aaab_u64.cast_signed();

/// Ticks that step, with P and V before each of them.
#[derive(Debug, Clone, Copy)]
struct Batch {
    ticks: [u32; BATCH],
    p: [u64; BATCH],
    v: [i64; BATCH],
    phases: [u32; BATCH],
}

impl Batch {
    const EMPTY: Self =
        Self { ticks: [0; BATCH], p: [0; BATCH], v: [0; BATCH], phases: [0; BATCH] };

    /// Computes the phases of the first `count` ticks. If `backward`, P and V are mirrored.
    fn bisect(&mut self, count: usize, backward: bool, phase_bits: u32) {
        let (p, v) = (self.p.as_chunks::<LANES>().0, self.v.as_chunks::<LANES>().0);
        let phases = self.phases.as_chunks_mut::<LANES>().0;
        for ((p, v), phases) in p.iter().zip(v).zip(phases).take(count.div_ceil(LANES)) {
            *phases = match backward {
                false => bisect_all(p, v, phase_bits),
                true => bisect_all(&p.map(|p| !p), &v.map(i64::wrapping_neg), phase_bits),
            };
        }
    }
}

/// Ticks over which V keeps its sign and V and A stay in range, as seen in the direction of travel.
///
/// A backward stretch is mirrored in ones' complement: `p - x` borrows exactly where `!p + x`
/// carries.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    p: u64,
    cubic: Cubic,
    ticks: u32,
    backward: bool,
}

impl Stretch {
    /// The stretch of `ticks` ticks. The caller guarantees that V keeps its sign and the cubic
    /// stays in range.
    pub const fn new(p: u64, cubic: Cubic, ticks: u32) -> Self {
        let backward = cubic.v < 0;
        let (p, cubic) = if backward { (!p, cubic.mirrored()) } else { (p, cubic) };
        Self { p, cubic, ticks, backward }
    }

    /// Calls `found` with the ticks that step (counted from 0) and the phase of each, in order of
    /// time, up to [`BATCH`] at a time.
    pub fn each(self, phase_bits: u32, mut found: impl FnMut(&[u32], &[u32])) {
        let mut found = |batch: &mut Batch, count: usize| {
            batch.bisect(count, self.backward, phase_bits);
            found(&batch.ticks[..count], &batch.phases[..count]);
        };
        let steps = self.steps_before(self.ticks);
        match self.cubic {
            _ if self.ticks / DENSE < steps => self.tick(&mut found),
            Cubic { a: 0, j: 0, .. } => self.jump::<1>(steps, &mut found),
            Cubic { j: 0, .. } => self.jump::<2>(steps, &mut found),
            _ => self.jump::<3>(steps, &mut found),
        }
    }

    /// Number of steps before tick `n`.
    fn steps_before(&self, n: u32) -> u32 {
        (i128::from(self.p).wrapping_add(self.cubic.distance(n)) >> 64) as u32
    }

    /// Visits every tick.
    fn tick(&self, found: &mut impl FnMut(&mut Batch, usize)) {
        let (mut p, Cubic { mut v, mut a, j }) = (self.p, self.cubic);
        let (mut batch, mut count) = (Batch::EMPTY, 0);
        for tick in 0..self.ticks {
            // Branch-free: the entry of a tick without a step is overwritten by the next tick.
            (batch.ticks[count], batch.p[count], batch.v[count]) = (tick, p, v);
            let (next, carry) = p.overflowing_add(v.cast_unsigned());
            count += usize::from(carry);
            if count == BATCH {
                found(&mut batch, count);
                count = 0;
            }
            (p, v, a) = (next, v.wrapping_add(a), a.wrapping_add(j));
        }
        found(&mut batch, count);
    }

    /// Jumps from step to step on a polynomial of this degree. Each batch begins where the previous
    /// one ended.
    fn jump<const DEGREE: u32>(mut self, steps: u32, found: &mut impl FnMut(&mut Batch, usize)) {
        let (mut left, mut done) = (steps as usize, 0);
        let mut batch = Batch::EMPTY;
        while left > 0 {
            let count = left.min(BATCH);
            self.guess::<DEGREE>(&mut batch, count);
            if !self.is_right(&batch, count) {
                batch.ticks = self.search(count);
                self.fill::<DEGREE>(&mut batch, count);
            }
            let last = count - 1;
            let ticks = batch.ticks[last] + 1;
            self.p = batch.p[last].wrapping_add(batch.v[last].cast_unsigned());
            self.cubic = self.cubic.after(ticks);
            self.ticks -= ticks;
            batch.ticks.iter_mut().for_each(|tick| *tick = tick.wrapping_add(done));
            done += ticks;
            left -= count;
            found(&mut batch, count);
        }
    }

    /// True if these are the first `count` ticks that step: each of them steps, they are in
    /// ascending order, and exactly `count - 1` steps precede the last one, so none is missing.
    fn is_right(&self, batch: &Batch, count: usize) -> bool {
        let steps = |i: usize| batch.p[i].overflowing_add(batch.v[i].cast_unsigned()).1;
        let last = batch.ticks[count - 1];
        last < self.ticks
            && self.steps_before(last) as usize == count - 1
            && (0..count).fold(true, |all, i| all & steps(i))
            && (1..count).fold(true, |all, i| all & (batch.ticks[i - 1] < batch.ticks[i]))
    }

    /// Fills in P and V before the first `count` ticks of a batch.
    fn fill<const DEGREE: u32>(&self, batch: &mut Batch, count: usize) {
        let Cubic { v, a, j } = self.cubic;
        let third = j.wrapping_mul(INVERSE_OF_3);
        let lanes = count.next_multiple_of(LANES);
        for ((&n, p), speed) in batch.ticks[..lanes].iter().zip(&mut batch.p).zip(&mut batch.v) {
            let n = i64::from(n);
            // P wraps once per step.
            let mut distance = v.wrapping_mul(n);
            *speed = v;
            if DEGREE > 1 {
                let pairs = n.wrapping_mul(n.wrapping_sub(1)) / 2;
                distance = distance.wrapping_add(a.wrapping_mul(pairs));
                *speed = speed.wrapping_add(a.wrapping_mul(n));
                if DEGREE > 2 {
                    let triples_by_3 = pairs.wrapping_mul(n.wrapping_sub(2));
                    distance = distance.wrapping_add(third.wrapping_mul(triples_by_3));
                    *speed = speed.wrapping_add(j.wrapping_mul(pairs));
                }
            }
            *p = self.p.wrapping_add(distance.cast_unsigned());
        }
    }

    /// Finds the first `count` ticks that step by bisection in integers, without a guess.
    #[cold]
    fn search(&self, count: usize) -> [u32; BATCH] {
        let mut ticks = [0; BATCH];
        let mut from = 0;
        for (step, tick) in (1..).zip(&mut ticks[..count]) {
            *tick = first(from, self.ticks.saturating_sub(1), |n| self.steps_before(n + 1) >= step);
            from = *tick + 1;
        }
        ticks
    }

    /// Guesses the ticks of the first `count` steps: the roots n of n V + n (n - 1) / 2 A = d,
    /// refined by Newton's method if the jerk is not 0.
    fn guess<const DEGREE: u32>(&self, batch: &mut Batch, count: usize) {
        let Cubic { v, a, j } = self.cubic;
        let (v, a, j) = (v as f64 / STEP, a as f64 / STEP, j as f64 / STEP);
        let begin = self.p as f64 / STEP;
        let most = f64::from(self.ticks);
        let b = v - a / 2.0;
        // The coefficients of powers of n instead of binomials.
        let (c1, c2, c3) = (b + j / 3.0, (a - j) / 2.0, j / 6.0);
        let period = 1.0 / v;
        for (chunk, ticks) in batch
            .ticks
            .as_chunks_mut::<LANES>()
            .0
            .iter_mut()
            .enumerate()
            .take(count.div_ceil(LANES))
        {
            let distance = |i: usize| (chunk * LANES + i + 1) as f64 - begin;
            let mut roots = [0.0; LANES];
            for (i, n) in roots.iter_mut().enumerate() {
                let d = distance(i);
                let square = b * b + 2.0 * a * d;
                *n = match DEGREE {
                    1 => d * period,
                    // `max` would be slower, because it also handles NaN.
                    _ => 2.0 * d / (b + if square > 0.0 { square } else { 0.0 }.sqrt()),
                };
            }
            for _ in 0..if DEGREE > 2 { REFINEMENTS } else { 0 } {
                for (i, n) in roots.iter_mut().enumerate() {
                    let near = if *n < most { *n } else { most };
                    let miss = ((c3 * near + c2) * near + c1) * near - distance(i);
                    let slope = (3.0 * c3 * near + 2.0 * c2) * near + c1;
                    *n = near - miss / slope;
                }
            }
            for (tick, root) in ticks.iter_mut().zip(roots) {
                *tick = root as u32;
            }
        }
        self.fill::<DEGREE>(batch, count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// About ten ticks per step, with a slowly changing speed.
    fn stretch() -> Stretch {
        Stretch::new(1 << 63, Cubic { v: i64::MAX / 5, a: 1 << 40, j: -(1 << 20) }, 5000)
    }

    fn guessed<const DEGREE: u32>(stretch: Stretch, count: usize) -> Batch {
        let mut batch = Batch::EMPTY;
        stretch.guess::<DEGREE>(&mut batch, count);
        batch
    }

    #[test]
    fn guessed_ticks_equal_searched_ticks() {
        let stretch = stretch();
        let batch = guessed::<3>(stretch, BATCH);
        assert_eq!(batch.ticks, stretch.search(BATCH));
        assert!(stretch.is_right(&batch, BATCH));
    }

    /// Polynomials without jerk, or without acceleration, give the same ticks at their own degree
    /// and at degree 3.
    #[test]
    fn lower_degree_finds_the_same_ticks() {
        let straight = Stretch { cubic: Cubic { a: 0, j: 0, ..stretch().cubic }, ..stretch() };
        let square = Stretch { cubic: Cubic { j: 0, ..stretch().cubic }, ..stretch() };
        for count in [1, 7, 8, 9, BATCH] {
            let all = |batch: Batch| {
                (
                    batch.ticks[..count].to_vec(),
                    batch.p[..count].to_vec(),
                    batch.v[..count].to_vec(),
                )
            };
            assert_eq!(all(guessed::<1>(straight, count)), all(guessed::<3>(straight, count)));
            assert_eq!(all(guessed::<2>(square, count)), all(guessed::<3>(square, count)));
        }
    }

    /// `is_right` must reject every batch that is not exactly the first steps in order, because
    /// rounding in floating point may produce any of them.
    #[test]
    fn wrong_guesses_are_rejected() {
        let stretch = stretch();
        let right = stretch.search(BATCH);
        let believed = |change: fn(&mut [u32; BATCH]), count| {
            let mut batch = Batch { ticks: right, ..Batch::EMPTY };
            change(&mut batch.ticks);
            stretch.fill::<3>(&mut batch, BATCH);
            stretch.is_right(&batch, count)
        };
        assert!(believed(|_| (), BATCH) && believed(|_| (), BATCH - 1));
        assert!(!believed(|ticks| ticks[3] += 1, BATCH), "a tick that does not step");
        assert!(!believed(|ticks| ticks.swap(3, 4), BATCH), "out of order");
        assert!(!believed(|ticks| ticks[4] = ticks[3], BATCH), "one of them twice");
        assert!(!believed(|ticks| ticks.rotate_left(1), BATCH - 1), "one is left out");
        assert!(!believed(|ticks| *ticks.last_mut().unwrap() = u32::MAX, BATCH), "behind the end");
    }
}

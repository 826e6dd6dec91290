//! The ticks of a stretch that step: found by jumping from one to the next, or by ticking.

use super::cubic::{Cubic, first};
use crate::parts::phase::bisect_all;

/// A stretch is ticked where a step is expected in every so many ticks or fewer: there an addition a
/// tick costs less than a root an edge.
const DENSE: u32 = 6;

/// Steps that are searched together: their roots do not wait for each other.
pub(super) const BATCH: usize = 32;

/// As many of them are worked out at once, so that a short batch costs less.
const LANES: usize = 8;

/// Refinements of a guess where there is jerk.
const REFINEMENTS: usize = 3;

/// One step in units of 2^-64 step.
const STEP: f64 = 18_446_744_073_709_551_616.0;

/// Of 3, modulo 2^64: what 3 divides is divided by multiplying.
const INVERSE_OF_3: i64 = 0xaaaa_aaaa_aaaa_aaab_u64.cast_signed();

/// Ticks that step, with P and V before them.
#[derive(Debug, Clone, Copy)]
struct Batch {
    ticks: [u32; BATCH],
    p: [u64; BATCH],
    v: [i64; BATCH],
    phases: [u32; BATCH],
}

impl Batch {
    const EMPTY: Self = Self { ticks: [0; BATCH], p: [0; BATCH], v: [0; BATCH], phases: [0; BATCH] };

    /// The phases of the first `count`, P and V being mirrored where they are `backward`.
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

/// Ticks over which V keeps its sign and which stay in range, seen in the direction of travel.
///
/// Backward is the mirror image in ones' complement: `p - x` borrows exactly where `!p + x` carries.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    p: u64,
    cubic: Cubic,
    ticks: u32,
    backward: bool,
}

impl Stretch {
    /// `cubic` keeps the sign of its V over these ticks, and stays in range.
    pub const fn new(p: u64, cubic: Cubic, ticks: u32) -> Self {
        let backward = cubic.v < 0;
        let (p, cubic) = if backward { (!p, cubic.mirrored()) } else { (p, cubic) };
        Self { p, cubic, ticks, backward }
    }

    /// Hands over the ticks that step, counted from 0, with the phase of each: in order, a batch at a time.
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

    /// Steps that are over before tick `n`.
    fn steps_before(&self, n: u32) -> u32 {
        (i128::from(self.p).wrapping_add(self.cubic.distance(n)) >> 64) as u32
    }

    /// Tick by tick.
    fn tick(&self, found: &mut impl FnMut(&mut Batch, usize)) {
        let (mut p, Cubic { mut v, mut a, j }) = (self.p, self.cubic);
        let (mut batch, mut count) = (Batch::EMPTY, 0);
        for tick in 0..self.ticks {
            // No branch: what does not step is overwritten by the next.
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

    /// From step to step, on a course of this degree; each batch begins where the one before has ended.
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

    /// Whether these are the first `count` ticks that step: each of them steps, each comes after the one
    /// before, and just `count - 1` steps are over before the last, so that there is no room for another.
    fn is_right(&self, batch: &Batch, count: usize) -> bool {
        let steps = |i: usize| batch.p[i].overflowing_add(batch.v[i].cast_unsigned()).1;
        let last = batch.ticks[count - 1];
        last < self.ticks
            && self.steps_before(last) as usize == count - 1
            && (0..count).fold(true, |all, i| all & steps(i))
            && (1..count).fold(true, |all, i| all & (batch.ticks[i - 1] < batch.ticks[i]))
    }

    /// P and V before the first `count` ticks of a batch, as if they stepped.
    fn fill<const DEGREE: u32>(&self, batch: &mut Batch, count: usize) {
        let Cubic { v, a, j } = self.cubic;
        let third = j.wrapping_mul(INVERSE_OF_3);
        let lanes = count.next_multiple_of(LANES);
        for ((&n, p), speed) in batch.ticks[..lanes].iter().zip(&mut batch.p).zip(&mut batch.v) {
            let n = i64::from(n);
            // What P wraps by are the steps.
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

    /// The first `count` ticks that step: by halving, and without any guess.
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

    /// Where the first `count` steps are expected: the roots of n V + n (n - 1) / 2 A = d, refined by Newton's
    /// method where there is jerk.
    fn guess<const DEGREE: u32>(&self, batch: &mut Batch, count: usize) {
        let Cubic { v, a, j } = self.cubic;
        let (v, a, j) = (v as f64 / STEP, a as f64 / STEP, j as f64 / STEP);
        let begin = self.p as f64 / STEP;
        let most = f64::from(self.ticks);
        let b = v - a / 2.0;
        // In powers of n instead of binomials.
        let (c1, c2, c3) = (b + j / 3.0, (a - j) / 2.0, j / 6.0);
        let period = 1.0 / v;
        for (chunk, ticks) in batch.ticks.as_chunks_mut::<LANES>().0.iter_mut().enumerate().take(count.div_ceil(LANES))
        {
            let distance = |i: usize| (chunk * LANES + i + 1) as f64 - begin;
            let mut roots = [0.0; LANES];
            for (i, n) in roots.iter_mut().enumerate() {
                let d = distance(i);
                let square = b * b + 2.0 * a * d;
                *n = match DEGREE {
                    1 => d * period,
                    // Not `max`, which cares for what is no number.
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

    /// Ten ticks a step, slowly less.
    fn stretch() -> Stretch {
        Stretch::new(1 << 63, Cubic { v: i64::MAX / 5, a: 1 << 40, j: -(1 << 20) }, 5000)
    }

    fn guessed<const DEGREE: u32>(stretch: Stretch, count: usize) -> Batch {
        let mut batch = Batch::EMPTY;
        stretch.guess::<DEGREE>(&mut batch, count);
        batch
    }

    #[test]
    fn a_guess_is_as_good_as_a_search() {
        let stretch = stretch();
        let batch = guessed::<3>(stretch, BATCH);
        assert_eq!(batch.ticks, stretch.search(BATCH));
        assert!(stretch.is_right(&batch, BATCH));
    }

    /// What has no jerk, or no acceleration either, is found by what knows it and by what does not.
    #[test]
    fn a_lower_degree_is_the_same() {
        let straight = Stretch { cubic: Cubic { a: 0, j: 0, ..stretch().cubic }, ..stretch() };
        let square = Stretch { cubic: Cubic { j: 0, ..stretch().cubic }, ..stretch() };
        for count in [1, 7, 8, 9, BATCH] {
            let all =
                |batch: Batch| (batch.ticks[..count].to_vec(), batch.p[..count].to_vec(), batch.v[..count].to_vec());
            assert_eq!(all(guessed::<1>(straight, count)), all(guessed::<3>(straight, count)));
            assert_eq!(all(guessed::<2>(square, count)), all(guessed::<3>(square, count)));
        }
    }

    /// Whatever floating point makes of it: nothing but the first steps, all of them, in order, is believed.
    #[test]
    fn wrong_guesses_are_not_believed() {
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

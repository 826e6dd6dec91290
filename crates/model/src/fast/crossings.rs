//! The ticks of a stretch that step: found by jumping from one to the next, or by ticking.

use super::cubic::{Cubic, first};
use crate::phase::bisect_all;

/// A stretch is ticked where a step is expected in every so many ticks or fewer: there an addition a
/// tick costs less than a root an edge.
const DENSE: u32 = 6;

/// Steps that are searched together: their roots do not wait for each other.
pub(super) const BATCH: usize = 32;

/// Refinements of a guess where there is jerk.
const REFINEMENTS: usize = 3;

/// One step in units of 2^-64 step.
const STEP: f64 = 18_446_744_073_709_551_616.0;

/// Ticks that step, with P and V before them.
#[derive(Debug, Clone, Copy, Default)]
struct Batch {
    ticks: [u32; BATCH],
    p: [u64; BATCH],
    v: [i64; BATCH],
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
            if self.backward {
                batch.p.iter_mut().for_each(|p| *p = !*p);
                batch.v.iter_mut().for_each(|v| *v = v.wrapping_neg());
            }
            let phases = bisect_all(&batch.p, &batch.v, phase_bits);
            found(&batch.ticks[..count], &phases[..count]);
        };
        let steps = self.steps_before(self.ticks);
        if self.ticks / DENSE < steps {
            self.tick(&mut found);
        } else {
            self.jump(steps, &mut found);
        }
    }

    /// Steps that are over before tick `n`.
    fn steps_before(&self, n: u32) -> u32 {
        (i128::from(self.p).wrapping_add(self.cubic.distance(n)) >> 64) as u32
    }

    /// Tick by tick.
    fn tick(&self, found: &mut impl FnMut(&mut Batch, usize)) {
        let (mut p, Cubic { mut v, mut a, j }) = (self.p, self.cubic);
        let (mut batch, mut count) = (Batch::default(), 0);
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

    /// From step to step; each batch begins where the one before has ended.
    fn jump(mut self, steps: u32, found: &mut impl FnMut(&mut Batch, usize)) {
        let (mut left, mut done) = (steps as usize, 0);
        while left > 0 {
            let count = left.min(BATCH);
            let mut batch = self.batch(count);
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

    /// The first `count` ticks that step.
    fn batch(&self, count: usize) -> Batch {
        let batch = self.at(self.guesses());
        if self.is_right(&batch, count) { batch } else { self.at(self.search(count)) }
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

    /// These ticks, as if they stepped.
    fn at(&self, ticks: [u32; BATCH]) -> Batch {
        let mut batch = Batch { ticks, ..Batch::default() };
        for ((n, p), v) in ticks.into_iter().zip(&mut batch.p).zip(&mut batch.v) {
            // What P wraps by are the steps.
            *p = self.p.wrapping_add(self.cubic.distance_wrapping(n));
            *v = self.cubic.speed_wrapping(n);
        }
        batch
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

    /// Where the first steps are expected: the roots of n V + n (n - 1) / 2 A = d, refined by Newton's
    /// method where there is jerk.
    fn guesses(&self) -> [u32; BATCH] {
        let Cubic { v, a, j } = self.cubic;
        let (v, a, j) = (v as f64 / STEP, a as f64 / STEP, j as f64 / STEP);
        let begin = self.p as f64 / STEP;
        let most = f64::from(self.ticks);
        let b = v - a / 2.0;
        let distance = |i: usize| (i + 1) as f64 - begin;
        let mut roots = [0.0; BATCH];
        for (i, n) in roots.iter_mut().enumerate() {
            let d = distance(i);
            let square = b * b + 2.0 * a * d;
            // Not `max`, which cares for what is no number.
            *n = 2.0 * d / (b + if square > 0.0 { square } else { 0.0 }.sqrt());
        }
        if j != 0.0 {
            // In powers of n instead of binomials.
            let (c1, c2, c3) = (b + j / 3.0, (a - j) / 2.0, j / 6.0);
            for _ in 0..REFINEMENTS {
                for (i, n) in roots.iter_mut().enumerate() {
                    let near = if *n < most { *n } else { most };
                    let miss = ((c3 * near + c2) * near + c1) * near - distance(i);
                    let slope = (3.0 * c3 * near + 2.0 * c2) * near + c1;
                    *n = near - miss / slope;
                }
            }
        }
        let mut ticks = [0; BATCH];
        for (tick, root) in ticks.iter_mut().zip(roots) {
            *tick = root as u32;
        }
        ticks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten ticks a step, slowly less.
    fn stretch() -> Stretch {
        Stretch::new(1 << 63, Cubic { v: i64::MAX / 5, a: 1 << 40, j: -(1 << 20) }, 5000)
    }

    #[test]
    fn a_guess_is_as_good_as_a_search() {
        let stretch = stretch();
        assert_eq!(stretch.guesses(), stretch.search(BATCH));
        assert!(stretch.is_right(&stretch.at(stretch.guesses()), BATCH));
    }

    /// Whatever floating point makes of it: nothing but the first steps, all of them, in order, is believed.
    #[test]
    fn wrong_guesses_are_not_believed() {
        let stretch = stretch();
        let right = stretch.search(BATCH);
        let believed = |change: fn(&mut [u32; BATCH]), count| {
            let mut ticks = right;
            change(&mut ticks);
            stretch.is_right(&stretch.at(ticks), count)
        };
        assert!(believed(|_| (), BATCH) && believed(|_| (), BATCH - 1));
        assert!(!believed(|ticks| ticks[3] += 1, BATCH), "a tick that does not step");
        assert!(!believed(|ticks| ticks.swap(3, 4), BATCH), "out of order");
        assert!(!believed(|ticks| ticks[4] = ticks[3], BATCH), "one of them twice");
        assert!(!believed(|ticks| ticks.rotate_left(1), BATCH - 1), "one is left out");
        assert!(!believed(|ticks| *ticks.last_mut().unwrap() = u32::MAX, BATCH), "behind the end");
    }
}

//! The ticks of a stretch that step: found by jumping from one to the next, or by ticking.

use super::cubic::{Cubic, first};

/// A stretch is ticked where a step is expected in every so many ticks or fewer: there an addition a
/// tick costs less than a root an edge.
const DENSE: u32 = 8;

/// Roots that are guessed together, so that the divisions overlap.
const BATCH: usize = 8;

/// Guesses that are put right by one tick at a time; a worse one is not worth it.
const TRIES: u32 = 4;

/// One step in units of 2^-64 step.
const STEP: f64 = 18_446_744_073_709_551_616.0;

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

    /// P before tick `n`, with the steps since the start above bit 63.
    fn position(&self, n: u32) -> i128 {
        i128::from(self.p) + self.cubic.distance(n)
    }

    /// Hands over each tick that steps, from 0, with the P and V that it begins with.
    pub fn each(&self, mut found: impl FnMut(u32, u64, i64)) {
        let backward = self.backward;
        let mut found = |n: u32, p: u64, v: i64| if backward { found(n, !p, -v) } else { found(n, p, v) };
        let steps = (self.position(self.ticks) >> 64) as u32;
        if steps == 0 {
            return;
        }
        if self.ticks / DENSE < steps {
            self.tick(&mut found);
        } else if self.cubic.j == 0 {
            self.jump_parabola(steps, &mut found);
        } else {
            self.jump_cubic(steps, &mut found);
        }
    }

    /// Tick by tick.
    fn tick(&self, found: &mut impl FnMut(u32, u64, i64)) {
        let (mut p, Cubic { mut v, mut a, j }) = (self.p, self.cubic);
        for n in 0..self.ticks {
            let (next, carry) = p.overflowing_add(v.cast_unsigned());
            if carry {
                found(n, p, v);
            }
            (p, v, a) = (next, v.wrapping_add(a), a.wrapping_add(j));
        }
    }

    /// From step to step: n V + n (n - 1) / 2 A = d has a root in closed form.
    fn jump_parabola(&self, steps: u32, found: &mut impl FnMut(u32, u64, i64)) {
        let a = self.cubic.a as f64 / STEP;
        let b = self.cubic.v as f64 / STEP - a / 2.0;
        let begin = self.p as f64 / STEP;
        let mut step = 1;
        while step <= steps {
            // Without a dependency between the roots, and so without waiting for each.
            let guesses: [u32; BATCH] = std::array::from_fn(|i| {
                let d = f64::from(step) + i as f64 - begin;
                let root = (b * b + 2.0 * a * d).max(0.0).sqrt();
                (2.0 * d / (b + root)) as u32
            });
            for guess in guesses {
                if step <= steps {
                    self.settle(step, guess, found);
                    step += 1;
                }
            }
        }
    }

    /// From step to step by Newton's method, from where the last period leads.
    fn jump_cubic(&self, steps: u32, found: &mut impl FnMut(u32, u64, i64)) {
        let Cubic { v, a, j } = self.cubic;
        let (v, a, j) = (v as f64 / STEP, a as f64 / STEP, j as f64 / STEP);
        // In powers of n instead of binomials.
        let (c1, c2, c3) = (v - a / 2.0 + j / 3.0, (a - j) / 2.0, j / 6.0);
        let begin = self.p as f64 / STEP;
        let most = f64::from(self.ticks);
        let (mut n, mut period) = (0.0, (1.0 - begin) / v);
        for step in 1..=steps {
            let d = f64::from(step) - begin;
            let mut root: f64 = n + period;
            for _ in 0..2 {
                let miss = ((c3 * root + c2) * root + c1) * root - d;
                let slope = (3.0 * c3 * root + 2.0 * c2) * root + c1;
                // not `clamp`, which does not like what is no number
                root = (root - miss / slope).max(n).min(most);
            }
            (n, period) = (root, root - n);
            self.settle(step, root as u32, found);
        }
    }

    /// The tick that makes step number `step`, exactly, from a guess.
    #[inline]
    fn settle(&self, step: u32, guess: u32, found: &mut impl FnMut(u32, u64, i64)) {
        let mut n = guess.min(self.ticks - 1);
        for _ in 0..TRIES {
            let before = self.position(n);
            let made = (before >> 64) as u32;
            let (p, v) = (before as u64, self.cubic.speed(n) as i64);
            if made >= step {
                n = n.saturating_sub(1);
            } else if made + 1 == step && p.overflowing_add(v.cast_unsigned()).1 {
                return found(n, p, v);
            } else {
                n = (n + 1).min(self.ticks - 1);
            }
        }
        n = first(0, self.ticks - 1, |n| (self.position(n + 1) >> 64) as u32 >= step);
        found(n, self.position(n) as u64, self.cubic.speed(n) as i64);
    }
}

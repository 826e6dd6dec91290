//! A smooth curve as few cubics: each segment as long as its edges stay within the tolerance.
//!
//! A segment knows exactly where it starts, since P carries on; V, A and J are its own. So the best of a given
//! length is a linear programme in three unknowns, and its error grows with the fourth power of the length,
//! which leads to the longest one in two or three tries. Whatever floats have found is rounded to integers, and
//! only these are judged.

use crate::bend::{Bend, Wanted, jerk_distance};
use crate::bounds::bounds;
use crate::check::{speeds, start_speed};
use crate::corridor::{Corridor, Stretch, basis, steps};
use crate::exchange::{Row, solve};
use crate::limits::ExactLimits;
use carrystep_profile::Real;
use carrystep_spec::Segment;

/// The part of the tolerance that samples may use up: between two samples the error is a little greater.
const FULL: f64 = 0.94;

/// What a next try aims at.
const AIM: f64 = 0.935;

/// From here on a segment is long enough.
const ENOUGH: f64 = 0.93;

/// Tries for one segment, as long as one of them has been good.
const TRIES: usize = 12;

/// The first try for a segment after one that had to be short, ticks.
const LEAST_GUESS: f64 = 64.0;

/// Segments of so few ticks are straight.
const STRAIGHT: u64 = 3;

/// One segment of a fit, in the direction of travel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fitted {
    pub ticks: u64,
    pub bend: Bend,
    /// Distance, 2^-64 step: a V for all ticks makes it, but for the last segment of a move.
    pub distance: i128,
}

/// Fits one piece of a curve.
#[derive(Debug)]
pub(crate) struct Fitter<'a, F> {
    pub corridor: Corridor<'a, F>,
    pub limits: &'a ExactLimits,
    pub rows: Vec<Row>,
}

impl<F: Real> Fitter<'_, F> {
    /// The segments of the piece, for an axis that is at `done` when it begins; `risen` are those of the ramp up.
    pub fn segments(&mut self, done: i128, risen: &[Fitted]) -> Vec<Fitted> {
        self.mirrored(done, risen).unwrap_or_else(|| self.greedy(done))
    }

    /// One segment after the other, each as long as it can be.
    fn greedy(&mut self, mut done: i128) -> Vec<Fitted> {
        let ticks = self.corridor.piece.ticks;
        let mut segments: Vec<Fitted> = Vec::new();
        let mut guess = ticks as f64;
        let mut first = 0;
        while first < ticks {
            let fitted = self.longest(first, done, guess);
            let length = fitted.ticks as f64;
            let trend = segments.last().map_or(1.0, |before| (length / before.ticks as f64).clamp(0.5, 2.0));
            guess = (length * trend).max(LEAST_GUESS);
            first += fitted.ticks;
            done += fitted.distance;
            segments.push(fitted);
        }
        segments
    }

    /// The ramp up run backward, if that keeps the tolerance: a cubic backward in time is a cubic, tick for tick.
    fn mirrored(&mut self, mut done: i128, risen: &[Fitted]) -> Option<Vec<Fitted>> {
        let piece = self.corridor.piece;
        if risen.iter().map(|fitted| fitted.ticks).sum::<u64>() != piece.ticks {
            return None;
        }
        let end = piece.start + piece.units;
        let mut first = 0;
        let mut segments = Vec::with_capacity(risen.len());
        for (left, &Fitted { ticks, bend: Bend { a, j }, distance }) in (0..risen.len()).rev().zip(risen.iter().rev()) {
            let ends = left == 0 && piece.first + piece.ticks == self.corridor.clock.ticks;
            let bend = Bend { a: -a - (i128::from(ticks) - 2) * j, j };
            let distance = if ends { end - done } else { distance };
            let fitted = self.whole(Fitted { ticks, bend, distance }, end - done, ends)?;
            self.rows.clear();
            self.corridor.rows(Stretch { first, ticks, done }, &mut self.rows);
            if self.judge(&fitted, self.rows.len(), false)? > 1.0 {
                return None;
            }
            first += ticks;
            done += fitted.distance;
            segments.push(fitted);
        }
        Some(segments)
    }

    /// The longest segment that keeps the tolerance, within a few percent.
    fn longest(&mut self, first: u64, done: i128, guess: f64) -> Fitted {
        let left = self.corridor.piece.ticks - first;
        let most = left.min(u32::MAX.into());
        let (mut good, mut bad): (Option<Fitted>, u64) = (None, most + 1);
        let mut ticks = (guess as u64).clamp(1, most);
        for attempt in 0.. {
            if ticks <= STRAIGHT {
                break;
            }
            let trial = self.best(Stretch { first, ticks, done });
            let level = trial.map_or(f64::INFINITY, |(_, level)| level);
            match trial.filter(|_| level <= FULL) {
                Some((fitted, _)) => good = Some(fitted),
                None => bad = ticks,
            }
            let known = good.map_or(0, |fitted| fitted.ticks);
            let enough = known == most || (known == ticks && level >= ENOUGH);
            if good.is_some() && (enough || attempt >= TRIES || bad - known <= known / 64 + 1) {
                break;
            }
            let factor = (AIM / level).powf(0.25).clamp(0.25, 4.0);
            let next = (ticks as f64 * factor) as u64;
            ticks = if next > known && next < bad { next } else { known.midpoint(bad) };
        }
        good.unwrap_or_else(|| self.straight(first, done, most.min(STRAIGHT)))
    }

    /// The best cubic of a stretch, and the part of the tolerance that its integers use.
    fn best(&mut self, stretch: Stretch) -> Option<(Fitted, f64)> {
        let Stretch { first, ticks, done } = stretch;
        let piece = self.corridor.piece;
        let n = ticks as f64;
        self.rows.clear();
        let start = self.corridor.rows(stretch, &mut self.rows);
        let samples = self.rows.len();
        let closed = first + ticks == piece.ticks;
        let rest = piece.start + piece.units - done;
        let scale = self.rows.iter().map(|row| row.at[0].abs()).fold(f64::MIN_POSITIVE, f64::max);
        let whole = piece.first + piece.ticks == self.corridor.clock.ticks;
        let (opens, ends) = (piece.first + first == 0, closed && whole);
        if closed {
            // Exactly to the end: the integers will see to it, so this need not be more than near.
            let at = basis(n, n).map(|b| b * scale * 100.0);
            let most = steps(rest) * scale * 100.0;
            self.rows.push(Row { at, error: 1.0, most });
            self.rows.push(Row { at: at.map(|b| -b), error: 1.0, most: -most });
        } else {
            // No further than the piece: nothing could come back.
            self.rows.push(Row { at: basis(n, n).map(|b| b * scale), error: 0.0, most: steps(rest) * scale });
        }
        bounds(&mut self.rows, n, self.limits, [opens, ends], scale);
        let [v, a, j] = solve(&self.rows, start)?.coefficients;
        let [by_v, by_a, by_j] = basis(n, n);
        let units = |x: f64| (x * 2_f64.powi(64)) as i128;
        let distance = if closed { rest } else { units(by_v * v + by_a * a + by_j * j) };
        let wanted = Wanted {
            ticks: ticks.into(),
            distance,
            doubled_middle: units((a + a + j * (1.0 - 2.0 / n)) / (n * n)),
            jerk: units(j / (n * n * n)),
            one_way: false,
            first: opens,
        };
        let fitted = self.whole(Fitted { ticks, bend: wanted.within(self.limits), distance }, rest, ends)?;
        let level = self.judge(&fitted, samples, opens)?;
        Some((fitted, level))
    }

    /// The distance that a whole V makes; that of the last segment of a move stays, and is shared out in the end.
    fn whole(&self, fitted: Fitted, rest: i128, ends: bool) -> Option<Fitted> {
        let Fitted { ticks, bend: Bend { a, j }, distance } = fitted;
        let n = i128::from(ticks);
        let bent = n * (n - 1) / 2 * a + jerk_distance(n, j)?;
        let level = distance - bent;
        // P is never behind its ideal, whichever way it goes.
        let (down, up) = (level.div_euclid(n), -(-level).div_euclid(n));
        let v = if self.corridor.backward || n * up + bent > rest { down } else { up };
        Some(if ends { fitted } else { Fitted { distance: n * v + bent, ..fitted } })
    }

    /// The level that the integers reach; `None` if they break a limit, the start speed where they open a move.
    fn judge(&self, fitted: &Fitted, samples: usize, opens: bool) -> Option<f64> {
        let &Fitted { ticks, bend: Bend { a, j }, distance } = fitted;
        let n = i128::from(ticks);
        let level = distance - n * (n - 1) / 2 * a - jerk_distance(n, j)?;
        let register = |x: i128| i64::try_from(x).ok();
        let (v, a64, j64) = (register(level.div_euclid(n))?, register(a)?, register(j)?);
        let segment = Segment { ticks: u32::try_from(ticks).ok()?, v, a: a64, j: j64, last: false };
        let fastest = self.limits.speed + self.limits.tolerance;
        if !speeds(&segment).all(|v| (0..fastest).contains(&v)) {
            return None;
        }
        if opens && start_speed(&segment, self.limits) > self.limits.start_speed + self.limits.tolerance {
            return None;
        }
        let length = ticks as f64;
        let found = [steps(level), steps(a) * length * length, steps(j) * length * length * length];
        let error = |row: &Row| row.at[0] * found[0] + row.at[1] * found[1] + row.at[2] * found[2] - row.most;
        Some(self.rows[..samples].iter().map(error).fold(0.0, f64::max))
    }

    /// A few ticks at one speed, back to the profile as far as the speed limit allows.
    fn straight(&self, first: u64, done: i128, ticks: u64) -> Fitted {
        let piece = self.corridor.piece;
        let closed = first + ticks == piece.ticks;
        let ends = closed && piece.first + piece.ticks == self.corridor.clock.ticks;
        let rest = piece.start + piece.units - done;
        let ideal = (self.corridor.ahead(done, (first + ticks) as f64) * 2_f64.powi(64)) as i128;
        let most = i128::from(ticks) * self.limits.speed;
        let distance = if closed { rest } else { ideal.min(rest) }.min(most).max(0);
        let fitted = Fitted { ticks, bend: Bend::default(), distance };
        self.whole(fitted, rest, ends).unwrap_or(fitted)
    }
}

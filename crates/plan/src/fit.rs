//! Fits a smooth curve with few cubic segments, each as long as its edges stay within the
//! tolerance.
//!
//! A segment knows exactly where it starts, since P carries on; its V, A and J are free. The best
//! segment of a given length is therefore the solution of a linear programme in three unknowns. Its
//! error grows with about the fourth power of the length, so that two or three tries find the
//! longest one. The floats of the solution are rounded to integers, and only the integers are
//! judged. The constants below may be tuned: they affect the number of segments and the planning
//! time, not the tolerance.

use crate::bend::{Bend, Wanted};
use crate::bounds::bounds;
use crate::corridor::{Corridor, Samples, Stretch};
use crate::cubic::{basis, peak, steps};
use crate::exchange::{Row, solve};
use crate::fitted::Fitted;
use crate::limits::ExactLimits;
use crate::search::{Search, longer, shorter};
use carrystep_profile::Real;

/// Tries for one segment after which the best one so far is taken.
const TRIES: usize = 12;

/// The least length of the first try for the segment after a short one, ticks.
const LEAST_GUESS: f64 = 64.0;

/// If the rest of a piece is shorter than a segment divided by this number, the segment and the
/// rest are divided evenly instead.
const STUB: u64 = 4;

/// Fits one piece of a curve.
#[derive(Debug)]
pub(crate) struct Fitter<'a, F> {
    pub corridor: Corridor<'a, F>,
    pub limits: &'a ExactLimits,
    pub rows: Vec<Row>,
    pub search: Search,
    /// Whether a kept fit may be used.
    pub keeps: bool,
}

impl<F: Real> Fitter<'_, F> {
    /// Returns the segments of the piece for an axis that is at `done` when the piece begins.
    /// A ramp whose shape is known is fitted once for all its sizes (`kept.rs`). `risen` are the
    /// segments of the ramp up, which a ramp down may reuse.
    pub fn segments(&mut self, done: i128, risen: &[Fitted]) -> Vec<Fitted> {
        let kept = if self.keeps { self.scaled(done) } else { None };
        kept.or_else(|| self.mirrored(done, risen)).unwrap_or_else(|| self.greedy(done))
    }

    /// Fits one segment after the other, each as long as possible.
    pub fn greedy(&mut self, mut done: i128) -> Vec<Fitted> {
        let ticks = self.corridor.piece.ticks;
        let mut segments: Vec<Fitted> = Vec::new();
        let mut guess = ticks as f64;
        let mut first = 0;
        while first < ticks {
            let longest = self.longest(first, done, guess);
            let fitted = self.without_stub(first, done, longest);
            let length = fitted.ticks as f64;
            let trend = segments
                .last()
                .map_or(1.0, |before| (length / before.ticks as f64).clamp(0.5, 2.0));
            guess = (length * trend).max(LEAST_GUESS);
            first += fitted.ticks;
            done += fitted.distance;
            segments.push(fitted);
        }
        segments
    }

    /// Returns the segments of the ramp up in reverse, if they keep the tolerance: a cubic reversed
    /// in time is again a cubic, tick for tick.
    fn mirrored(&mut self, mut done: i128, risen: &[Fitted]) -> Option<Vec<Fitted>> {
        let piece = self.corridor.piece;
        if risen.iter().map(|fitted| fitted.ticks).sum::<u64>() != piece.ticks {
            return None;
        }
        let end = piece.start + piece.units;
        let mut first = 0;
        let mut segments = Vec::with_capacity(risen.len());
        for (left, &Fitted { ticks, bend: Bend { a, j }, distance }) in
            (0..risen.len()).rev().zip(risen.iter().rev())
        {
            let ends = left == 0 && piece.first + piece.ticks == self.corridor.clock.ticks;
            if distance > end - done && !ends {
                return None;
            }
            let reversed = Bend { a: -a - (i128::from(ticks) - 2) * j, j };
            // The last segment also corrects what the segments before it are off. Its V must not
            // fall below zero.
            let (bend, distance) = if ends {
                (reversed.landing(ticks, end - done, self.limits), end - done)
            } else {
                (reversed, distance)
            };
            let fitted = (Fitted { ticks, bend, distance }).whole(
                self.corridor.backward,
                end - done,
                ends,
            )?;
            self.rows.clear();
            let samples = self.corridor.rows(Stretch { first, ticks, done }, &mut self.rows);
            if self.judge(&fitted, (self.rows.len(), samples.standing), false)? > 1.0 {
                return None;
            }
            first += ticks;
            done += fitted.distance;
            segments.push(fitted);
        }
        Some(segments)
    }

    /// The longest segment that keeps the tolerance, within a few percent of its length.
    fn longest(&mut self, first: u64, done: i128, guess: f64) -> Fitted {
        let Search { aim, enough: enough_level, to_end, .. } = self.search;
        let left = self.corridor.piece.ticks - first;
        let most = left.min(u32::MAX.into());
        let (mut good, mut bad): (Option<Fitted>, u64) = (None, most + 1);
        // The two shortest lengths that are too long, with their levels; the shorter one is last.
        let mut long = [(f64::INFINITY, f64::INFINITY); 2];
        let mut ticks = (guess as u64).clamp(1, most);
        for attempt in 0.. {
            if ticks <= 1 {
                break;
            }
            let trial = self.best(Stretch { first, ticks, done });
            let level = trial.map_or(f64::INFINITY, |(_, level)| level);
            match trial.filter(|_| level <= self.search.full) {
                Some((fitted, _)) => good = Some(fitted),
                None => (bad, long) = (ticks, [long[1], (ticks as f64, level)]),
            }
            let known = good.map_or(0, |fitted| fitted.ticks);
            let enough = known == most || (known == ticks && level >= enough_level);
            let close = bad - known <= known / self.search.close + 1;
            if good.is_some() && (enough || attempt >= TRIES || (close && (bad <= most || !to_end)))
            {
                break;
            }
            let next = if long[1].1.is_finite() {
                shorter(long, aim)
            } else {
                longer(ticks as f64, level, aim)
            };
            ticks = match next as u64 {
                _ if close && to_end => most,
                next if next > known && next < bad => next,
                next if next >= bad && bad > most => most,
                _ => known.midpoint(bad),
            };
        }
        good.unwrap_or_else(|| self.straight(first, done))
    }

    /// Replaces the longest segment by half of the rest of the piece, if only a stub would follow
    /// it: a stub could hardly correct the error that the longest segment leaves.
    fn without_stub(&mut self, first: u64, done: i128, longest: Fitted) -> Fitted {
        let left = self.corridor.piece.ticks - first;
        let stub = left - longest.ticks;
        if stub == 0 || stub >= longest.ticks / STUB {
            return longest;
        }
        let half = self.best(Stretch { first, ticks: left / 2, done });
        half.filter(|&(_, level)| level <= self.search.full).map_or(longest, |(fitted, _)| fitted)
    }

    /// Returns the best cubic of a stretch, and the fraction of the tolerance that its integers
    /// use.
    ///
    /// The last cubic of a piece corrects the distance that the segments before it are off. If that
    /// would exceed a limit or the tolerance, the next piece corrects it, as long as there is one.
    fn best(&mut self, stretch: Stretch) -> Option<(Fitted, f64)> {
        let piece = self.corridor.piece;
        if stretch.first + stretch.ticks < piece.ticks {
            return self.cubic(stretch, false);
        }
        let closed = self.cubic(stretch, true);
        // A kept fit also serves ramps down, which begin exactly where it ends.
        let kept = self.corridor.longer > 1.0;
        if kept
            || closed.is_some_and(|(_, level)| level <= self.search.full)
            || piece.first + piece.ticks == self.corridor.clock.ticks
        {
            return closed;
        }
        self.cubic(stretch, false)
    }

    /// Returns the best cubic of a stretch. If `closed`, it has to end exactly where the piece
    /// ends.
    fn cubic(&mut self, stretch: Stretch, closed: bool) -> Option<(Fitted, f64)> {
        let Stretch { first, ticks, done } = stretch;
        let piece = self.corridor.piece;
        let n = ticks as f64;
        self.rows.clear();
        let Samples { start, standing } = self.corridor.rows(stretch, &mut self.rows);
        let samples = self.rows.len();
        let rest = piece.start + piece.units - done;
        let scale = self.rows.iter().map(|row| row.at[0].abs()).fold(f64::MIN_POSITIVE, f64::max);
        let whole = piece.first + piece.ticks == self.corridor.clock.ticks;
        let (opens, ends) = (piece.first + first == 0, closed && whole);
        if closed {
            // These two rows only have to bring the cubic near the end of the piece; the integers
            // reach it exactly.
            let at = basis(n, n).map(|b| b * scale * 100.0);
            let most = steps(rest) * scale * 100.0;
            self.rows.push(Row { at, error: 1.0, most });
            self.rows.push(Row { at: at.map(|b| -b), error: 1.0, most: -most });
        } else {
            // The cubic must not pass the end of the piece, because nothing could correct that.
            self.rows.push(Row {
                at: basis(n, n).map(|b| b * scale),
                error: 0.0,
                most: steps(rest) * scale,
            });
        }
        bounds(&mut self.rows, n, self.limits, [opens, ends], scale);
        if opens && self.corridor.longer > 1.0 && self.limits.start_speed == 0 {
            // A fit for ticks of any length starts at rest, and not half a tick from it.
            let mut hold = |at: [f64; 3]| {
                self.rows.push(Row { at: at.map(|b| b * scale), error: 0.0, most: 0.0 });
            };
            hold([-1.0, 0.5 / n, -1.0 / (3.0 * n * n)]);
            hold([0.0, -1.0, 1.0 / n]);
        }
        let [v, a, j] = solve(&self.rows, start)?.coefficients;
        let [by_v, by_a, by_j] = basis(n, n);
        let units = |x: f64| (x * 2_f64.powi(64)) as i128;
        let distance = if closed { rest } else { units(by_v * v + by_a * a + by_j * j).min(rest) };
        // A rounded cubic may dip below zero between its ends. The second try forbids A to change
        // its sign, which rules this out.
        [false, true].into_iter().find_map(|one_way| {
            let wanted = Wanted {
                ticks,
                distance,
                doubled_middle: units((a + a + j * (1.0 - 2.0 / n)) / (n * n)),
                jerk: units(j / (n * n * n)),
                one_way,
                least: i64::from(opens && self.corridor.steps_at_once()),
                first: opens,
            };
            let fitted = Fitted { ticks, bend: wanted.within(self.limits), distance };
            let fitted = fitted.whole(self.corridor.backward, rest, ends)?;
            let level = self.judge(&fitted, (samples, standing), opens)?;
            Some((fitted, level))
        })
    }

    /// Returns the level of the integers as a fraction of the tolerance, or `None` if they break a
    /// limit. The start speed counts only for a segment that `opens` a move.
    fn judge(
        &self,
        fitted: &Fitted,
        (samples, standing): (usize, usize),
        opens: bool,
    ) -> Option<f64> {
        let found = fitted.found(self.limits, opens, self.corridor.steps_at_once())?;
        let length = fitted.ticks as f64;
        let found = [found[0], found[1] * length * length, found[2] * length * length * length];
        let error = |row: &Row| {
            row.at[0] * found[0] + row.at[1] * found[1] + row.at[2] * found[2] - row.most
        };
        let side = |side| peak(self.rows[side..standing.max(side)].iter().step_by(2).map(error));
        let rest = self.rows[standing..samples].iter().map(error).fold(0.0, f64::max);
        Some(rest.max(side(0)).max(side(1)))
    }

    /// A segment of one tick that returns to the profile as far as the speed limit allows.
    fn straight(&self, first: u64, done: i128) -> Fitted {
        let piece = self.corridor.piece;
        let ends =
            first + 1 == piece.ticks && piece.first + piece.ticks == self.corridor.clock.ticks;
        let rest = piece.start + piece.units - done;
        let ideal = (self.corridor.ahead(done, (first + 1) as f64) * 2_f64.powi(64)) as i128;
        let distance = if ends { rest } else { ideal.min(rest).clamp(0, self.limits.speed) };
        Fitted { ticks: 1, bend: Bend::default(), distance }
    }
}

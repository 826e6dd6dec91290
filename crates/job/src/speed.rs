//! The speed law: the fastest motion along the smoothed curve within feed, speed and acceleration.
//!
//! The curve has a parameter u that is nearly the time in knot times. x is the square of du/dt and
//! y the second derivative of u. Along the curve, an axis with the derivatives q' and q'' has the
//! acceleration q' y + q'' x, so that each limit is linear in x and y. A backward pass finds the
//! greatest x at each grid point from which the motion can go on within the limits; a forward pass
//! takes the greatest y that keeps to these values (H. Pham and Q.-C. Pham, A New Approach to
//! Time-Optimal Path Parameterization Based on Reachability Analysis, 2018). Each interval keeps
//! its limits at both ends, with one y (their section on interpolation).
//!
//! The emitted motion is sampled once a knot time. Only second differences of the samples reach the
//! hardware, so q' and q'' are differences of the curve's values at the knots.

use crate::limits::Motors;
use crate::path::{Path, Place};
use crate::rough::Knot;
use crate::spline::value;
use crate::vector::{Point, dot, from_to, norm, plus, weighted};

/// Control points before the first grid point, and after the last one.
pub(crate) const MARGIN: usize = 2;
/// Greatest x: where the curve is at rest in u, nothing else bounds it.
const FASTEST: f64 = 16.0;
/// Differences below this part of a limit do not count.
const NOTHING: f64 = 1e-12;

/// What bounds the motion.
#[derive(Debug, Clone)]
pub(crate) struct Rules<const N: usize> {
    pub motors: Motors<N>,
    pub knot_seconds: f64,
    /// Part of the limits of speed and acceleration that is used.
    pub part: f64,
    /// Greatest acceleration across the path for each mm of tolerance, 1/s^2.
    pub across: f64,
}

/// The constraints at one grid point: |g y + h x| <= 1 for each axis, and x <= most.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid<const N: usize> {
    g: Point<N>,
    h: Point<N>,
    most: f64,
}

impl<const N: usize> Grid<N> {
    /// Uses only a part of the accelerations, and no x over `most`.
    pub fn eased(mut self, part: f64, most: f64) -> Self {
        self.g = self.g.map(|x| x / part);
        self.h = self.h.map(|x| x / part);
        self.most = self.most.min(most);
        self
    }
}

impl<const N: usize> Rules<N> {
    /// The grid points of these control points, without the [`MARGIN`] at both ends.
    pub fn grid(&self, c: &[Knot<N>], path: &Path<N>) -> Vec<Grid<N>> {
        let thirds = [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0];
        let values: Vec<Point<N>> = c
            .windows(3)
            .map(|c| weighted(&thirds, &[c[0].point, c[1].point, c[2].point]))
            .collect();
        // values[k] belongs to c[k + 1].
        let slopes: Vec<f64> = values
            .windows(2)
            .enumerate()
            .map(|(k, pair)| self.slope(&from_to(&pair[0], &pair[1]), &c[k..k + 4], path))
            .collect();
        (1..values.len().saturating_sub(1))
            .map(|k| {
                let first = from_to(&values[k - 1], &values[k + 1]).map(|x| x / 2.0);
                let second: Point<N> = std::array::from_fn(|i| {
                    values[k + 1][i] - 2.0 * values[k][i] + values[k - 1][i]
                });
                let steep = slopes[k - 1].max(slopes[k]);
                let most = FASTEST.min((steep * steep).recip()).min(self.across(
                    &first,
                    &second,
                    &c[k + 1],
                    path,
                ));
                let unit = self.knot_seconds * self.knot_seconds * self.part;
                let [mut g, mut h] = [first, second].map(|d| self.motors.of(&d));
                for (i, limit) in self.motors.limits.iter().enumerate() {
                    g[i] /= limit.acceleration * unit;
                    h[i] /= limit.acceleration * unit;
                }
                Grid { g, h, most }
            })
            .collect()
    }

    /// The greatest part of a speed limit that a difference of neighbouring values takes at one
    /// knot time, feeds of the pieces around included.
    fn slope(&self, difference: &Point<N>, c: &[Knot<N>], path: &Path<N>) -> f64 {
        let mut steep = 0.0_f64;
        let motors = self.motors.of(difference);
        for (d, limit) in motors.iter().zip(&self.motors.limits) {
            steep = steep.max(d.abs() / (limit.speed * self.knot_seconds * self.part));
        }
        let length = |d: &[f64]| d.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (line, turn) = difference.split_at(path.linear);
        for number in c[0].place.piece..=c[3].place.piece {
            if let Some(piece) = path.piece(number) {
                let moved = if piece.turns_only { length(turn) } else { length(line) };
                steep = steep.max(moved / (piece.feed * self.knot_seconds));
            }
        }
        steep
    }

    /// The greatest x with which the acceleration across the path is within its bound.
    fn across(&self, first: &Point<N>, second: &Point<N>, knot: &Knot<N>, path: &Path<N>) -> f64 {
        let square = dot(first, first);
        if square <= 0.0 || self.across.is_infinite() {
            return f64::INFINITY;
        }
        let across = plus(second, -dot(first, second) / square, first);
        let piece = path.piece(knot.place.piece);
        let tolerance = piece.map_or(0.0, |piece| piece.tolerance.toward(&across, path.linear));
        self.across * tolerance * self.knot_seconds * self.knot_seconds / norm(&across)
    }
}

/// For each grid point the greatest x from which `last` is reached, or less, at the last one.
pub(crate) fn reachable<const N: usize>(grid: &[Grid<N>], last: f64) -> Vec<f64> {
    let mut most = last;
    let mut reach = vec![0.0; grid.len()];
    for k in (0..grid.len()).rev() {
        most = match grid.get(k + 1) {
            None => last.min(grid[k].most),
            Some(next) => backward(&grid[k], next, most),
        };
        reach[k] = most;
    }
    reach
}

/// The greatest x at each grid point, from `x` at the first one.
pub(crate) fn fastest<const N: usize>(grid: &[Grid<N>], reach: &[f64], x: f64) -> Vec<f64> {
    let mut speeds = Vec::with_capacity(grid.len());
    let mut x = x.min(reach[0]);
    speeds.push(x);
    for (pair, &most) in grid.windows(2).zip(&reach[1..]) {
        let (low, high) = bounds(&pair[0], &pair[1], x);
        x = (x + 2.0 * high.y.max(low.y)).min(most).max(0.0);
        speeds.push(x);
    }
    speeds
}

/// A bound on y at one x, and its slope over x.
#[derive(Clone, Copy)]
struct Bound {
    y: f64,
    slope: f64,
}

/// The least and the greatest y of an interval that starts with `x`.
#[inline]
fn bounds<const N: usize>(here: &Grid<N>, there: &Grid<N>, x: f64) -> (Bound, Bound) {
    let mut low = Bound { y: f64::NEG_INFINITY, slope: 0.0 };
    let mut high = Bound { y: f64::INFINITY, slope: 0.0 };
    for i in 0..N {
        // At the end of the interval, x is greater by 2 y.
        let ends = [(here.g[i], here.h[i]), (there.g[i] + 2.0 * there.h[i], there.h[i])];
        for (g, h) in ends {
            if g.abs() < NOTHING {
                continue;
            }
            let (slope, half) = (-h / g, 1.0 / g.abs());
            if slope * x - half > low.y {
                low = Bound { y: slope * x - half, slope };
            }
            if slope * x + half < high.y {
                high = Bound { y: slope * x + half, slope };
            }
        }
    }
    (low, high)
}

/// The greatest x from which at most `most` is kept at the next grid point. The excess of the
/// least y over the greatest y is a convex function of x; Newton's method finds its zero from above
/// in finitely many steps, because the function consists of lines.
fn backward<const N: usize>(here: &Grid<N>, there: &Grid<N>, most: f64) -> f64 {
    let mut x = here.most;
    for i in 0..N {
        if here.g[i].abs() < NOTHING && here.h[i].abs() * x > 1.0 {
            x = here.h[i].abs().recip();
        }
    }
    for _ in 0..32 {
        let (low, mut high) = bounds(here, there, x);
        let keep = Bound { y: (most - x) / 2.0, slope: -0.5 };
        if keep.y < high.y {
            high = keep;
        }
        let excess = low.y - high.y;
        if excess <= NOTHING {
            return x;
        }
        let slope = low.slope - high.slope;
        x = if slope > 0.0 { (x - excess / slope).max(0.0) } else { x / 2.0 };
    }
    x
}

/// A sample of the motion: where the curve is, and its parameter.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instant<const N: usize> {
    pub knot: Knot<N>,
    /// The parameter, from the first grid point on.
    pub u: f64,
    /// A place on the path that the curve has not passed.
    pub ahead: Place,
}

/// Samples a motion with these x once a knot time, the first sample `next` knot times after the
/// first grid point. Returns the samples and the time from the last grid point to the next one.
pub(crate) fn sampled<const N: usize>(
    c: &[Knot<N>],
    speeds: &[f64],
    mut next: f64,
) -> (Vec<Instant<N>>, f64) {
    let mut samples = Vec::with_capacity(speeds.len() + 8);
    for (k, pair) in speeds.windows(2).enumerate() {
        let [v, w] = [pair[0], pair[1]].map(f64::sqrt);
        let duration = 2.0 / (v + w).max(1e-6);
        let c = &c[k + MARGIN - 1..];
        let points = [c[0].point, c[1].point, c[2].point, c[3].point];
        while next < duration {
            let u = (next * (v + (w - v) * next / duration / 2.0)).clamp(0.0, 1.0);
            let knot = Knot { point: value(&points, u), place: c[2].place };
            samples.push(Instant { knot, u: k as f64 + u, ahead: c[3].place });
            next += 1.0;
        }
        next -= duration;
    }
    (samples, next)
}

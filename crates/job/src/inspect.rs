//! Measures the emitted curve: speed, acceleration and jerk of each motor, and the distance from
//! the programmed path.

use crate::cover::{Cover, bezier};
use crate::limits::{Limit, Motors};
use crate::path::{Corner, MOST_REACH, Path, Place};
use crate::piece::Piece;
use crate::rough::Knot;
use crate::speed::Instant;
use crate::spline::value;
use crate::vector::{Point, dot, from_to, norm, plus};
use std::cell::Cell;

/// Part of the limits that may be used; the rest is for rounding to integers.
const LIMIT_PART: f64 = 1.0 - 1e-7;
/// Part of the tolerance that may be used at the places that are measured; the rest is for the
/// places between them.
const TOLERANCE_PART: f64 = 0.97;

/// The square of a way in one knot time below which the curve is at rest, mm^2.
const NOTHING: f64 = 1e-18;

/// Least excess of what is found between these places.
const LEAST_EXCESS: f64 = 1.005;
/// Greatest excess of a distance from a corner.
const MOST_EXCESS: f64 = 1.1;

/// Where the distance from the path is measured between two knots, beside the corner.
const PHASES: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
/// How often the time is halved in which the curve passes a corner.
const HALVINGS: usize = 10;

/// A place where the emitted curve exceeds a limit or the tolerance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fault<const N: usize> {
    /// Parameter of the smoothed curve.
    pub u: f64,
    /// The value as a part of what is allowed, over 1.
    pub excess: f64,
    /// From the path, or from its corner, to the curve, if the tolerance is exceeded; otherwise it is a limit.
    pub off: Option<Point<N>>,
}

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Depth {
    /// The limits of the motors, and the distance from the path at places. This tells how to correct
    /// the curve.
    Places,
    /// Also the proof for all between them. Without it no curve is accepted.
    Proof,
}

#[derive(Debug, Clone)]
pub(crate) struct Inspector<const N: usize> {
    motors: Motors<N>,
    /// For each motor, the parts of its limits of speed, acceleration and jerk that a difference of
    /// 1 between control points takes.
    parts: Vec<[f64; 3]>,
    /// The last four control points of the emitted curve, of the letters and of the motors.
    letters: [Point<N>; 4],
    turned: [Point<N>; 4],
    /// The greatest parameter of the path so far.
    place: Place,
    /// Parameter and place of the last four control points.
    u: [f64; 4],
    places: [Place; 4],
    cover: Cover,
    /// Where the nearest place of the path came to a later piece than the curve, which has not come
    /// there since: parameter and point of the curve.
    ahead: Option<(f64, Point<N>)>,
    /// The greatest distance from the path between the last two measured knots, as a part of the
    /// tolerance.
    measured: f64,
}

impl<const N: usize> Inspector<N> {
    pub fn new(motors: Motors<N>, knot_seconds: f64) -> Self {
        let t = knot_seconds;
        let part = |limit: &Limit| {
            [
                1.0 / (limit.speed * t),
                1.0 / (limit.acceleration * t * t),
                1.0 / (limit.jerk * t * t * t),
            ]
        };
        Self {
            parts: motors.limits.iter().map(part).collect(),
            motors,
            letters: [[0.0; N]; 4],
            turned: [[0.0; N]; 4],
            place: Place::default(),
            u: [0.0; 4],
            places: [Place::default(); 4],
            cover: Cover::default(),
            ahead: None,
            measured: 0.0,
        }
    }

    /// The curve has been at rest at this knot.
    pub fn rest(&mut self, knot: Knot<N>) {
        self.letters = [knot.point; 4];
        self.turned = [self.motors.of(&knot.point); 4];
        self.place = knot.place;
        self.u = [0.0; 4];
        self.places = [knot.place; 4];
        self.cover = Cover::at(knot.place);
        self.ahead = None;
        self.measured = 0.0;
    }

    /// Where on the path the curve was at the last measured place.
    pub fn place(&self) -> Place {
        self.place
    }

    /// The greatest distance from the path at the places that were measured last, as a part of the
    /// tolerance.
    pub fn measured(&self) -> f64 {
        self.measured
    }

    /// The curvature of the emitted curve in the middle between the last two measured knots, 1/mm; 0
    /// where the curve is at rest.
    pub fn curvature(&self) -> f64 {
        let [a, b, c, d] = &self.letters;
        let first = from_to(b, c);
        let second: Point<N> = std::array::from_fn(|i| (d[i] - c[i] - b[i] + a[i]) / 2.0);
        let square = dot(&first, &first);
        if square <= NOTHING {
            return 0.0;
        }
        norm(&plus(&second, -dot(&first, &second) / square, &first)) / square
    }

    /// The first piece on which the curve may still be.
    pub fn oldest(&self) -> u64 {
        self.cover.oldest()
    }

    /// Where the path goes on from a rest at a point.
    pub fn leaving(&self, point: &Point<N>, path: &Path<N>) -> Place {
        self.cover.leaving(point, path)
    }

    /// Parameter and acceleration, as a part of its limit, at the last measured knot.
    pub fn accelerated(&self) -> (f64, f64) {
        let [_, b, c, d] = &self.turned;
        let parts = self.parts.iter().enumerate();
        let parts = parts.map(|(i, part)| (d[i] - 2.0 * c[i] + b[i]).abs() * part[1]);
        (self.u[2], parts.fold(0.0, f64::max))
    }

    /// Parameters are counted from a later grid point from now on.
    pub fn rebase(&mut self, by: f64) {
        self.u.iter_mut().for_each(|u| *u -= by);
        if let Some((u, _)) = &mut self.ahead {
            *u -= by;
        }
    }

    /// Adds the next control point; measures the curve between the two points before the last. The
    /// proof goes on only from an inspector that has proved all before.
    pub fn push(
        &mut self,
        emitted: &Instant<N>,
        path: &Path<N>,
        depth: Depth,
    ) -> impl Iterator<Item = Fault<N>> + use<N> {
        self.letters = [self.letters[1], self.letters[2], self.letters[3], emitted.knot.point];
        let motors = self.motors.of(&emitted.knot.point);
        self.turned = [self.turned[1], self.turned[2], self.turned[3], motors];
        self.u = [self.u[1], self.u[2], self.u[3], emitted.u];
        self.places = [self.places[1], self.places[2], self.places[3], emitted.ahead];
        let excess = self.limits() / LIMIT_PART;
        let limit = (excess > 1.0).then_some(Fault { u: self.u[2], excess, off: None });
        limit.into_iter().chain(self.off(path, depth))
    }

    /// The greatest value as a part of its limit: differences of the last control points.
    fn limits(&self) -> f64 {
        let [a, b, c, d] = &self.turned;
        let mut greatest = 0.0_f64;
        for (i, [speed, acceleration, jerk]) in self.parts.iter().enumerate() {
            let (first, second) = (d[i] - c[i], d[i] - 2.0 * c[i] + b[i]);
            let third = d[i] - 3.0 * c[i] + 3.0 * b[i] - a[i];
            greatest = greatest
                .max(first.abs() * speed)
                .max(second.abs() * acceleration)
                .max(third.abs() * jerk);
        }
        greatest
    }

    /// At the end of a run: where the curve has turned back before a corner, if it has not come to the
    /// last piece of the path.
    pub fn behind(&self, path: &Path<N>) -> Option<Fault<N>> {
        let newest = self.cover.newest();
        if newest + 1 >= path.end() {
            return None;
        }
        let (u, here) = self.ahead.unwrap_or((self.u[2], value(&self.letters, 1.0)));
        path.piece(newest).map(|piece| nearer_to_corner(u, &here, piece, path))
    }

    /// Where the distance from the path exceeds the tolerance most, between the second and third of
    /// the last control points.
    fn off(&mut self, path: &Path<N>, depth: Depth) -> Option<Fault<N>> {
        let before = self.place;
        // The search goes as far as the curve cannot have gone.
        let end = path.nearest(&value(&self.letters, 1.0), before, self.places[3])?;
        if end.place > self.place {
            self.place = end.place;
        }
        let mut miss = None;
        if depth == Depth::Proof {
            miss = self.cover.follow(&bezier(&self.letters), self.place, path);
            if self.place.piece <= self.cover.newest() {
                self.ahead = None;
            } else if self.ahead.is_none() {
                self.ahead = Some((self.u[2], value(&self.letters, 1.0)));
            }
        }
        let greatest = Cell::new(0.0_f64);
        let measured = |phase: f64, tip: Option<(&Point<N>, f64)>| {
            let here = value(&self.letters, phase);
            let near = match phase {
                1.0 => end,
                _ => path.nearest(&here, before, end.place)?,
            };
            let piece = path.piece(near.place.piece)?;
            let square = path.off(&near.point, &here, piece);
            greatest.set(greatest.get().max(square));
            if tip.is_none() && square <= TOLERANCE_PART * TOLERANCE_PART {
                return None;
            }
            let mut excess = square.sqrt() / TOLERANCE_PART;
            if let Some((tip, reach)) = tip {
                excess = excess.max(path.off(tip, &here, piece).sqrt() / (TOLERANCE_PART * reach));
            }
            let u = self.u[1] + phase * (self.u[2] - self.u[1]);
            let from = tip.map_or(&near.point, |(tip, _)| tip);
            (excess > 1.0).then(|| Fault { u, excess, off: Some(from_to(from, &here)) })
        };
        let passes = |phase: f64, corner: &Corner| {
            path.nearest(&value(&self.letters, phase), before, end.place)
                .is_some_and(|near| near.place.piece > corner.piece)
        };
        // At a corner, the distance is greatest where both of its sides are equally near.
        let cut = path.sharpest(before, end.place).map(|corner| {
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..HALVINGS {
                let middle = (low + high) / 2.0;
                if passes(middle, &corner) { high = middle } else { low = middle }
            }
            // Between both sides, the distance grows in proportion to that from the corner.
            measured(high, path.piece(corner.piece).map(|piece| (&piece.end, corner.reach())))
        });
        let cut = cut.flatten().or_else(|| {
            // What the measured places do not show.
            let miss = miss?;
            let here = value(&self.letters, miss.phase);
            let near = path.nearest(&here, before, end.place)?;
            let piece = path.piece(miss.piece)?;
            let off = path.off(&near.point, &here, path.piece(near.place.piece)?).sqrt();
            let tip = path.off(&piece.end, &here, piece).sqrt() / MOST_REACH;
            let u = self.u[1] + miss.phase * (self.u[2] - self.u[1]);
            if off > TOLERANCE_PART || tip <= 1.0 {
                let excess = (off / TOLERANCE_PART).max(LEAST_EXCESS);
                return Some(Fault { u, excess, off: Some(from_to(&near.point, &here)) });
            }
            Some(nearer_to_corner(u, &here, piece, path))
        });
        let phases = PHASES.iter();
        let faults = phases.filter_map(|&phase| measured(phase, None)).chain(cut);
        let worst = faults.max_by(|a, b| a.excess.total_cmp(&b.excess));
        self.measured = greatest.get().sqrt();
        worst
    }
}

/// The curve has to go nearer to the corner at the end of a piece.
fn nearer_to_corner<const N: usize>(
    u: f64,
    here: &Point<N>,
    piece: &Piece<N>,
    path: &Path<N>,
) -> Fault<N> {
    let tip = (path.off(&piece.end, here, piece).sqrt() / MOST_REACH).max(LEAST_EXCESS);
    let away = from_to(&piece.end, here).map(|x| x / tip);
    Fault { u, excess: tip.min(MOST_EXCESS), off: Some(away) }
}

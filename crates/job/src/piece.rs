//! The geometry of one element: places, tangents and nearest points, by length.
//!
//! The length of a piece is Euclidean over all its letters (mm and degrees alike). It only
//! parametrises the piece; no limit is computed from it.

use crate::element::{Arc, Tolerance};
use crate::vector::{Point, dot, from_to, norm, plus};

/// The square of the slope from which a helix is compared by its height and not by its angle.
const STEEP: f64 = 0.5;
/// Steps of Newton's method on a helix.
const NEWTON: usize = 5;

/// The angle that is this one but for whole turns, at most half a turn.
fn wrapped(angle: f64) -> f64 {
    angle - std::f64::consts::TAU * (angle / std::f64::consts::TAU).round()
}

/// One element with its start.
#[derive(Debug, Clone)]
pub(crate) struct Piece<const N: usize> {
    pub start: Point<N>,
    pub end: Point<N>,
    pub length: f64,
    /// Greatest speed along the path; infinite for a rapid move.
    pub feed: f64,
    pub tolerance: Tolerance,
    pub line: u64,
    /// [`Element::block`](crate::Element::block), which the caller sets.
    pub block: u64,
    /// Only rotary letters move, so that the feed is theirs. The program decides it: where the end
    /// of a run is rounded to whole steps, the other letters move a little, too.
    pub turns_only: bool,
    /// Unit direction of a line; of an arc, the change per length of the letters off the plane.
    along: Point<N>,
    bend: Option<Bend>,
}

#[derive(Debug, Clone, Copy)]
struct Bend {
    plane: [usize; 2],
    centre: [f64; 2],
    radius: [f64; 2],
    from: f64,
    angle: f64,
}

impl<const N: usize> Piece<N> {
    pub fn new(
        start: Point<N>,
        end: Point<N>,
        arc: Option<Arc>,
        feed: f64,
        tolerance: Tolerance,
        line: u64,
        linear: usize,
    ) -> Self {
        let mut along = from_to(&start, &end);
        let bend = arc.map(|arc| {
            let [i, j] = arc.plane;
            let [a, b] = [&start, &end].map(|p| [p[i] - arc.centre[0], p[j] - arc.centre[1]]);
            along[i] = 0.0;
            along[j] = 0.0;
            Bend {
                plane: arc.plane,
                centre: arc.centre,
                radius: [a[0].hypot(a[1]), b[0].hypot(b[1])],
                from: a[1].atan2(a[0]),
                // The end may have been rounded to whole steps: the angle ends there, too.
                angle: arc.angle + wrapped(b[1].atan2(b[0]) - a[1].atan2(a[0]) - arc.angle),
            }
        });
        let turned = bend.map_or(0.0, |bend| {
            let mean = (bend.radius[0] + bend.radius[1]) / 2.0;
            (mean * bend.angle).hypot(bend.radius[1] - bend.radius[0])
        });
        let length = norm(&along).hypot(turned);
        let along = along.map(|x| if length > 0.0 { x / length } else { 0.0 });
        let turns_only = bend.is_none() && along[..linear].iter().all(|&x| x == 0.0);
        Self { start, end, length, feed, tolerance, line, block: 0, turns_only, along, bend }
    }

    /// Part `number` of `count` equal parts of a piece that was made with this arc.
    pub fn part(&self, arc: Option<Arc>, number: u64, count: u64, linear: usize) -> Self {
        if count <= 1 {
            return self.clone();
        }
        let place = |n: u64| match n {
            0 => self.start,
            n if n == count => self.end,
            n => self.at(self.length * (n as f64 / count as f64)),
        };
        let arc = arc.map(|arc| Arc { angle: arc.angle / count as f64, ..arc });
        let (start, end) = (place(number), place(number + 1));
        let part = Self::new(start, end, arc, self.feed, self.tolerance, self.line, linear);
        Self { turns_only: self.turns_only, block: self.block, ..part }
    }

    /// The point at length `s`.
    pub fn at(&self, s: f64) -> Point<N> {
        let mut point = plus(&self.start, s, &self.along);
        if let Some(bend) = &self.bend {
            let part = s / self.length;
            let (sin, cos) = (bend.from + part * bend.angle).sin_cos();
            let radius = bend.radius[0] + part * (bend.radius[1] - bend.radius[0]);
            point[bend.plane[0]] = bend.centre[0] + radius * cos;
            point[bend.plane[1]] = bend.centre[1] + radius * sin;
        }
        point
    }

    /// The change of the point per length at length `s`.
    pub fn tangent(&self, s: f64) -> Point<N> {
        let mut tangent = self.along;
        if let Some(bend) = &self.bend {
            let part = s / self.length;
            let (sin, cos) = (bend.from + part * bend.angle).sin_cos();
            let grow = (bend.radius[1] - bend.radius[0]) / self.length;
            let turn = (bend.radius[0] + part * (bend.radius[1] - bend.radius[0])) * bend.angle
                / self.length;
            tangent[bend.plane[0]] = grow * cos - turn * sin;
            tangent[bend.plane[1]] = grow * sin + turn * cos;
        }
        tangent
    }

    /// The smaller radius of an arc.
    pub fn radius(&self) -> Option<f64> {
        self.bend.map(|bend| bend.radius[0].min(bend.radius[1]))
    }

    /// Bounds on the second and third derivative of the point by length.
    pub fn bends(&self) -> [f64; 2] {
        let Some(bend) = &self.bend else { return [0.0; 2] };
        let turn = bend.angle.abs() / self.length;
        let grow = (bend.radius[1] - bend.radius[0]).abs() / self.length;
        let round = turn * bend.radius[0].max(bend.radius[1]);
        [turn * (2.0 * grow + round), turn * turn * (3.0 * grow + round)]
    }

    /// How far a part of this length may be from its chord, at most.
    pub fn bow(&self, length: f64) -> f64 {
        self.bends()[0] * length * length / 8.0
    }

    /// The length from `from` to `to` whose point is nearest to `point`, a point near the piece.
    pub fn nearest(&self, point: &Point<N>, from: f64, to: f64) -> f64 {
        self.nearest_around(point, from, (from, to))
    }

    /// The same; on an arc, it is the one in the turn around length `here`.
    pub fn nearest_around(&self, point: &Point<N>, here: f64, (from, to): (f64, f64)) -> f64 {
        let low = from.min(self.length);
        let high = to.min(self.length).max(low);
        let rise = dot(&self.along, &self.along);
        let Some(bend) = &self.bend else {
            return dot(&from_to(&self.start, point), &self.along).clamp(low, high);
        };
        let [i, j] = bend.plane;
        let mut s = if rise > STEEP {
            dot(&from_to(&self.start, point), &self.along) / rise
        } else {
            let angle = (point[j] - bend.centre[1]).atan2(point[i] - bend.centre[0]);
            // The angle nearest to that at `here`, counted in the direction of the arc.
            let here = here / self.length * bend.angle.abs();
            let turn = std::f64::consts::TAU;
            let raw = (angle - bend.from) * bend.angle.signum() - here;
            (here + raw - turn * (raw / turn).round()) / bend.angle.abs() * self.length
        };
        if rise > 0.0 {
            // On a helix neither is the nearest place; Gauss and Newton's method finds it.
            for _ in 0..NEWTON {
                s = s.clamp(low, high);
                let tangent = self.tangent(s);
                s += dot(&from_to(&self.at(s), point), &tangent) / dot(&tangent, &tangent);
            }
        }
        s.clamp(low, high)
    }
}

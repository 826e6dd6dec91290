//! Proves that the emitted curve stays within the tolerance of the path, in order along the path.
//!
//! The curve between two knots is a cubic, and lies in the convex hull of its four Bezier points.
//! What is within the tolerance of a line is convex, too: if the four points are within it, the
//! whole cubic is. An arc deviates from its chord by at most its second derivative times the square
//! of the length over 8. Where no single piece covers the cubic, a chain of pieces may, by the
//! triangle inequality; otherwise the cubic is halved.
//!
//! The curve may be on several pieces at once, as near a corner. It goes on to a later piece at a
//! place within the tolerance of both, if it is near all corners between them.

use crate::path::{MOST_REACH, Path, Place};
use crate::piece::Piece;
use crate::vector::{Point, dot, from_to, plus};

/// Part of the tolerance that the proof uses; the rest is for rounding to integers, and for those who
/// measure the curve and arcs of the path by chords.
pub(crate) const FULL: f64 = 0.999;
/// Length of a rest of a piece that is none, mm.
const NOTHING: f64 = 1e-9;
/// How often a cubic is halved.
const HALVINGS: u32 = 14;
/// Length of the parts near a corner, as a part of the tolerance.
const FINE: f64 = 0.2;

/// A piece on which the curve may be.
#[derive(Debug, Clone, Copy)]
struct On {
    number: u64,
    /// The place that the curve has passed at least, as a length along the piece: it cannot be matched
    /// with a place before this one.
    passed: f64,
}

/// The pieces on which the curve may be at one place, in order.
#[derive(Debug, Clone, Default)]
pub(crate) struct Cover {
    on: Vec<On>,
    /// The nearest place.
    place: Place,
}

/// Where the proof fails, as a part of the cubic.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Miss {
    pub phase: f64,
    /// The piece that the curve has left too early, or from too far.
    pub piece: u64,
}

impl Cover {
    /// The curve is at a place of the path.
    pub fn at(place: Place) -> Self {
        Self { on: vec![On { number: place.piece, passed: place.along }], place }
    }

    /// The first piece on which the curve may be.
    pub fn oldest(&self) -> u64 {
        self.on.first().map_or(self.place.piece, |on| self.place.piece.min(on.number))
    }

    /// The last piece on which the curve may be.
    pub fn newest(&self) -> u64 {
        self.on.last().map_or(self.place.piece, |on| on.number)
    }

    /// A place of the last piece on which the curve, at rest at a point, may be; where that piece
    /// ends there, the start of the next one.
    pub fn leaving<const N: usize>(&self, point: &Point<N>, path: &Path<N>) -> Place {
        let (number, here) = self
            .on
            .last()
            .map_or((self.place.piece, self.place.along), |on| (on.number, on.passed));
        let Some(piece) = path.piece(number) else { return self.place };
        let along = near(point, here, piece, path).0;
        if piece.length - along < NOTHING && number + 1 < path.end() {
            Place { piece: number + 1, along: 0.0 }
        } else {
            Place { piece: number, along }
        }
    }

    /// The curve goes on along a cubic with these Bezier points, whose end is nearest to a place.
    /// After a miss the curve is taken to be on the pieces around that place.
    pub fn follow<const N: usize>(
        &mut self,
        cubic: &[Point<N>; 4],
        end: Place,
        path: &Path<N>,
    ) -> Option<Miss> {
        let result = self.part(cubic, end, path, (0.0, 1.0), HALVINGS);
        if result.is_some() {
            self.on = vec![On { number: end.piece, passed: end.along }];
        }
        self.place = end;
        result
    }

    fn part<const N: usize>(
        &mut self,
        cubic: &[Point<N>; 4],
        end: Place,
        path: &Path<N>,
        (from, to): (f64, f64),
        left: u32,
    ) -> Option<Miss> {
        if let [only] = self.on[..]
            && covers(cubic, only, path)
            && !self.near_corner(cubic, path)
        {
            // By far the most frequent case.
            self.place = end;
            return self.enter(&cubic[3], to, path);
        }
        let kept: Vec<On> = self.on.iter().copied().filter(|&on| covers(cubic, on, path)).collect();
        let corner = self.near_corner(cubic, path);
        let chain = corner && self.chain(cubic, end, path);
        if chain || (!kept.is_empty() && !corner) {
            self.on = kept;
            if chain && self.on.last().is_none_or(|last| last.number < end.piece) {
                let piece = path.piece(end.piece)?;
                let off = relative(&from_to(&piece.at(end.along), &cubic[3]), piece, path);
                let passed = (end.along - behind(end.along, off, piece, path)).max(0.0);
                self.on.push(On { number: end.piece, passed });
            }
            let miss = self.enter(&cubic[3], to, path);
            self.place = end;
            return miss;
        }
        if left == 0 {
            return Some(Miss { phase: from, piece: self.on.last()?.number });
        }
        let [first, second] = halves(cubic);
        let middle = path.nearest(&first[3], self.place, end).map_or(end, |near| near.place);
        let half = (from + to) / 2.0;
        self.part(&first, middle, path, (from, half), left - 1)
            .or_else(|| self.part(&second, end, path, (half, to), left - 1))
    }

    /// Whether the curve may go on to another piece near a cubic that is too long to tell where.
    fn near_corner<const N: usize>(&self, cubic: &[Point<N>; 4], path: &Path<N>) -> bool {
        let Some(on) = self.on.last().and_then(|on| path.piece(on.number)) else { return false };
        let size = cubic[1..].iter().map(|b| relative(&from_to(&cubic[0], b), on, path));
        let size = size.fold(0.0, f64::max);
        size > FINE
            && self.on.iter().any(|&On { number, .. }| {
                number + 1 < path.end()
                    && path.piece(number).is_some_and(|piece| {
                        let off = relative(&from_to(&piece.end, &cubic[0]), piece, path);
                        off <= MOST_REACH + size
                    })
            })
    }

    /// Whether a part of the path, from the nearest place at the start of a cubic to that at its
    /// end, is near the cubic as a whole.
    fn chain<const N: usize>(&self, cubic: &[Point<N>; 4], end: Place, path: &Path<N>) -> bool {
        let start = self.place;
        if !self.on.iter().any(|on| on.number == start.piece) {
            return false;
        }
        let (Some(first), Some(last)) = (path.at(start), path.at(end)) else { return false };
        let chord = from_to(&first.point, &last.point);
        let square = dot(&chord, &chord);
        let bent = |k: usize, b: &Point<N>| {
            let part = k as f64 / 3.0;
            from_to(&plus(&cubic[0], part, &from_to(&cubic[0], &cubic[3])), b)
        };
        // How far the pieces are from the chord of their part of the path.
        let (mut reached, mut before) = (0.0_f64, [0.0; N]);
        for number in start.piece..=end.piece {
            let Some(piece) = path.piece(number) else { return false };
            let norm = |d: &Point<N>| relative(d, piece, path);
            let begin = if number == start.piece { start.along } else { 0.0 };
            let upto = if number == end.piece { end.along } else { piece.length };
            let bow = piece.bow(upto - begin) / piece.tolerance.linear;
            let ends =
                norm(&from_to(&first.point, &cubic[0])).max(norm(&from_to(&last.point, &cubic[3])));
            let curved = norm(&bent(1, &cubic[1])).max(norm(&bent(2, &cubic[2])));
            let mut after = [0.0; N];
            if number < end.piece {
                let part = dot(&from_to(&first.point, &piece.end), &chord) / square;
                if !(reached..=1.0).contains(&part) {
                    return false;
                }
                reached = part;
                after = from_to(&plus(&first.point, part, &chord), &piece.end);
            }
            if ends + curved + norm(&before).max(norm(&after)) + bow > FULL {
                return false;
            }
            before = after;
        }
        true
    }

    /// The curve is at a point, `phase` of the cubic: from the pieces on which it is, it may go on to
    /// later ones. Where it comes back, it has left the piece on which it came.
    fn enter<const N: usize>(
        &mut self,
        point: &Point<N>,
        phase: f64,
        path: &Path<N>,
    ) -> Option<Miss> {
        let (first, last) = (self.on.first()?.number, self.on.last()?.number);
        // What is left of a line is near a point where its ends are; an arc may bend away between them.
        let leaves = |piece: &Piece<N>, along: f64| {
            let bow = piece.bow(piece.length - along) / piece.tolerance.linear;
            let far = |at: &Point<N>| relative(&from_to(at, point), piece, path);
            let begin = if bow > 0.0 { far(&piece.at(along)) } else { 0.0 };
            far(&piece.end).max(begin) + bow <= MOST_REACH * FULL
        };
        let (mut bridge, mut now) = (false, Vec::with_capacity(self.on.len() + 1));
        let mut before = self.on.iter().peekable();
        for number in first..path.end() {
            if number > last && !bridge {
                break;
            }
            let piece = path.piece(number)?;
            let was = before.next_if(|on| on.number == number);
            let here = was.map_or(0.0, |was| was.passed);
            let (along, off) = near(point, here, piece, path);
            let least = along - behind(along, off, piece, path);
            let is = match was {
                Some(was) if least > was.passed => Some(On { number, passed: least }),
                Some(was) if along >= was.passed => Some(*was),
                // It has come back, as far as the tolerance allows.
                Some(was) => {
                    let back = from_to(&piece.at(was.passed), point);
                    (relative(&back, piece, path) <= FULL).then_some(*was)
                }
                None if bridge && off <= FULL => Some(On { number, passed: least.max(0.0) }),
                None => None,
            };
            now.extend(is);
            let left = if is.is_some() { along } else { 0.0 };
            bridge = (bridge || is.is_some()) && leaves(piece, left);
        }
        if now.is_empty() {
            return Some(Miss { phase, piece: last });
        }
        self.on = now;
        None
    }
}

/// Where a piece is nearest to a point, as a length along it, and how far away, as a part of the
/// tolerance. On an arc of more than a turn it is in the turn around `here`.
fn near<const N: usize>(
    point: &Point<N>,
    here: f64,
    piece: &Piece<N>,
    path: &Path<N>,
) -> (f64, f64) {
    let along = piece.nearest_around(point, here, (0.0, f64::INFINITY));
    (along, relative(&from_to(&piece.at(along), point), piece, path))
}

/// How far behind the nearest place, as a length along the piece, the piece is within the tolerance of
/// a point at least. The point is `off` from that place, as a part of the tolerance.
fn behind<const N: usize>(along: f64, off: f64, piece: &Piece<N>, path: &Path<N>) -> f64 {
    let left = (FULL - off).max(0.0);
    let tolerance = piece.tolerance;
    if path.linear < N {
        left * tolerance.linear.min(tolerance.rotary)
    } else if piece.radius().is_some() || along >= piece.length {
        left * tolerance.linear
    } else {
        // The point is straight beside the line.
        (left * (FULL + off)).sqrt() * tolerance.linear
    }
}

/// Whether one piece is within the tolerance of a whole cubic.
fn covers<const N: usize>(cubic: &[Point<N>; 4], on: On, path: &Path<N>) -> bool {
    let Some(piece) = path.piece(on.number) else { return false };
    let (mut low, mut high, mut off) = (f64::INFINITY, 0.0_f64, 0.0_f64);
    for point in cubic {
        let (along, away) = near(point, on.passed, piece, path);
        if away > FULL {
            return false;
        }
        (low, high, off) = (low.min(along), high.max(along), off.max(away));
    }
    off + piece.bow(high - low) / piece.tolerance.linear <= FULL
}

/// A difference as a part of the tolerance of a piece.
fn relative<const N: usize>(d: &Point<N>, piece: &Piece<N>, path: &Path<N>) -> f64 {
    path.off(&[0.0; N], d, piece).sqrt()
}

/// Both halves of a cubic (P. de Casteljau, 1959).
fn halves<const N: usize>(b: &[Point<N>; 4]) -> [[Point<N>; 4]; 2] {
    let mean =
        |p: &Point<N>, q: &Point<N>| -> Point<N> { std::array::from_fn(|i| (p[i] + q[i]) / 2.0) };
    let [p, q, r] = [mean(&b[0], &b[1]), mean(&b[1], &b[2]), mean(&b[2], &b[3])];
    let [s, t] = [mean(&p, &q), mean(&q, &r)];
    let middle = mean(&s, &t);
    [[b[0], p, s, middle], [middle, t, r, b[3]]]
}

/// The Bezier points of a uniform cubic spline between the second and third of four control points.
pub(crate) fn bezier<const N: usize>(c: &[Point<N>; 4]) -> [Point<N>; 4] {
    std::array::from_fn(|k| {
        std::array::from_fn(|i| {
            let [a, b, d, e] = [c[0][i], c[1][i], c[2][i], c[3][i]];
            match k {
                0 => (a + 4.0 * b + d) / 6.0,
                1 => (2.0 * b + d) / 3.0,
                2 => (b + 2.0 * d) / 3.0,
                _ => (b + 4.0 * d + e) / 6.0,
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{Arc, Tolerance};
    use std::f64::consts::TAU;

    /// Length of a stroke, in tolerances.
    const STROKE: f64 = 10.0;
    /// Number of strokes.
    const STROKES: u64 = 40;
    /// Cubics in a stroke.
    const PARTS: u64 = 20;

    /// Follows the path to and fro, as far as `reach` of a stroke; the greatest number of pieces on
    /// which the curve may be.
    fn followed(path: &Path<1>, reach: impl Fn(u64) -> f64) -> Result<usize, Miss> {
        let mut cover = Cover::at(Place::default());
        let (mut most, mut at) = (0, 0.0);
        for number in 0..STROKES {
            for part in 1..=PARTS {
                let along = part as f64 / PARTS as f64 * STROKE;
                let to = if number % 2 == 0 { along } else { STROKE - along };
                let to = to.min(reach(number) * STROKE);
                let cubic = std::array::from_fn(|k| [at + k as f64 / 3.0 * (to - at)]);
                at = to;
                cover.follow(&cubic, Place { piece: number, along }, path).map_or(Ok(()), Err)?;
                most = most.max(cover.on.len());
            }
            assert!(cover.oldest() + 1 >= number, "{:?}", (number, &cover));
        }
        Ok(most)
    }

    #[test]
    fn curve_that_comes_back_has_left_the_piece_on_which_it_came() {
        let mut path = Path::new(1);
        let tolerance = Tolerance { linear: 1.0, rotary: 1.0 };
        for number in 0..STROKES {
            let [from, to] = if number % 2 == 0 { [0.0, STROKE] } else { [STROKE, 0.0] };
            path.push(Piece::new([from], [to], None, 1.0, tolerance, number, 1));
        }
        let most = followed(&path, |_| 1.0);
        assert!(most.as_ref().is_ok_and(|most| *most <= 3), "{most:?}");
        assert!(followed(&path, |_| 0.95).is_ok());
        // It turns long before the corner.
        assert!(followed(&path, |number| if number < 20 { 1.0 } else { 0.5 }).is_err());
    }

    #[test]
    fn curve_may_not_skip_an_arc_whose_ends_are_near() {
        let tolerance = Tolerance { linear: 1.0, rotary: 1.0 };
        for radius in [0.1, 1.5, 5.0] {
            let mut path = Path::new(2);
            let circle = Arc { plane: [0, 1], centre: [STROKE, radius], angle: TAU };
            let places = [[0.0, 0.0], [STROKE, 0.0], [STROKE, 0.0], [2.0 * STROKE, 0.0]];
            for (number, arc) in [None, Some(circle), None].into_iter().enumerate() {
                let [from, to] = [places[number], places[number + 1]];
                path.push(Piece::new(from, to, arc, 1.0, tolerance, number as u64, 2));
            }
            let mut cover = Cover::at(Place::default());
            let miss = (1..=2 * PARTS).find_map(|part| {
                let x = part as f64 / PARTS as f64 * STROKE;
                let before = x - STROKE / PARTS as f64;
                let cubic = std::array::from_fn(|k| [before + k as f64 / 3.0 * (x - before), 0.0]);
                let (piece, along) = if part <= PARTS { (0, x) } else { (2, x - STROKE) };
                cover.follow(&cubic, Place { piece, along }, &path)
            });
            assert_eq!(miss.is_none(), radius < 1.0, "{radius}: {miss:?}");
        }
    }
}

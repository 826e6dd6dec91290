//! The exact stop: a motion from a place of rest near a piece to the end of that piece, at rest.
//!
//! Where no faster motion keeps limits and tolerance, this one does, by construction. It goes along
//! the piece, and what it is off the piece decreases to nothing. Its law over time is the polynomial
//! s(t) = 10 t^3 - 15 t^4 + 6 t^5 of N. Hogan (1984), whose first three derivatives are at most
//! 1.875, 5.774 and 60. Its samples are control points: their differences are never greater than the
//! derivatives, and the curve is off the samples by at most 1/6 of the acceleration across the path
//! times the square of the knot time.

use crate::limits::Motors;
use crate::path::{Path, Place};
use crate::rough::Knot;
use crate::vector::{Point, from_to, norm, plus};

/// Greatest derivatives of the law.
const LAW: [f64; 3] = [1.875, 5.774, 60.0];
/// Part of the limits that is used.
const PART: f64 = 0.98;
/// By what the time is multiplied until the limits are kept.
const SLOWER: f64 = 1.02;
/// Fewest knots of a motion.
const LEAST: f64 = 8.0;

/// The control points from rest at `from`, near a place of the path, to the end of its piece.
pub(crate) fn halt<const N: usize>(
    from: &Point<N>,
    place: Place,
    path: &Path<N>,
    motors: &Motors<N>,
    knot_seconds: f64,
) -> Vec<Knot<N>> {
    let Some(piece) = path.piece(place.piece) else { return Vec::new() };
    let off = from_to(&piece.at(place.along), from);
    let left = piece.length - place.along;
    let all = left + norm(&off);
    let way = from_to(from, &piece.end);
    let bends = piece.bends();
    let straight = motors.of(&way);
    // For each motor: how far it goes, and how far it would go along the bent path.
    let ways: Vec<[f64; 2]> = (0..N)
        .map(|i| {
            let gain: f64 = motors.matrix[i].iter().map(|x| x.abs()).sum();
            if bends[0] > 0.0 { [gain * all, gain] } else { [straight[i].abs(), 0.0] }
        })
        .collect();
    let length = |d: &[f64]| d.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (linear, rotary) = way.split_at(path.linear);
    let fed = match (bends[0] > 0.0, piece.turns_only) {
        (true, _) => all,
        (false, true) => length(rotary),
        (false, false) => length(linear),
    };
    let [v, a, j] = LAW;
    let keeps = |t: f64| {
        let [v, a, j] = [v / t, a / (t * t), j / (t * t * t)];
        let across = bends[0] * left * left * v * v;
        let third = 3.0 * bends[0] * left * left * v * a + bends[1] * left.powi(3) * v.powi(3);
        fed * v <= piece.feed * PART
            && across * knot_seconds * knot_seconds <= piece.tolerance.linear / 2.0
            && motors.limits.iter().zip(&ways).all(|(limit, [way, gain])| {
                way * v <= limit.speed * PART
                    && way * a + gain * across <= limit.acceleration * PART
                    && way * j + gain * third <= limit.jerk * PART
            })
    };
    let mut seconds = LEAST * knot_seconds;
    while !keeps(seconds) && seconds.is_finite() {
        seconds *= SLOWER;
    }
    let count = (seconds / knot_seconds).ceil();
    (1..=count as u64)
        .map(|k| {
            let t = k as f64 / count;
            let part = t * t * t * (10.0 + t * (6.0 * t - 15.0));
            let along = (place.along + left * part).min(piece.length);
            let point = plus(&piece.at(along), 1.0 - part, &off);
            let point = if k as f64 >= count { piece.end } else { point };
            Knot { point, place: Place { piece: place.piece, along } }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{Arc, Tolerance};
    use crate::limits::Limit;
    use crate::piece::Piece;

    const LIMIT: Limit = Limit { speed: 100.0, acceleration: 1000.0, jerk: 250_000.0 };
    const KNOT: f64 = 0.004;

    /// The greatest speed, acceleration and jerk as parts of their limits.
    fn peaks(piece: Piece<2>, from: Point<2>) -> [f64; 3] {
        let motors = Motors { limits: [LIMIT; 2], matrix: [[1.0, 0.0], [0.0, 1.0]] };
        let mut path = Path::new(2);
        let end = piece.end;
        path.push(piece);
        let knots = halt(&from, Place { piece: 0, along: 0.0 }, &path, &motors, KNOT);
        let mut points = vec![from; 4];
        points.extend(knots.iter().map(|knot| knot.point));
        points.extend([end; 4]);
        assert_eq!(knots.last().unwrap().point, end);
        let mut peaks = [0.0_f64; 3];
        for c in points.windows(4) {
            for (((a, b), d), e) in c[0].iter().zip(&c[1]).zip(&c[2]).zip(&c[3]) {
                let parts = [
                    (e - d) / (LIMIT.speed * KNOT),
                    (e - 2.0 * d + b) / (LIMIT.acceleration * KNOT.powi(2)),
                    (e - 3.0 * d + 3.0 * b - a) / (LIMIT.jerk * KNOT.powi(3)),
                ];
                for (peak, part) in peaks.iter_mut().zip(parts) {
                    *peak = peak.max(part.abs());
                }
            }
        }
        peaks
    }

    #[test]
    fn exact_stop_keeps_all_limits_and_uses_them() {
        let tolerance = Tolerance { linear: 0.01, rotary: 0.01 };
        let line = |to: Point<2>| Piece::new([0.0; 2], to, None, f64::INFINITY, tolerance, 1, 2);
        for length in [1e-6, 0.01, 0.3, 3.0, 30.0, 300.0] {
            let found = peaks(line([length, -0.3 * length]), [0.004, 0.005]);
            assert!(found.iter().all(|part| *part <= 1.0), "{length}: {found:?}");
            let used = found.iter().copied().fold(0.0, f64::max);
            assert!(length < 1.0 || used > 0.9, "{length}: {found:?}");
            let arc = Arc { plane: [0, 1], centre: [0.0, length], angle: 2.0 };
            let (sin, cos) = 2_f64.sin_cos();
            let end = [length * sin, length - length * cos];
            let bent = Piece::new([0.0; 2], end, Some(arc), 1e9, tolerance, 1, 2);
            let found = peaks(bent, [0.0, 0.005]);
            assert!(found.iter().all(|part| *part <= 1.0), "arc {length}: {found:?}");
        }
    }
}

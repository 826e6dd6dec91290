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
const SLOWER: f64 = 1.1;
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

//! The first law of motion: how fast to pass each piece and each corner of the programmed path, as
//! if corners took no time.
//!
//! Its only purpose is to spread knots over the path, one every knot time, dense where the tool has
//! to be slow. No limit depends on it. Corners are judged by the rule of Grbl (S. Jeon, 2011):
//! v^2 = a d s / (1 - s), with d the tolerance and s the sine of half the angle between the lines.

use crate::limits::Motors;
use crate::path::Place;
use crate::piece::Piece;
use crate::vector::{Point, dot, from_to, norm};
use std::collections::VecDeque;

/// Most pieces that are looked at together. Where more are needed to stop, the tool is slower.
const MOST_PIECES: usize = 4096;

/// A knot: where the tool is to be at a multiple of the knot time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Knot<const N: usize> {
    pub point: Point<N>,
    pub place: Place,
}

#[derive(Debug)]
struct Leg<const N: usize> {
    number: u64,
    piece: Piece<N>,
    /// Greatest speed along it.
    speed: f64,
    acceleration: f64,
    /// Greatest speed at its start, squared, that the corner allows.
    corner: f64,
    /// The same from which the tool can still stop.
    entry: f64,
}

#[derive(Debug)]
pub(crate) struct Rough<const N: usize> {
    motors: Motors<N>,
    /// Number of linear letters.
    linear: usize,
    knot_seconds: f64,
    /// Greatest acceleration across the path for each mm of tolerance, 1/s^2: infinite where
    /// smoothing takes the filter into account.
    across: f64,
    legs: VecDeque<Leg<N>>,
    /// Speed at the start of the first leg, squared.
    speed2: f64,
    /// Seconds from the start of the first leg to the next knot.
    next: f64,
}

impl<const N: usize> Rough<N> {
    pub fn new(motors: Motors<N>, linear: usize, knot_seconds: f64, across: f64) -> Self {
        Self { motors, linear, knot_seconds, across, legs: VecDeque::new(), speed2: 0.0, next: 0.0 }
    }

    /// Adds the next piece; gives the knots that are certain.
    pub fn push(&mut self, number: u64, piece: &Piece<N>, out: &mut Vec<Knot<N>>) {
        let tangent = piece.tangent(0.0);
        let (mut speed, mut acceleration) = (piece.feed, f64::INFINITY);
        if let Some(radius) = piece.radius() {
            let plane = piece.tangent(piece.length / 2.0);
            for (i, limit) in self.motors.limits.iter().enumerate() {
                let moves = (0..N).any(|k| {
                    self.motors.matrix[i][k] != 0.0 && (tangent[k] != 0.0 || plane[k] != 0.0)
                });
                if moves {
                    speed = speed.min(limit.speed);
                    acceleration = acceleration.min(limit.acceleration);
                }
            }
            let across = acceleration.min(self.across * piece.tolerance.linear);
            speed = speed.min((across * radius).sqrt());
            acceleration *= 0.7;
        } else {
            speed = speed.min(self.motors.greatest(&tangent, |limit| limit.speed));
            acceleration = self.motors.greatest(&tangent, |limit| limit.acceleration);
        }
        let corner = self.legs.back().map_or(0.0, |last| {
            let least = speed.min(last.speed);
            self.corner(&last.piece, piece).min(least * least)
        });
        self.legs.push_back(Leg {
            number,
            piece: piece.clone(),
            speed,
            acceleration,
            corner,
            entry: 0.0,
        });
        if self.legs.len() >= MOST_PIECES {
            self.advance(MOST_PIECES / 2, out);
        }
    }

    /// The run ends here, at rest.
    pub fn finish(&mut self, out: &mut Vec<Knot<N>>) {
        self.advance(self.legs.len(), out);
        self.speed2 = 0.0;
        self.next = 0.0;
    }

    /// The square of the speed at a corner.
    fn corner(&self, before: &Piece<N>, after: &Piece<N>) -> f64 {
        let [a, b] = [before.tangent(before.length), after.tangent(0.0)].map(|t| {
            let length = norm(&t);
            t.map(|x| x / length)
        });
        let turn = from_to(&a, &b);
        let size = norm(&turn);
        if size < 1e-9 {
            return f64::INFINITY;
        }
        let acceleration =
            self.motors.greatest(&turn.map(|x| x / size), |limit| limit.acceleration);
        let sine = ((1.0 - -dot(&a, &b)) / 2.0).max(0.0).sqrt();
        let toward = |piece: &Piece<N>| piece.tolerance.toward(&turn, self.linear);
        let distance = toward(before).min(toward(after));
        // A long filter spreads a jump of the speed over its length: the curve then cuts the corner
        // by about the jump times a quarter of that length.
        let jump = distance * self.across.sqrt();
        let long = if jump.is_finite() { (jump / size).powi(2) } else { f64::INFINITY };
        (acceleration * distance * sine / (1.0 - sine).max(1e-12)).min(long)
    }

    /// Plans all legs to a rest at their end, and leaves `count` of them.
    fn advance(&mut self, count: usize, out: &mut Vec<Knot<N>>) {
        let mut exit = 0.0;
        for leg in self.legs.iter_mut().rev() {
            leg.entry = f64::min(leg.corner, exit + 2.0 * leg.acceleration * leg.piece.length);
            exit = leg.entry;
        }
        for _ in 0..count {
            let Some(leg) = self.legs.pop_front() else { return };
            let exit = self.legs.front().map_or(0.0, |next| next.entry);
            let (length, a) = (leg.piece.length, leg.acceleration);
            let exit = exit.min(self.speed2 + 2.0 * a * length);
            let top = (a * length + (self.speed2 + exit) / 2.0)
                .min(leg.speed * leg.speed)
                .max(self.speed2.max(exit));
            let [v0, v1, v] = [self.speed2, exit, top].map(f64::sqrt);
            let (up, down) = ((v - v0) / a, (v - v1) / a);
            let flat = (length - (2.0 * top - self.speed2 - exit) / (2.0 * a)).max(0.0) / v;
            let total = up + flat + down;
            while self.next < total {
                let t = self.next;
                let along = if t < up {
                    t * (v0 + a * t / 2.0)
                } else if t < up + flat {
                    (top - self.speed2) / (2.0 * a) + (t - up) * v
                } else {
                    let left = total - t;
                    length - left * (v1 + a * left / 2.0)
                };
                let along = along.clamp(0.0, length);
                out.push(Knot {
                    point: leg.piece.at(along),
                    place: Place { piece: leg.number, along },
                });
                self.next += self.knot_seconds;
            }
            self.next -= total;
            self.speed2 = exit;
        }
    }
}

//! The chain of planning in floats, from pieces to the control points of the emitted curve:
//! a first law, then smoothing and speed law in turns, then the law whose motion is known to be
//! good.

use crate::emitted::Emitted;
use crate::limits::Motors;
use crate::path::{Path, Place};
use crate::piece::Piece;
use crate::retime::Retime;
use crate::rhythm::Rhythm;
use crate::rough::{Knot, Rough};
use crate::settle::Settle;
use crate::smooth::{RESTING, Smooth};
use crate::speed::Rules;
use crate::vector::Point;

/// How often the path is smoothed.
const ROUNDS: usize = 3;
/// Part of the tolerance for smoothing; the rest is for what the last speed law changes.
const PART: f64 = 0.92;
/// The same where the filter is longer than smoothing takes into account.
const PART_OF_LONG_FILTERS: f64 = 0.5;
/// Longest filter, in knots, that smoothing takes into account.
const SHORT_FILTER: usize = 2;
/// Part of the tolerance that a longer filter may take.
const FILTER_PART: f64 = 0.4;
/// Part of the acceleration limits that the speed law uses.
const LIMIT_PART: f64 = 0.9995;

/// The runs of a job, each from rest to rest.
#[derive(Debug)]
pub(crate) struct Runs<const N: usize> {
    path: Path<N>,
    rough: Rough<N>,
    smooth: Vec<Smooth<N>>,
    retime: Vec<Retime<N>>,
    settle: Settle<N>,
    /// Where the last piece ends.
    end: Point<N>,
    started: bool,
}

impl<const N: usize> Runs<N> {
    pub fn new(motors: &Motors<N>, rhythm: &Rhythm, linear: usize, start: Point<N>) -> Self {
        let long = rhythm.average > SHORT_FILTER;
        let accelerations: [f64; N] = std::array::from_fn(|i| motors.letter_acceleration(i));
        let greatest = accelerations.iter().copied().fold(0.0, f64::max);
        let weights = accelerations.map(|a| (greatest / a) * (greatest / a));
        let part = if long { PART_OF_LONG_FILTERS } else { PART };
        let average = rhythm.average.min(SHORT_FILTER);
        let stopping = motors.limits.iter().map(|l| l.speed / l.acceleration).fold(0.0, f64::max);
        let ahead = (1.5 * stopping / rhythm.seconds).clamp(48.0, 1008.0) as usize + 16;
        // A filter that smoothing does not take into account moves the curve by half of the
        // acceleration times its spread.
        let across = if long { 2.0 * FILTER_PART / rhythm.spread() } else { f64::INFINITY };
        let rules = Rules {
            motors: motors.clone(),
            knot_seconds: rhythm.seconds,
            part: LIMIT_PART,
            across,
        };
        let smooth = |round| Smooth::new(weights, part, average, round > 0);
        Self {
            path: Path::new(linear),
            rough: Rough::new(motors.clone(), linear, rhythm.seconds, across),
            smooth: (0..ROUNDS).map(smooth).collect(),
            retime: (1..ROUNDS).map(|_| Retime::new(rules.clone(), ahead)).collect(),
            settle: Settle::new(rules, ahead, rhythm.average),
            end: start,
            started: false,
        }
    }

    /// The place where the path ends so far.
    pub fn end(&self) -> &Point<N> {
        &self.end
    }

    /// The number of the next piece.
    pub fn next_piece(&self) -> u64 {
        self.path.end()
    }

    /// Whether anything has moved since the last rest.
    pub fn moving(&self) -> bool {
        self.started
    }

    /// Adds a piece that begins where the one before ends.
    pub fn push(&mut self, piece: Piece<N>, out: &mut Vec<Emitted<N>>) {
        let number = self.path.end();
        let mut knots = Vec::new();
        if !self.started {
            let place = Place { piece: number, along: 0.0 };
            knots = vec![Knot { point: piece.start, place }; RESTING - 1];
            self.started = true;
            self.path.forget_before(number);
        }
        self.rough.push(number, &piece, &mut knots);
        self.end = piece.end;
        self.path.push(piece);
        self.pass(knots, out);
    }

    /// The run ends at rest where the last piece ends.
    pub fn rest(&mut self, out: &mut Vec<Emitted<N>>) {
        if !self.started {
            return;
        }
        let mut knots = Vec::new();
        self.rough.finish(&mut knots);
        let piece = self.path.end().saturating_sub(1);
        let along = self.path.piece(piece).map_or(0.0, |piece| piece.length);
        knots.extend([Knot { point: self.end, place: Place { piece, along } }; RESTING]);
        for round in 0..ROUNDS {
            let mut smooth = Vec::new();
            for knot in knots.drain(..) {
                self.smooth[round].push(knot, &self.path, &mut smooth);
            }
            self.smooth[round].finish(&self.path, &mut smooth);
            if let Some(retime) = self.retime.get_mut(round) {
                for knot in smooth {
                    retime.push(knot, &self.path, &mut knots);
                }
                retime.finish(&self.path, &mut knots);
            } else {
                for knot in smooth {
                    self.settle.push(knot, &self.path, out);
                }
                self.settle.finish(&self.path, out);
            }
        }
        self.started = false;
    }

    fn pass(&mut self, mut knots: Vec<Knot<N>>, out: &mut Vec<Emitted<N>>) {
        for round in 0..ROUNDS {
            if knots.is_empty() {
                return;
            }
            let mut smooth = Vec::new();
            for knot in knots.drain(..) {
                self.smooth[round].push(knot, &self.path, &mut smooth);
            }
            if let Some(retime) = self.retime.get_mut(round) {
                for knot in smooth {
                    retime.push(knot, &self.path, &mut knots);
                }
            } else {
                for knot in smooth {
                    self.settle.push(knot, &self.path, out);
                }
            }
        }
        if !out.is_empty() {
            self.path.forget_before(self.settle.oldest());
        }
    }
}

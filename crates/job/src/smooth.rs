//! Smoothing: moves control points within the tolerance, across moves, so that the motion needs
//! less acceleration.
//!
//! The control points belong to a cubic spline whose parameter is nearly the time. Smoothing makes
//! the sum of the squares of their second differences least, each axis relative to its acceleration
//! limit, as long as the emitted curve stays within the tolerance of the programmed path. The
//! constraint holds at every knot and at one place between two knots, which is the sharpest corner
//! there.
//!
//! The problem is solved by the alternating direction method of multipliers (S. Boyd et al.,
//! Distributed Optimization and Statistical Learning via ADMM, 2011, section 5.2): a banded linear
//! system and a projection onto balls take turns. What it leaves of the constraint is found by
//! `settle.rs`.
//!
//! Knots are solved in blocks; a block sees some knots before it, which stay, and some after it,
//! which are solved again in the next block.

use crate::banded::{BAND, Factors, Row, add_square, factor, solve};
use crate::path::{Corner, Near, Path, Place};
use crate::rough::Knot;
use crate::spline::{TAPS, emitted};
use crate::vector::{Point, from_to, plus, weighted};
use std::collections::VecDeque;

/// Knots that are solved for good in one block.
const BLOCK: usize = 448;
/// Knots behind them, which are solved again.
const AHEAD: usize = 48;
/// Knots before them, which stay.
const BEHIND: usize = 8;
/// Knots at the start and at the end of a run, all at the same place.
pub(crate) const RESTING: usize = 3;
/// Iterations for each block: of the first smoothing, whose knots the next ones replace, and of the
/// others.
const FIRST_ITERATIONS: usize = 8;
const ITERATIONS: usize = 16;
/// Weight of the constraint against the second differences.
const STIFFNESS: f64 = 0.6;
/// Over-relaxation (Boyd et al., section 3.4.3).
const RELAXATION: f64 = 1.6;

/// How often the time is halved in which the curve passes a corner.
const HALVINGS: usize = 5;

/// One stage of smoothing.
#[derive(Debug)]
pub(crate) struct Smooth<const N: usize> {
    /// Weights of the second differences of the letters.
    weights: [f64; N],
    /// Part of the tolerance that is used.
    part: f64,
    average: usize,
    knot_taps: [f64; TAPS],
    /// The taps in the middle between two knots, and their reach.
    middle_taps: ([f64; TAPS], usize),
    /// The knots may be far from the path and are compared with the nearest place. Otherwise they
    /// are on the path, where their places say.
    project: bool,
    iterations: usize,
    buffer: VecDeque<Knot<N>>,
    /// Where the curve is at the first knot of the next block, so that it never goes back.
    reached: Place,
    fixed: usize,
    /// Knots of the buffer that have been passed on.
    passed: usize,
}

/// The curve at one place has to be near a point of the path.
struct Sample<const N: usize> {
    first: usize,
    taps: [f64; TAPS],
    centre: Point<N>,
    /// Greatest distances, over linear letters and for each rotary one.
    linear: f64,
    rotary: f64,
    /// The place that fulfils the constraint, and the sum of what was missing.
    within: Point<N>,
    missing: Point<N>,
}

impl<const N: usize> Smooth<N> {
    pub fn new(weights: [f64; N], part: f64, average: usize, project: bool) -> Self {
        Self {
            weights,
            part,
            average,
            knot_taps: emitted(0.0, average).0,
            middle_taps: emitted(0.5, average),
            project,
            iterations: if project { ITERATIONS } else { FIRST_ITERATIONS },
            buffer: VecDeque::new(),
            reached: Place::default(),
            fixed: RESTING,
            passed: 0,
        }
    }

    /// Adds the next knot.
    pub fn push(&mut self, knot: Knot<N>, path: &Path<N>, out: &mut Vec<Knot<N>>) {
        if self.buffer.is_empty() {
            self.reached = knot.place;
        }
        self.buffer.push_back(knot);
        if self.buffer.len() >= BEHIND + BLOCK + AHEAD {
            self.solve(self.buffer.len() - AHEAD, path);
            let upto = self.buffer.len() - AHEAD;
            out.extend(self.buffer.range(self.passed..upto));
            self.buffer.drain(..upto - BEHIND);
            self.fixed = BEHIND;
            self.passed = BEHIND;
        }
    }

    /// The run ends with the last knots, which are at rest.
    pub fn finish(&mut self, path: &Path<N>, out: &mut Vec<Knot<N>>) {
        self.solve(self.buffer.len(), path);
        out.extend(self.buffer.range(self.passed..));
        self.buffer.clear();
        self.fixed = RESTING;
        self.passed = 0;
    }

    /// Solves all knots but the fixed ones; the first `upto` are then passed on. The last knots stay,
    /// because they may be those where the run comes to rest.
    fn solve(&mut self, upto: usize, path: &Path<N>) {
        let n = self.buffer.len();
        let (begin, end) = (self.fixed, n.saturating_sub(RESTING));
        if begin >= end || n < TAPS {
            return;
        }
        let mut c: Vec<Point<N>> = self.buffer.iter().map(|knot| knot.point).collect();
        let mut samples = self.samples(&c, upto, path);
        let [bend, data] = quadratic_forms(n, &samples);
        let element =
            |i: usize, k: usize, letter: usize| data[i][k] + self.weights[letter] * bend[i][k];
        let mut factors: Vec<Factors<N>> = vec![[[0.0; N]; BAND + 1]; end - begin];
        for letter in 0..N {
            let row = |i: usize| -> Row {
                std::array::from_fn(|k| if begin + k <= i { element(i, k, letter) } else { 0.0 })
            };
            let mut rows: Vec<Row> = (begin..end).map(row).collect();
            factor(&mut rows);
            for (all, row) in factors.iter_mut().zip(rows) {
                all.iter_mut().zip(row).for_each(|(all, x)| all[letter] = x);
            }
        }
        // What the knots that stay contribute to the right side.
        let mut staying = vec![[0.0; N]; end - begin];
        for i in begin..end {
            for letter in 0..N {
                for k in 1..=BAND.min(i) {
                    if i - k < begin {
                        staying[i - begin][letter] -= element(i, k, letter) * c[i - k][letter];
                    }
                }
                for k in 1..=BAND.min(n - 1 - i) {
                    if i + k >= end {
                        staying[i - begin][letter] -= element(i + k, k, letter) * c[i + k][letter];
                    }
                }
            }
        }
        let mut right = vec![[0.0; N]; n];
        for _ in 0..self.iterations {
            right.fill([0.0; N]);
            right[begin..end].copy_from_slice(&staying);
            for sample in &samples {
                let wanted = from_to(&sample.missing, &sample.within);
                let Some(sums) = right[sample.first..].first_chunk_mut::<TAPS>() else { continue };
                for (sum, tap) in sums.iter_mut().zip(&sample.taps) {
                    *sum = plus(sum, STIFFNESS * tap, &wanted);
                }
            }
            solve(&factors, &mut right[begin..end]);
            c[begin..end].copy_from_slice(&right[begin..end]);
            for sample in &mut samples {
                let Some(around) = c[sample.first..].first_chunk::<TAPS>() else { continue };
                let here = weighted(&sample.taps, around);
                let moved: Point<N> = std::array::from_fn(|i| {
                    sample.missing[i] + RELAXATION * here[i] + (1.0 - RELAXATION) * sample.within[i]
                });
                sample.within = sample.nearest_within(&moved, path.linear);
                sample.missing = from_to(&sample.within, &moved);
            }
        }
        for (knot, c) in self.buffer.iter_mut().zip(c) {
            knot.point = c;
        }
    }

    /// The constraints, in order; the places of the knots become those that the curve is near.
    fn samples(&mut self, c: &[Point<N>], upto: usize, path: &Path<N>) -> Vec<Sample<N>> {
        let n = c.len();
        let mut samples = Vec::with_capacity(2 * n);
        let mut from = self.reached;
        let mut before: Option<Place> = None;
        for m in 3..n - 3 {
            let here = weighted(&self.knot_taps, &c[m - 3..]);
            let near = if self.project {
                path.nearest(&here, from, self.buffer[m + 3].place)
            } else {
                path.at(self.buffer[m].place)
            };
            let Some(near) = near else { continue };
            if near.place > from {
                from = near.place;
            }
            if m + BEHIND <= upto {
                self.reached = from;
            }
            if let Some(before) = before {
                let corner = path.sharpest(before, near.place);
                let phase = match &corner {
                    None => 0.5,
                    Some(corner) if !self.project => corner.part,
                    Some(corner) => self.passed_at(&c[m - 4..], before, near.place, corner, path),
                };
                let (taps, reach) = match corner {
                    None => self.middle_taps,
                    Some(_) => emitted(phase, self.average),
                };
                let first = m - 1 - reach;
                let between = weighted(&taps, &c[first..]);
                // At a corner the curve is compared with the tip, otherwise with the nearest place.
                let at = match &corner {
                    Some(corner) => path.tip(corner),
                    None if self.project => path.nearest(&between, before, near.place),
                    None => path.part(before, near.place, phase),
                };
                let reach = corner.map_or(1.0, |corner| corner.reach());
                let sample = at.and_then(|at| self.sample(first, taps, between, &at, reach, path));
                samples.extend(sample);
            }
            before = Some(near.place);
            samples.extend(self.sample(m - 3, self.knot_taps, here, &near, 1.0, path));
            self.buffer[m].place = near.place;
        }
        samples
    }

    /// When the curve passes a corner between two knots: where both of its sides are equally near.
    fn passed_at(
        &self,
        c: &[Point<N>],
        from: Place,
        to: Place,
        corner: &Corner,
        path: &Path<N>,
    ) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = (low + high) / 2.0;
            let (taps, reach) = emitted(middle, self.average);
            let here = weighted(&taps, &c[3 - reach..]);
            let near = path.nearest(&here, from, to);
            if near.is_some_and(|near| near.place.piece > corner.piece) {
                high = middle;
            } else {
                low = middle;
            }
        }
        high
    }

    fn sample(
        &self,
        first: usize,
        taps: [f64; TAPS],
        here: Point<N>,
        near: &Near<N>,
        reach: f64,
        path: &Path<N>,
    ) -> Option<Sample<N>> {
        let tolerance = path.piece(near.place.piece)?.tolerance;
        let mut sample = Sample {
            first,
            taps,
            centre: near.point,
            linear: tolerance.linear * self.part * reach,
            rotary: tolerance.rotary * self.part * reach,
            within: here,
            missing: [0.0; N],
        };
        sample.within = sample.nearest_within(&here, path.linear);
        Some(sample)
    }
}

impl<const N: usize> Sample<N> {
    /// The point within the tolerance that is nearest to `point`.
    #[inline]
    fn nearest_within(&self, point: &Point<N>, linear: usize) -> Point<N> {
        let mut off = from_to(&self.centre, point);
        // Loops over all letters have a length that the compiler knows.
        let line = |i: usize| if i < linear { 1.0 } else { 0.0 };
        let square = (0..N).map(|i| line(i) * off[i] * off[i]).sum::<f64>();
        if square > self.linear * self.linear {
            let part = self.linear / square.sqrt();
            (0..N.min(linear)).for_each(|i| off[i] *= part);
        }
        (linear..N).for_each(|i| off[i] = off[i].clamp(-self.rotary, self.rotary));
        plus(&self.centre, 1.0, &off)
    }
}

/// The quadratic forms of the second differences and of the constraints.
fn quadratic_forms<const N: usize>(n: usize, samples: &[Sample<N>]) -> [Vec<Row>; 2] {
    let mut bend = vec![[0.0; BAND + 1]; n];
    let mut data = bend.clone();
    for first in 0..n - 2 {
        add_square(&mut bend, first, &[1.0, -2.0, 1.0], 1.0);
    }
    for sample in samples {
        add_square(&mut data, sample.first, &sample.taps, STIFFNESS);
    }
    [bend, data]
}

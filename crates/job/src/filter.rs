//! The filter in time: each emitted control point is the mean of the last samples.
//!
//! A mean never has a greater speed or acceleration than what it is a mean of. The second
//! differences of samples are within the acceleration limit A, so those of the mean of m samples
//! change by at most 2 A / m from one knot to the next: with knots a time dt apart, the jerk is at
//! most 2 A / (m dt). The curve is late by (m - 1) / 2 knots, which nobody sees, and moves towards
//! the acceleration by up to A dt^2 (m^2 - 1) / 24 (second moment of the mean).

use crate::rough::Knot;
use crate::smooth::RESTING;
use crate::speed::Instant;
use crate::vector::{Point, plus};
use std::collections::VecDeque;

#[derive(Debug, Clone)]
pub(crate) struct Filter<const N: usize> {
    average: usize,
    last: VecDeque<Instant<N>>,
}

impl<const N: usize> Filter<N> {
    pub fn new(average: usize) -> Self {
        Self { average, last: VecDeque::new() }
    }

    /// All samples so far were at this knot.
    pub fn rest(&mut self, knot: Knot<N>) {
        self.last = std::iter::repeat_n(Instant { knot, u: 0.0, ahead: knot.place }, self.average)
            .collect();
    }

    /// As many samples at a knot as bring the emitted curve to rest there.
    pub fn settling(&self, knot: Knot<N>) -> Vec<Instant<N>> {
        vec![Instant { knot, u: 0.0, ahead: knot.place }; self.average + RESTING - 1]
    }

    /// Parameters are counted from a later grid point from now on.
    pub fn rebase(&mut self, by: f64) {
        self.last.iter_mut().for_each(|instant| instant.u -= by);
    }

    /// Takes the next sample and gives the next control point. Its parameter is that of the middle
    /// of the samples.
    pub fn push(&mut self, instant: &Instant<N>) -> Instant<N> {
        self.last.pop_front();
        self.last.push_back(*instant);
        let part = 1.0 / self.last.len() as f64;
        let mut mean: Point<N> = [0.0; N];
        for sample in &self.last {
            mean = plus(&mean, part, &sample.knot.point);
        }
        let middle = &self.last[self.last.len() / 2];
        let knot = Knot { point: mean, place: middle.knot.place };
        // The mean may be beyond the middle one, but not beyond the newest.
        Instant { knot, u: middle.u, ahead: instant.ahead }
    }
}

//! A stage that gives a smoothed curve its speed law and samples it once a knot time. Its samples
//! are the knots of the next smoothing, so that path and time improve each other.

use crate::path::Path;
use crate::rough::Knot;
use crate::smooth::RESTING;
use crate::speed::{MARGIN, Rules, fastest, reachable, sampled};
use std::collections::VecDeque;

/// Intervals that are passed in one block.
const BLOCK: usize = 448;

#[derive(Debug)]
pub(crate) struct Retime<const N: usize> {
    rules: Rules<N>,
    /// Intervals behind a block in which the motion can stop.
    ahead: usize,
    buffer: VecDeque<Knot<N>>,
    /// x at the first grid point, and the time from there to the next sample.
    x: f64,
    next: f64,
}

impl<const N: usize> Retime<N> {
    pub fn new(rules: Rules<N>, ahead: usize) -> Self {
        Self { rules, ahead, buffer: VecDeque::new(), x: f64::INFINITY, next: 0.0 }
    }

    pub fn push(&mut self, knot: Knot<N>, path: &Path<N>, out: &mut Vec<Knot<N>>) {
        if self.buffer.is_empty() {
            self.buffer.push_back(knot);
            out.extend([knot; RESTING - 1]);
        }
        self.buffer.push_back(knot);
        if self.buffer.len() >= BLOCK + self.ahead + 2 * MARGIN {
            self.advance(false, path, out);
        }
    }

    /// The run ends at rest at the last knot.
    pub fn finish(&mut self, path: &Path<N>, out: &mut Vec<Knot<N>>) {
        if let Some(&last) = self.buffer.back() {
            self.buffer.push_back(last);
            self.advance(true, path, out);
            out.extend([last; RESTING]);
        }
        self.buffer.clear();
        self.x = f64::INFINITY;
        self.next = 0.0;
    }

    fn advance(&mut self, end: bool, path: &Path<N>, out: &mut Vec<Knot<N>>) {
        let c = self.buffer.make_contiguous();
        let grid = self.rules.grid(c, path);
        let reach = reachable(&grid, if end { f64::INFINITY } else { 0.0 });
        if grid.is_empty() {
            return;
        }
        let speeds = fastest(&grid, &reach, self.x);
        let upto = if end { grid.len() - 1 } else { BLOCK };
        let (samples, next) = sampled(c, &speeds[..=upto], self.next);
        out.extend(samples.iter().map(|sample| sample.knot));
        self.next = next;
        self.x = speeds[upto];
        self.buffer.drain(..upto);
    }
}

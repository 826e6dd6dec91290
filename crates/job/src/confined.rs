//! Whether the path has gone to and fro in one small place for long.
//!
//! Such a path comes back within its tolerance to the same places any number of times, so the planner
//! cannot tell from a point of the tool which of these times it is, and searches all of them. After a
//! rest it searches only what follows. So the path rests now and then; without these rests the time
//! of planning grew with the square of the number of moves.

use crate::element::{Element, Tolerance};
use crate::vector::{Point, from_to};

/// Radius of a small place, in tolerances.
const RADIUS: f64 = 8.0;
/// How far the path goes in a small place before it rests, in tolerances.
const LONGEST: f64 = 1024.0;

/// How far the path has gone since it came to a small place.
#[derive(Debug)]
pub(crate) struct Confined<const N: usize> {
    /// The first `linear` letters are linear, the others rotary.
    linear: usize,
    /// The middle of the place.
    middle: Point<N>,
    /// In tolerances.
    length: f64,
}

impl<const N: usize> Confined<N> {
    /// The path begins, or goes on from a rest.
    pub fn new(linear: usize, at: Point<N>) -> Self {
        Self { linear, middle: at, length: 0.0 }
    }

    /// Adds an element. `true`: the path has to rest before it.
    pub fn rests_before(&mut self, element: &Element, from: &Point<N>, to: &Point<N>) -> bool {
        let tolerance = element.tolerance;
        let off = |a, b| self.distance(a, b, tolerance);
        let (length, farthest) = match element.arc {
            None => (off(from, to), off(&self.middle, to)),
            Some(arc) => {
                let [i, j] = arc.plane;
                let radius = (from[i] - arc.centre[0]).hypot(from[j] - arc.centre[1]);
                let round = radius * arc.angle.abs() / tolerance.linear;
                let across = 2.0 * radius / tolerance.linear;
                (round + off(from, to), off(&self.middle, from).max(off(&self.middle, to)) + across)
            }
        };
        if farthest > RADIUS {
            *self = Self::new(self.linear, *to);
            return false;
        }
        self.length += length;
        self.length > LONGEST
    }

    /// The distance of two points in tolerances.
    fn distance(&self, a: &Point<N>, b: &Point<N>, tolerance: Tolerance) -> f64 {
        let d = from_to(a, b);
        let linear = d[..self.linear].iter().map(|x| x * x).sum::<f64>().sqrt();
        let rotary = d[self.linear..].iter().map(|x| x.abs()).fold(0.0, f64::max);
        (linear / tolerance.linear).max(rotary / tolerance.rotary)
    }
}

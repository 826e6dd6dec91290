//! Whether a curve stays within the tolerance of a programmed path, in order along the path: a
//! decision in the free space of two polylines (H. Alt and M. Godau, Computing the Frechet distance
//! between two polygonal curves, 1995). It shares nothing with the planner's own measurement.
//!
//! Both curves are replaced by chords that are within [`FLAT`] of them, and the tolerance is reduced
//! by that much, so that "within" is a proof: between two places of a chord, the distance from a
//! straight part of the path is not greater than at both of them (both are convex sets). The curve
//! goes from one part of the path to a later one where it is within the tolerance of both, and
//! within twice the tolerance of all corners between them.

use carrystep_job::{Arc, Item};

/// Most letters.
const LETTERS: usize = 6;
/// How far chords may be from what they replace, as a part of the tolerance.
pub const FLAT: f64 = 2e-4;
/// How near the curve has to pass a corner, as a multiple of the tolerance.
const CORNER: f64 = 2.0;

/// A point, with 0 for the letters that the machine does not have.
pub type Place = [f64; LETTERS];

/// A straight part of the path, with its tolerances.
#[derive(Debug, Clone)]
struct Chord {
    from: Place,
    along: Place,
    linear: f64,
    rotary: f64,
    line: u64,
}

/// A programmed path as chords. The first `linear` letters are linear.
#[derive(Debug, Clone)]
pub struct Programmed {
    chords: Vec<Chord>,
    linear: usize,
    /// The least tolerance.
    least: f64,
}

impl Programmed {
    /// The path of these items. `landed` rounds the end of a run to whole steps.
    pub fn new(
        start: &[f64],
        items: &[Item],
        linear: usize,
        landed: impl Fn(&[f64]) -> Vec<f64>,
    ) -> Self {
        let mut path = Self { chords: Vec::new(), linear, least: f64::MAX };
        let mut at = place(&landed(start));
        for (number, item) in items.iter().enumerate() {
            let Item::Move(element) = item else { continue };
            // Marks do not interrupt a run; rests and the end do.
            let next = items[number + 1..].iter().find(|item| !matches!(item, Item::Mark(_)));
            let ends = !matches!(next, Some(Item::Move(_)));
            let to = place(&if ends { landed(&element.to) } else { element.to.clone() });
            let tolerance = [element.tolerance.linear, element.tolerance.rotary];
            match &element.arc {
                None => path.chord(at, to, tolerance, element.line),
                Some(arc) => path.arc(at, to, arc, tolerance, element.line),
            }
            at = to;
        }
        path
    }

    fn chord(&mut self, from: Place, to: Place, [linear, rotary]: [f64; 2], line: u64) {
        let along: Place = std::array::from_fn(|i| to[i] - from[i]);
        if along.iter().any(|x| *x != 0.0) {
            self.least = self.least.min(linear).min(rotary);
            self.chords.push(Chord { from, along, linear, rotary, line });
        }
    }

    fn arc(&mut self, from: Place, to: Place, arc: &Arc, tolerance: [f64; 2], line: u64) {
        let [i, j] = arc.plane;
        let polar = |p: &Place| {
            let (x, y) = (p[i] - arc.centre[0], p[j] - arc.centre[1]);
            (x.hypot(y), y.atan2(x))
        };
        let ((r, begin), (end_r, end)) = (polar(&from), polar(&to));
        let turn = std::f64::consts::TAU;
        let off = end - begin - arc.angle;
        let angle = arc.angle + off - turn * (off / turn).round();
        // The height of a chord over its arc is r (angle of the chord)^2 / 8.
        let one = (8.0 * FLAT * tolerance[0] / r.max(end_r)).sqrt();
        let count = (angle.abs() / one).ceil().max(1.0);
        let mut before = from;
        for k in 1..=count as u32 {
            let part = f64::from(k) / count;
            let mut point: Place = std::array::from_fn(|m| from[m] + part * (to[m] - from[m]));
            let (radius, here) = (r + part * (end_r - r), begin + part * angle);
            point[i] = arc.centre[0] + radius * here.cos();
            point[j] = arc.centre[1] + radius * here.sin();
            if f64::from(k) >= count {
                point = to;
            }
            self.chord(before, point, tolerance, line);
            before = point;
        }
    }

    /// A curve that starts at the path's start; the tolerance is multiplied by `scale`.
    pub fn follow(&self, scale: f64) -> Follow<'_> {
        Follow { path: self, scale, reached: vec![(0, 0.0)] }
    }
}

fn place(values: &[f64]) -> Place {
    std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0))
}

/// The state of a curve that follows a path.
#[derive(Debug, Clone)]
pub struct Follow<'a> {
    path: &'a Programmed,
    scale: f64,
    /// The chords on which the curve may be, each with the least part of it that it has passed.
    reached: Vec<(usize, f64)>,
}

impl Follow<'_> {
    /// The least tolerance of the path.
    pub fn tolerance(&self) -> f64 {
        self.scale * self.path.least
    }

    /// The line of the place that the curve has reached.
    pub fn line(&self) -> u64 {
        let chord = self.reached.first().and_then(|(number, _)| self.path.chords.get(*number));
        chord.map_or(0, |chord| chord.line)
    }

    /// The curve goes on along a straight chord to this place. `false` if it leaves the tolerance;
    /// the state then does not change.
    pub fn step(&mut self, to: &[f64]) -> bool {
        if self.path.chords.is_empty() {
            return true;
        }
        let to = place(to);
        let mut after = Vec::with_capacity(self.reached.len() + 4);
        let last = self.reached.last().map_or(0, |(number, _)| *number);
        let mut known = self.reached.iter().peekable();
        // The curve may have come from an earlier chord, past all corners since.
        let mut bridge = false;
        let first = self.reached.first().map_or(0, |(number, _)| *number);
        for number in first..self.path.chords.len() {
            if number > last && !bridge {
                break;
            }
            let passed = known.next_if(|(k, _)| *k == number).map(|(_, low)| *low);
            if let Some((low, high)) = self.free(&self.path.chords[number], &to) {
                let least = match (bridge, passed) {
                    (true, _) => Some(low),
                    (false, Some(passed)) if passed.max(low) <= high => Some(passed.max(low)),
                    _ => None,
                };
                if let Some(least) = least {
                    after.push((number, least));
                    bridge = true;
                }
            }
            bridge = bridge && self.passes_end(number, &to);
        }
        let good = !after.is_empty();
        if good {
            self.reached = after;
        }
        good
    }

    /// Whether the curve may be at the end of the path.
    pub fn ended(&self) -> bool {
        self.path.chords.is_empty()
            || self.reached.last().is_some_and(|(number, _)| number + 1 == self.path.chords.len())
    }

    /// The part of a chord that is within the tolerance of a place.
    fn free(&self, chord: &Chord, to: &Place) -> Option<(f64, f64)> {
        let most = [chord.linear, chord.rotary].map(|x| x * (self.scale - 2.0 * FLAT));
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        let n = self.path.linear;
        let off: Place = std::array::from_fn(|i| chord.from[i] - to[i]);
        let sum = |f: &dyn Fn(usize) -> f64| (0..n).map(f).sum::<f64>();
        let square = sum(&|i| chord.along[i] * chord.along[i]);
        let foot = if square > 0.0 { -sum(&|i| chord.along[i] * off[i]) / square } else { 0.0 };
        let left = most[0] * most[0] - sum(&|i| (off[i] + foot * chord.along[i]).powi(2));
        if left < 0.0 {
            return None;
        }
        if square > 0.0 {
            let half = (left / square).sqrt();
            (low, high) = (low.max(foot - half), high.min(foot + half));
        }
        for (&along, &off) in chord.along.iter().zip(&off).skip(n) {
            if along == 0.0 {
                if off.abs() > most[1] {
                    return None;
                }
                continue;
            }
            let [a, b] = [-most[1], most[1]].map(|x| (x - off) / along);
            (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
        }
        (low <= high).then_some((low, high))
    }

    /// Whether the end of a chord is near enough for the curve to leave it.
    fn passes_end(&self, number: usize, to: &Place) -> bool {
        let chord = &self.path.chords[number];
        let Some(next) = self.path.chords.get(number + 1) else { return false };
        let n = self.path.linear;
        let square = |i: usize| (next.from[i] - to[i]).powi(2);
        let linear = (0..n).map(square).sum::<f64>().sqrt();
        let rotary = (n..LETTERS).map(square).fold(0.0, f64::max).sqrt();
        let most = CORNER * self.scale;
        linear <= most * chord.linear.max(next.linear)
            && rotary <= most * chord.rotary.max(next.rotary)
    }
}

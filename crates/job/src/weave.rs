//! From control points to integer segments that land exactly.
//!
//! Control points are converted to integers of 2^-64 step, and everything after that is exact. With
//! knots n ticks apart, a segment from knot k to knot k + 1 has J = d3 / n^3 and A = d2 / n^2 + J,
//! rounded toward zero (`spline.rs` defines the differences), and the V that brings P to the
//! spline's value at knot k + 1, to within n/2 units. What is left over is part of the next
//! segment's distance. The rounding of A and J moves P inside a segment by less than
//! n^2/2 + n^3/6 units, which is 10^-9 step for n = 4000.
//!
//! Where an axis reverses near a step's place, P is moved a little (`turn.rs`).
//!
//! A run ends with a segment of n + 1 ticks. Its V takes what is left over, up to a rest of r units.
//! Because n and n + 1 have no common divisor, taking r from the V before it and adding r to its own
//! V moves the end by r units.

use crate::error::Rule;
use crate::turn::Pair;
use carrystep_core::Segment;
use carrystep_plan::exact::{ExactLimits, speeds, travel};

/// Greatest jump of the acceleration at a boundary, as a part of the limit: 1/50.
const JUMP: i128 = 50;
/// A motor rests between two control points that are nearer than this, 2^-64 step: 2^-24 step,
/// which is more than floats err by.
const REST: u128 = 1 << 40;
/// Greatest distance between P and the spline at a knot, 2^-64 step: a quarter of a step.
const QUARTER: i128 = 1 << 62;

/// How often the distance is doubled by which P is moved before a reversal.
const TURNS: u32 = 8;

/// The segments of all motors between two knots.
#[derive(Debug, Clone)]
pub(crate) struct Span<const N: usize> {
    pub ticks: u32,
    pub segments: [Segment; N],
}

/// The integer state of all motors.
#[derive(Debug)]
pub(crate) struct Weave<const N: usize> {
    ticks: u32,
    limits: [ExactLimits; N],
    /// The last three control points, 2^-64 step from machine zero.
    control: [[i128; N]; 3],
    /// Where P is after the last span.
    at: [i128; N],
    /// A in the last tick of the span before.
    acceleration: [i128; N],
    held: Option<Span<N>>,
    /// For each motor, the ticks around a reversal that have to be free of edges.
    quiet: [u32; N],
}

/// A rule that the segment of a motor breaks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Broken {
    pub axis: usize,
    pub rule: Rule,
}

impl<const N: usize> Weave<N> {
    /// All motors rest at these whole positions, in units of 2^-64 step.
    pub fn new(ticks: u32, limits: [ExactLimits; N], quiet: [u32; N], at: [i128; N]) -> Self {
        Self { ticks, limits, control: [at; 3], at, acceleration: [0; N], held: None, quiet }
    }

    /// Whether the next control point leaves the place of rest.
    pub fn leaves(&self, point: &[i128; N]) -> bool {
        self.held.is_some() || self.rested(*point) != self.at
    }

    /// A control point, without the errors of floats that would move a motor that rests. The guard
    /// of the gateware stops motion toward a limit switch that is closed, however slow it is.
    fn rested(&self, mut point: [i128; N]) -> [i128; N] {
        for (next, last) in point.iter_mut().zip(&self.control[2]) {
            if next.abs_diff(*last) < REST {
                *next = *last;
            }
        }
        point
    }

    /// Adds a control point; gives the span before the one that it completes.
    ///
    /// # Errors
    /// The rule that the finished span breaks.
    pub fn push(&mut self, point: [i128; N]) -> Result<Option<Span<N>>, Broken> {
        let span = self.span(self.ticks, self.rested(point))?;
        let done = self.held.replace(span);
        match done {
            None => Ok(None),
            Some(done) => self.checked(done).map(Some),
        }
    }

    /// Adds the last control point of a run; the two before it are at the same place. Gives the
    /// last two spans.
    ///
    /// # Errors
    /// The rule that a finished span breaks.
    pub fn land(&mut self, target: [i128; N]) -> Result<Vec<Span<N>>, Broken> {
        let Some(mut before) = self.held.take() else { return Ok(Vec::new()) };
        let mut last = self.span(self.ticks + 1, target)?;
        let n = i128::from(last.ticks);
        for (axis, (target, at)) in target.iter().zip(&self.at).enumerate() {
            let left = target - at;
            let whole = (left + n / 2).div_euclid(n);
            let rest = left - whole * n;
            let moved = |segment: &mut Segment, by: i128| {
                let v = i64::try_from(i128::from(segment.v) + by);
                segment.v = v.map_err(|_| Broken { axis, rule: Rule::Landing })?;
                Ok(())
            };
            moved(&mut before.segments[axis], -rest)?;
            moved(&mut last.segments[axis], whole + rest)?;
        }
        self.at = target;
        self.control = [target; 3];
        Ok(vec![self.checked(before)?, self.checked(last)?])
    }

    /// The span that a control point completes. P goes on to its end.
    fn span(&mut self, ticks: u32, point: [i128; N]) -> Result<Span<N>, Broken> {
        let mut segments = [Segment { ticks, v: 0, a: 0, j: 0, last: false }; N];
        let n = i128::from(ticks);
        for (axis, segment) in segments.iter_mut().enumerate() {
            let [c0, c1, c2] = self.control.map(|c| c[axis]);
            let c3 = point[axis];
            let (second, third) = (c2 - 2 * c1 + c0, c3 - 3 * c2 + 3 * c1 - c0);
            let register =
                |value: i128| i64::try_from(value).map_err(|_| Broken { axis, rule: Rule::Range });
            segment.j = register(third / (n * n * n))?;
            segment.a = register((second * n + third) / (n * n * n))?;
            let goal = (c1 + 4 * c2 + c3).div_euclid(6);
            let left = goal - self.at[axis] - travel(segment, u64::from(ticks));
            segment.v = register((left + n / 2).div_euclid(n))?;
            self.turn(axis, segment)?;
            self.at[axis] += travel(segment, u64::from(ticks));
            if (goal - self.at[axis]).abs() > QUARTER {
                return Err(Broken { axis, rule: Rule::Position });
            }
        }
        self.control = [self.control[1], self.control[2], point];
        Ok(Span { ticks, segments })
    }

    /// Keeps edges away from the reversals of a motor in a segment: moves P by the segment before.
    fn turn(&mut self, axis: usize, segment: &Segment) -> Result<(), Broken> {
        let Some(held) = &mut self.held else { return Ok(()) };
        let before = &mut held.segments[axis];
        let quiet = self.quiet[axis];
        let start = self.at[axis] - travel(before, u64::from(before.ticks));
        let pair = |before: &Segment| Pair { at: start, before, now: segment }.is_quiet(quiet);
        if pair(before) {
            return Ok(());
        }
        // What the motor can go at its acceleration in this time.
        let far = self.limits[axis].acceleration * i128::from(quiet) * i128::from(quiet);
        for part in 0..TURNS {
            for sign in [1, -1] {
                let moved = sign * (far << part) / i128::from(before.ticks);
                let Some(v) = i64::try_from(moved).ok().and_then(|v| before.v.checked_add(v))
                else {
                    continue;
                };
                let other = Segment { v, ..*before };
                if pair(&other) {
                    *before = other;
                    self.at[axis] = start + travel(before, u64::from(before.ticks));
                    return Ok(());
                }
            }
        }
        Err(Broken { axis, rule: Rule::Direction })
    }

    /// Checks a finished span, in integers, at its ends and extremes.
    fn checked(&mut self, span: Span<N>) -> Result<Span<N>, Broken> {
        for (axis, segment) in span.segments.iter().enumerate() {
            let before = self.acceleration[axis];
            let end = obeys(segment, &self.limits[axis], before);
            self.acceleration[axis] = end.map_err(|rule| Broken { axis, rule })?;
        }
        Ok(span)
    }
}

/// Checks a segment, in integers, at its ends and extremes. `before` is A in the last tick of the
/// segment before; gives that of this one.
///
/// # Errors
/// The rule that the segment breaks.
pub(crate) fn obeys(segment: &Segment, limits: &ExactLimits, before: i128) -> Result<i128, Rule> {
    let (a, j) = (i128::from(segment.a), i128::from(segment.j));
    let end = a + (i128::from(segment.ticks) - 1) * j;
    let fastest = speeds(segment).map(i128::abs).max().unwrap_or(0);
    if fastest >= 1 << 63 {
        return Err(Rule::Range);
    }
    if fastest > limits.speed {
        return Err(Rule::Speed);
    }
    if a.abs().max(end.abs()) > limits.acceleration {
        return Err(Rule::Acceleration);
    }
    if limits.jerk.is_some_and(|most| j.abs() > most) {
        return Err(Rule::Jerk);
    }
    if (a - before).abs() > limits.acceleration / JUMP {
        return Err(Rule::Jump);
    }
    Ok(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motor_lands_slowly_from_an_error_of_floats_beside_its_target() {
        let most = 1 << 60;
        let limits = ExactLimits {
            start_speed: 0,
            speed: most,
            acceleration: most,
            jerk: None,
            tolerance: 0,
        };
        for error in [0, 1, -1, 1999, -2001, (1 << 40) - 1, 1 - (1 << 40)] {
            let mut weave = Weave::new(4000, [limits], [3], [0]);
            let far = 100_i128 << 64;
            let ramp = [1_i128, 8, 24, 45, 65, 82, 92, 98].map(|part| part * far / 100);
            let last = far + error;
            let points = ramp.iter().copied().chain([last, last, last, far, far]);
            let mut spans: Vec<Span<1>> =
                points.filter_map(|point| weave.push([point]).unwrap()).collect();
            spans.extend(weave.land([far]).unwrap());
            let all = spans.iter().map(|span| travel(&span.segments[0], span.ticks.into()));
            assert_eq!(all.sum::<i128>(), far, "{error}");
            for span in &spans[spans.len() - 2..] {
                let v = span.segments[0].v.abs();
                assert!(v < 1 << 30, "{error}: V is {v}");
            }
        }
    }
}

//! A curve as points: enough of them, and on both sides of each corner.

use crate::Curve;
use crate::reference::curve::Reference;
use crate::reference::kind::Kind;

/// Points of a line, beside its corners.
const LINE: u32 = 240;
/// Delays that are drawn, at most.
const DELAYS: u32 = 300;

/// A point: seconds, value.
pub type Point = (f64, f64);

/// What is drawn of one profile, seconds and the unit of the picture.
#[derive(Debug, Clone)]
pub struct Sampled {
    pub kind: Kind,
    /// Name and length.
    pub legend: String,
    pub speed: Vec<Point>,
    /// The end speed of a ramp, from its end to the end of the picture.
    pub cruise: Option<[Point; 2]>,
    pub acceleration: Vec<Point>,
    pub jerk: Vec<Point>,
    /// Sudden changes of acceleration: impulses of jerk.
    pub impulses: Vec<Point>,
    /// Seconds from one step to the next, in the middle between them.
    pub delay: Vec<Point>,
}

impl Sampled {
    /// Samples one of several profiles, the longest of which takes `span` seconds.
    pub fn new(reference: &Reference, span: f64, steps_in_unit: f64) -> Self {
        let (curve, figures) = (reference.curve(), reference.figures());
        let times = times(curve);
        let of = |value: &dyn Fn(f64) -> f64| times.iter().map(|&t| (t, value(t) / steps_in_unit)).collect();
        let end = figures.seconds;
        let cruise = [(end, figures.end_speed / steps_in_unit), (span, figures.end_speed / steps_in_unit)];
        Self {
            kind: reference.kind(),
            legend: format!("{}, {end:.3} s", reference.kind()),
            speed: of(&|t| curve.speed(t)),
            cruise: (span > end && reference.is_ramp()).then_some(cruise),
            acceleration: from_nothing(of(&|t| curve.acceleration(t)), end),
            jerk: of(&|t| curve.jerk(t)),
            impulses: impulses(curve).into_iter().map(|(t, jump)| (t, jump / steps_in_unit)).collect(),
            delay: delays(reference),
        }
    }
}

/// Up from 0 at the start, down to 0 at the end.
fn from_nothing(line: Vec<Point>, end: f64) -> Vec<Point> {
    [(0.0, 0.0)].into_iter().chain(line).chain([(end, 0.0)]).collect()
}

/// A moment, for the two sides of a corner.
fn moment(curve: &dyn Curve<f64>) -> f64 {
    1e-7 * curve.duration()
}

/// Corners, the ends included.
fn corners(curve: &dyn Curve<f64>) -> impl Iterator<Item = f64> + '_ {
    [0.0, curve.duration()].into_iter().chain(curve.breakpoints().iter().copied())
}

fn times(curve: &dyn Curve<f64>) -> Vec<f64> {
    let (end, moment) = (curve.duration(), moment(curve));
    let even = (1..LINE).map(|k| end * f64::from(k) / f64::from(LINE));
    let sides = corners(curve).flat_map(|t| [t - moment, t + moment]);
    let mut times: Vec<f64> = even.chain(sides).filter(|&t| t > 0.0 && t < end).collect();
    times.sort_by(f64::total_cmp);
    times
}

/// Where acceleration jumps, and by how much. Outside the curve it is 0.
fn impulses(curve: &dyn Curve<f64>) -> Vec<Point> {
    let (end, moment) = (curve.duration(), moment(curve));
    let at = |t: f64| if t > 0.0 && t < end { curve.acceleration(t) } else { 0.0 };
    let jumps = corners(curve).map(|t| (t, at(t + moment) - at(t - moment)));
    // What changes gently changes a little in two moments too.
    jumps.filter(|(_, jump)| jump.abs() > 1e-4 * curve.peak_acceleration()).collect()
}

/// All delays, or as many as can be told apart, evenly in time.
fn delays(reference: &Reference) -> Vec<Point> {
    let (curve, steps) = (reference.curve(), reference.whole_steps());
    let chosen: Vec<f64> = if steps <= f64::from(DELAYS) {
        (0..steps as u32).map(f64::from).collect()
    } else {
        let even = (0..DELAYS).map(|k| curve.position(curve.duration() * f64::from(k) / f64::from(DELAYS)).floor());
        // The first steps are far apart in delay.
        let ends = (0..40).flat_map(|n| [f64::from(n), steps - 1.0 - f64::from(n)]);
        let mut chosen: Vec<f64> = even.chain(ends).collect();
        chosen.sort_by(f64::total_cmp);
        chosen.dedup();
        chosen
    };
    let middle = |n: f64| {
        let delay = reference.delay(n);
        (reference.crossing(n) + delay / 2.0, delay)
    };
    chosen.into_iter().map(middle).collect()
}

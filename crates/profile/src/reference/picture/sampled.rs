//! Samples a curve as points for the picture, with points on both sides of each corner.

use crate::Curve;
use crate::reference::curve::Reference;
use carrystep_core::ProfileKind;

/// Number of points of a line, without those at its corners.
const LINE: u32 = 240;
/// The greatest number of delays that are drawn.
const DELAYS: u32 = 300;

/// A point: time in seconds, and value.
pub type Point = (f64, f64);

/// The points of one profile, in seconds and the unit of the picture.
#[derive(Debug, Clone)]
pub struct Sampled {
    pub kind: ProfileKind,
    /// Name and duration.
    pub legend: String,
    pub speed: Vec<Point>,
    /// The end speed of a ramp, from its end to the end of the picture.
    pub cruise: Option<[Point; 2]>,
    pub acceleration: Vec<Point>,
    pub jerk: Vec<Point>,
    /// Sudden changes of the acceleration, which are impulses of the jerk.
    pub impulses: Vec<Point>,
    /// Seconds from one step to the next, drawn in the middle between them.
    pub delay: Vec<Point>,
}

impl Sampled {
    /// Samples one of several profiles, the longest of which takes `span` seconds.
    pub fn new(reference: &Reference, span: f64, steps_in_unit: f64) -> Self {
        let (curve, figures) = (reference.curve(), reference.figures());
        let times = times(curve);
        let of = |value: &dyn Fn(f64) -> f64| {
            times.iter().map(|&t| (t, value(t) / steps_in_unit)).collect()
        };
        let end = figures.seconds;
        let cruise =
            [(end, figures.end_speed / steps_in_unit), (span, figures.end_speed / steps_in_unit)];
        Self {
            kind: reference.kind(),
            legend: format!("{}, {end:.3} s", reference.kind()),
            speed: of(&|t| curve.speed(t)),
            cruise: (span > end && reference.is_ramp()).then_some(cruise),
            acceleration: from_nothing(of(&|t| curve.acceleration(t)), end),
            jerk: of(&|t| curve.jerk(t)),
            impulses: impulses(curve)
                .into_iter()
                .map(|(t, jump)| (t, jump / steps_in_unit))
                .collect(),
            delay: delays(reference),
        }
    }
}

/// Adds points at 0 at the start and at the end of the curve.
fn from_nothing(line: Vec<Point>, end: f64) -> Vec<Point> {
    [(0.0, 0.0)].into_iter().chain(line).chain([(end, 0.0)]).collect()
}

/// The distance in time from a corner to the points on its two sides, seconds.
fn moment(curve: &dyn Curve<f64>) -> f64 {
    1e-7 * curve.duration()
}

/// The times of the corners, with both ends.
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

/// The times at which the acceleration jumps, and the size of each jump. The acceleration is 0
/// outside the curve.
fn impulses(curve: &dyn Curve<f64>) -> Vec<Point> {
    let (end, moment) = (curve.duration(), moment(curve));
    let at = |t: f64| if t > 0.0 && t < end { curve.acceleration(t) } else { 0.0 };
    let jumps = corners(curve).map(|t| (t, at(t + moment) - at(t - moment)));
    // A continuous acceleration also changes a little between the two points; only larger changes
    // count.
    jumps.filter(|(_, jump)| jump.abs() > 1e-4 * curve.peak_acceleration()).collect()
}

/// The delays of all steps, or of a selection that is even in time if there are too many.
fn delays(reference: &Reference) -> Vec<Point> {
    let (curve, steps) = (reference.curve(), reference.whole_steps());
    let chosen: Vec<f64> = if steps <= f64::from(DELAYS) {
        (0..steps as u32).map(f64::from).collect()
    } else {
        let even = (0..DELAYS)
            .map(|k| curve.position(curve.duration() * f64::from(k) / f64::from(DELAYS)).floor());
        // The delays of the first and the last steps differ much, so these steps are all included.
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

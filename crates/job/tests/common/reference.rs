//! Reference planners, written from the published formulas: Grbl's rule, rest to rest, and the
//! least time along a given curve without a jerk limit.

use carrystep_job::{Element, Item};

/// Speed and acceleration limits of each axis, mm and seconds.
#[derive(Debug, Clone)]
pub struct Limits {
    pub speed: Vec<f64>,
    pub acceleration: Vec<f64>,
}

/// A straight line of a program; arcs are chords.
struct Chord {
    length: f64,
    unit: Vec<f64>,
    speed: f64,
    acceleration: f64,
}

/// How far a chord may be from its arc, mm (Grbl's setting 12).
const CHORD: f64 = 0.002;

/// Seconds that Grbl's rule takes (S. Jeon, 2011: junctions at v^2 = a d s / (1 - s), with d the
/// distance, s the sine of half the angle between the lines, and a the limit along the junction),
/// with trapezoids and unlimited look-ahead. With `distance` 0 it goes from rest to rest.
pub fn grbl(items: &[Item], limits: &Limits, distance: f64) -> f64 {
    let chords = chords(items, limits);
    let n = chords.len();
    let mut corner = vec![0.0; n + 1];
    for k in 1..n {
        let [a, b] = [&chords[k - 1], &chords[k]];
        let cosine: f64 = -a.unit.iter().zip(&b.unit).map(|(a, b)| a * b).sum::<f64>();
        let least = a.speed.min(b.speed);
        let sine = ((1.0 - cosine) / 2.0).sqrt();
        let turn: Vec<f64> = a.unit.iter().zip(&b.unit).map(|(a, b)| b - a).collect();
        let size = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
        let square = if size < 1e-9 {
            f64::INFINITY
        } else {
            let turn: Vec<f64> = turn.iter().map(|x| x / size).collect();
            greatest(&turn, &limits.acceleration) * distance * sine / (1.0 - sine)
        };
        corner[k] = square.min(least * least);
    }
    for k in (0..n).rev() {
        corner[k] = corner[k].min(corner[k + 1] + 2.0 * chords[k].acceleration * chords[k].length);
    }
    let mut seconds = 0.0;
    for (k, chord) in chords.iter().enumerate() {
        let a = chord.acceleration;
        corner[k + 1] = corner[k + 1].min(corner[k] + 2.0 * a * chord.length);
        let (v0, v1) = (corner[k].sqrt(), corner[k + 1].sqrt());
        let top = (a * chord.length + (corner[k] + corner[k + 1]) / 2.0).sqrt().min(chord.speed);
        let ramps = (2.0 * top * top - v0 * v0 - v1 * v1) / (2.0 * a);
        seconds += (2.0 * top - v0 - v1) / a + (chord.length - ramps).max(0.0) / top;
    }
    seconds
}

fn greatest(unit: &[f64], limits: &[f64]) -> f64 {
    unit.iter().zip(limits).map(|(u, l)| l / u.abs()).fold(f64::INFINITY, f64::min)
}

fn chords(items: &[Item], limits: &Limits) -> Vec<Chord> {
    let mut at = vec![0.0; limits.speed.len()];
    let mut chords = Vec::new();
    for item in items {
        let Item::Move(element) = item else { continue };
        for to in ends(&at, element) {
            let along: Vec<f64> = at.iter().zip(&to).map(|(a, b)| b - a).collect();
            let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
            if length > 1e-9 {
                let unit: Vec<f64> = along.iter().map(|x| x / length).collect();
                let speed = greatest(&unit, &limits.speed).min(element.feed.unwrap_or(f64::MAX));
                let acceleration = greatest(&unit, &limits.acceleration);
                chords.push(Chord { length, unit, speed, acceleration });
            }
            at = to;
        }
    }
    chords
}

/// The ends of an element's chords.
fn ends(from: &[f64], element: &Element) -> Vec<Vec<f64>> {
    let Some(arc) = element.arc else { return vec![element.to.clone()] };
    let [i, j] = arc.plane;
    let (x, y) = (from[i] - arc.centre[0], from[j] - arc.centre[1]);
    let radius = x.hypot(y);
    let one = 2.0 * (1.0 - CHORD / radius).clamp(-1.0, 1.0).acos();
    let count = (arc.angle.abs() / one).floor().max(1.0);
    let place = |k: f64| {
        let mut to: Vec<f64> =
            from.iter().zip(&element.to).map(|(a, b)| a + (b - a) * k / count).collect();
        let (sin, cos) = (arc.angle * k / count).sin_cos();
        to[i] = arc.centre[0] + x * cos - y * sin;
        to[j] = arc.centre[1] + x * sin + y * cos;
        to
    };
    let mut ends: Vec<Vec<f64>> = (1..count as u32).map(|k| place(f64::from(k))).collect();
    ends.push(element.to.clone());
    ends
}

/// A place of a curve over a parameter: derivatives of each axis, and the feed there.
pub struct Sample {
    pub first: Vec<f64>,
    pub second: Vec<f64>,
    pub feed: f64,
}

/// The least time along a curve within speed, acceleration and feed, without a jerk limit, from any
/// speed to any speed: a backward and a forward pass over samples `h` apart, with the square x of
/// the parameter's speed (J. Bobrow et al., 1985). Constraints hold at the samples only, so that
/// the result is a lower bound up to the spacing.
pub fn least_time(samples: &[Sample], h: f64, limits: &Limits) -> f64 {
    let most: Vec<f64> = samples
        .iter()
        .map(|s| {
            let axes = s.first.iter().zip(&limits.speed).map(|(q, v)| v / q.abs());
            let speed = s.first.iter().map(|q| q * q).sum::<f64>().sqrt();
            axes.fold(s.feed / speed, f64::min).powi(2).min(1e6)
        })
        .collect();
    // The least and greatest second derivative of the parameter at one x.
    let bounds = |s: &Sample, x: f64| {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for ((q, r), a) in s.first.iter().zip(&s.second).zip(&limits.acceleration) {
            if q.abs() > 1e-9 {
                let (one, other) = ((-a - r * x) / q, (a - r * x) / q);
                low = low.max(one.min(other));
                high = high.min(one.max(other));
            } else if (r * x).abs() > *a {
                return (1.0, -1.0);
            }
        }
        (low, high)
    };
    let mut reach = vec![0.0; samples.len()];
    let mut next = f64::INFINITY;
    for k in (0..samples.len()).rev() {
        let works = |x: f64| {
            let (low, high) = bounds(&samples[k], x);
            low <= high && x + 2.0 * h * low <= next
        };
        let (mut low, mut high) = (0.0, most[k]);
        if works(high) {
            low = high;
        } else {
            for _ in 0..50 {
                let middle = (low + high) / 2.0;
                if works(middle) { low = middle } else { high = middle }
            }
        }
        reach[k] = low;
        next = low;
    }
    let (mut x, mut seconds) = (reach[0], 0.0);
    for k in 1..samples.len() {
        let (_, high) = bounds(&samples[k - 1], x);
        let next = (x + 2.0 * h * high).min(reach[k]).max(1e-12);
        seconds += 2.0 * h / (x.sqrt() + next.sqrt());
        x = next;
    }
    seconds
}

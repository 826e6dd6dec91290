//! How far a place is from a programmed path, in order along the path. Written anew, with exact
//! distances to lines and arcs.

use carrystep_job::{Element, Item};
use std::f64::consts::TAU;

/// One element with its start.
struct Part {
    from: Vec<f64>,
    element: Element,
    length: f64,
}

/// A path that a tool follows.
pub struct Follow {
    parts: Vec<Part>,
    /// The element that the tool has reached.
    pub reached: usize,
}

/// How far ahead of the reached element the tool may be, mm.
const AHEAD: f64 = 0.5;
/// How near the end of an element the tool comes, as a multiple of the tolerance.
const CORNER: f64 = 5.0;

impl Follow {
    pub fn new(start: &[f64], items: &[Item]) -> Self {
        let mut from = start.to_vec();
        let mut parts = Vec::new();
        for item in items {
            if let Item::Move(element) = item {
                let length = length(&from, element);
                if length > 0.0 {
                    parts.push(Part { from: from.clone(), element: element.clone(), length });
                }
                from = element.to.clone();
            }
        }
        Self { parts, reached: 0 }
    }

    pub fn elements(&self) -> usize {
        self.parts.len()
    }

    /// The tolerance where the tool is, mm.
    pub fn tolerance(&self) -> f64 {
        self.parts.get(self.reached).map_or(1.0, |part| part.element.tolerance.linear)
    }

    /// The distance of the next place as a part of the tolerance there. Elements before the
    /// one that the tool has just left do not count.
    pub fn off(&mut self, place: &[f64]) -> f64 {
        if self.parts.is_empty() {
            return 0.0;
        }
        // The tool has left an element when it is near its end and within the tolerance of the next
        // one, or of one that follows after a short way.
        let mut last = self.reached;
        let mut skipped = 0.0;
        for (number, pair) in self.parts.windows(2).enumerate().skip(self.reached) {
            let [part, next] = pair else { break };
            let tolerance = next.element.tolerance.linear;
            let end = place.iter().zip(&part.element.to).map(|(a, b)| (a - b) * (a - b));
            if end.sum::<f64>().sqrt() > CORNER * tolerance || skipped > CORNER * tolerance {
                break;
            }
            if distance(place, next) <= tolerance {
                (last, skipped) = (number + 1, 0.0);
            } else {
                skipped += next.length;
            }
        }
        self.reached = last;
        let (mut best, mut ahead) = (f64::INFINITY, 0.0);
        for (number, part) in self.parts.iter().enumerate().skip(self.reached.saturating_sub(1)) {
            best = f64::min(best, distance(place, part) / part.element.tolerance.linear);
            ahead += if number <= self.reached { 0.0 } else { part.length };
            if ahead > AHEAD {
                break;
            }
        }
        best
    }
}

fn length(from: &[f64], element: &Element) -> f64 {
    let straight = from.iter().zip(&element.to).map(|(a, b)| (b - a) * (b - a)).sum::<f64>().sqrt();
    element.arc.map_or(straight, |arc| {
        let [i, j] = arc.plane;
        (from[i] - arc.centre[0]).hypot(from[j] - arc.centre[1]) * arc.angle.abs()
    })
}

fn distance(place: &[f64], part: &Part) -> f64 {
    let (from, to) = (&part.from, &part.element.to);
    let Some(arc) = part.element.arc else {
        let along: Vec<f64> = from.iter().zip(to).map(|(a, b)| b - a).collect();
        let square: f64 = along.iter().map(|x| x * x).sum();
        let here = place.iter().zip(from).zip(&along).map(|((p, a), d)| (p - a) * d).sum::<f64>();
        let s = if square > 0.0 { (here / square).clamp(0.0, 1.0) } else { 0.0 };
        let off = place.iter().zip(from).zip(&along).map(|((p, a), d)| (p - a - s * d).powi(2));
        return off.sum::<f64>().sqrt();
    };
    // The nearest of many points, and of the points around it.
    let [i, j] = arc.plane;
    let start = (from[j] - arc.centre[1]).atan2(from[i] - arc.centre[0]);
    let radius = |p: &[f64]| (p[i] - arc.centre[0]).hypot(p[j] - arc.centre[1]);
    let off = |s: f64| {
        let (here, r) = (start + s * arc.angle, radius(from) + s * (radius(to) - radius(from)));
        let square = |k: usize| {
            let x = if k == i {
                arc.centre[0] + r * here.cos()
            } else if k == j {
                arc.centre[1] + r * here.sin()
            } else {
                from[k] + s * (to[k] - from[k])
            };
            (place[k] - x) * (place[k] - x)
        };
        (0..place.len()).map(square).sum::<f64>().sqrt()
    };
    let count = (32.0 * (arc.angle.abs() / TAU).ceil()) as u32;
    let place_of = |k: u32| f64::from(k) / f64::from(count);
    let coarse: Vec<f64> = (0..=count).map(|k| off(place_of(k))).collect();
    // Each turn has its nearest point.
    let lowest = (0..=count).filter(|&k| {
        let here = coarse[k as usize];
        coarse[k.saturating_sub(1) as usize..=(k + 1).min(count) as usize]
            .iter()
            .all(|x| here <= *x)
    });
    let refined = lowest.map(|k| {
        let (mut low, mut high) = (place_of(k.saturating_sub(1)), place_of((k + 1).min(count)));
        for _ in 0..40 {
            let third = (high - low) / 3.0;
            if off(low + third) < off(high - third) { high -= third } else { low += third }
        }
        off((low + high) / 2.0)
    });
    refined.fold(f64::MAX, f64::min)
}

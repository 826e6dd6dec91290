//! Checks that position, speed, acceleration, jerk and crossing time of a curve are consistent.

use carrystep_profile::{Curve, Real};

/// The permitted deviation from a law, in units of the float's epsilon.
pub struct Slack {
    /// Deviation by rounding, relative to the quantity.
    pub rounding: f64,
    /// Deviation by the quadrature, relative to the greatest value of the quantity within one part.
    pub quadrature: f64,
}

fn wide<F: Real>(x: F) -> f64 {
    x.to_f64().unwrap()
}

fn float<F: Real>(x: f64) -> F {
    F::from(x).unwrap()
}

/// Checks all laws of a move or a ramp.
#[track_caller]
pub fn hold<F: Real>(curve: &dyn Curve<F>, slack: &Slack) {
    ends(curve, slack);
    integrals(curve, slack);
    crossings(curve, slack);
}

#[track_caller]
fn ends<F: Real>(curve: &dyn Curve<F>, slack: &Slack) {
    let (duration, distance) = (curve.duration(), curve.distance());
    assert!(duration >= F::zero() && duration.is_finite() && distance.is_finite());
    assert_eq!(curve.crossing(F::zero()), F::zero());
    assert_eq!(curve.crossing(distance), duration);
    assert_eq!(curve.position(F::zero()), F::zero());
    assert_eq!(curve.position(-duration), F::zero());
    let end = wide(curve.position(duration) / distance) - 1.0;
    assert!(end.abs() <= slack.rounding * wide(F::epsilon()), "ends {end:e} off");
    let breakpoints = curve.breakpoints();
    assert!(
        breakpoints.iter().all(|&b| b > F::zero() && b < duration),
        "{breakpoints:?} in {duration:?}"
    );
    assert!(breakpoints.windows(2).all(|pair| pair[0] < pair[1]), "{breakpoints:?}");
}

/// Nodes and weights of the five-point Gauss-Legendre rule on -1..1.
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

fn mean<F: Real>(from: F, to: F, f: impl Fn(F) -> F) -> f64 {
    let at = |node: f64| from + (to - from) * float((1.0 + node) / 2.0);
    GAUSS.iter().map(|&(node, weight)| wide(f(at(node))) * weight / 2.0).sum()
}

/// Checks that between breakpoints each quantity is the integral of the next: position of speed,
/// speed of acceleration, acceleration of jerk.
#[track_caller]
fn integrals<F: Real>(curve: &dyn Curve<F>, slack: &Slack) {
    let (duration, distance) = (curve.duration(), wide(curve.distance()));
    let mut ends = vec![F::zero()];
    ends.extend(curve.breakpoints());
    ends.push(duration);
    let epsilon = wide(F::epsilon());
    let (top, steepest, sharpest) =
        (wide(curve.top_speed()), wide(curve.peak_acceleration()), wide(curve.peak_jerk()));
    // `late` is the rounding of a time, and `few` the relative rounding of a sum of a few numbers.
    let (late, few) = (slack.rounding * epsilon * wide(duration), slack.rounding * epsilon);
    for piece in ends.windows(2) {
        const PARTS: u32 = 64;
        if wide(piece[1] - piece[0]) < 1e3 * late {
            continue; // The piece is too short for its times to be distinguished.
        }
        let step = (piece[1] - piece[0]) / float(f64::from(PARTS));
        // The breakpoints themselves are left out, because acceleration and jerk have two values
        // there.
        let near =
            |i: u32| piece[0] + step * float(f64::from(i).clamp(0.1, f64::from(PARTS) - 0.1));
        for i in 0..PARTS {
            let (from, to) = (near(i), near(i + 1));
            let span = wide(to) - wide(from);
            let check = |name: &str, actual: f64, ideal: f64, scale: f64, lost: f64| {
                let (error, allowed) =
                    ((actual - ideal).abs(), slack.quadrature * epsilon * scale + lost);
                assert!(
                    error <= allowed,
                    "{name} {from:?}..{to:?}: {actual:e}, not {ideal:e}; {curve:?}"
                );
            };
            let fastest = wide(curve.speed(from).max(curve.speed(to)));
            let speed = mean(from, to, |t| curve.speed(t));
            check("mean speed", wide(curve.mean_speed(from, to)), speed, fastest, steepest * late);
            let travel = wide(curve.position(to)) - wide(curve.position(from));
            check("position", travel, speed * span, fastest * span, few * distance + late * top);
            let gain = wide(curve.speed(to)) - wide(curve.speed(from));
            let acceleration = mean(from, to, |t| curve.acceleration(t));
            check("speed", gain, acceleration * span, steepest * span, few * top + late * steepest);
            let change = wide(curve.acceleration(to)) - wide(curve.acceleration(from));
            let jerk = mean(from, to, |t| curve.jerk(t));
            check(
                "acceleration",
                change,
                jerk * span,
                sharpest * span,
                few * steepest + late * sharpest,
            );
        }
    }
}

/// Checks that `crossing` is the inverse of `position`, even very near to rest, and that later
/// positions are passed later.
#[track_caller]
fn crossings<F: Real>(curve: &dyn Curve<F>, slack: &Slack) {
    let (duration, distance) = (curve.duration(), curve.distance());
    let tolerance = slack.rounding * wide(F::epsilon());
    let parts = [
        1e-12,
        1e-9,
        1e-6,
        1e-3,
        0.01,
        0.1,
        0.3,
        0.499,
        0.5,
        0.501,
        0.7,
        0.9,
        0.99,
        0.999,
        1.0 - 1e-6,
    ];
    let mut last = F::zero();
    for part in parts {
        let x = distance * float(part);
        let t = curve.crossing(x);
        assert!(t >= last && t <= duration, "{x:?} at {t:?} after {last:?}");
        last = t;
        let error = (wide(curve.position(t)) - wide(x)).abs();
        // In the first half the error of t is relative to t, in the second half to the duration. A
        // move without a ramp up does not start near rest, so the second rule applies to all of it.
        let flying = curve.speed(F::zero()) == curve.top_speed();
        let allowed = if part <= 0.5 && !flying {
            wide(x) + wide(t) * wide(curve.speed(t))
        } else {
            wide(distance) + wide(duration) * wide(curve.speed(t))
        };
        assert!(
            error <= tolerance * allowed,
            "{part} of {distance:?}: {x:?} became {error:e} off; {curve:?}"
        );
    }
}

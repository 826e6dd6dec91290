//! Uniform cubic B-splines: the weights of control points (C. de Boor, A Practical Guide to
//! Splines, 1978, chapter IX).
//!
//! Knots are one unit of the parameter apart. With control points c and the differences
//! d1 = (c[k+1] - c[k-1]) / 2, d2 = c[k+1] - 2 c[k] + c[k-1] and d3 = c[k+2] - 3 c[k+1] + 3 c[k] -
//! c[k-1], the spline at knot k has the value c[k] + d2/6, the first derivative d1 and the second
//! derivative d2; the third derivative is d3 from knot k to knot k + 1.

use crate::vector::{Point, weighted};

/// The value at distance `x` from the knot of a control point with weight 1.
fn hat(x: f64) -> f64 {
    let x = x.abs();
    if x < 1.0 {
        (4.0 - 6.0 * x * x + 3.0 * x * x * x) / 6.0
    } else if x < 2.0 {
        (2.0 - x).powi(3) / 6.0
    } else {
        0.0
    }
}

/// The spline at `u` from 0 to 1 between the second and the third of four control points.
pub(crate) fn value<const N: usize>(c: &[Point<N>], u: f64) -> Point<N> {
    let w = 1.0 - u;
    let weights = [
        w * w * w / 6.0,
        (4.0 - 6.0 * u * u + 3.0 * u * u * u) / 6.0,
        (4.0 - 6.0 * w * w + 3.0 * w * w * w) / 6.0,
        u * u * u / 6.0,
    ];
    weighted(&weights, c)
}

/// Number of control points that decide a place of the emitted curve.
pub(crate) const TAPS: usize = 7;

/// The weights of the control points c for the curve that is emitted: c is sampled once a knot,
/// `average` (1 or 2) neighbouring samples are averaged, and the averages are control points again.
/// The place is at `phase` (0 to 1) after a knot; the second result tells how many of the control
/// points are before that knot.
pub(crate) fn emitted(phase: f64, average: usize) -> ([f64; TAPS], usize) {
    let before = if phase < 0.5 { 3 } else { 2 };
    let sample = |i: f64| -> f64 {
        let shifted = |l: usize| i - phase - (l as f64 - (average as f64 - 1.0) / 2.0);
        (0..average).map(|l| hat(shifted(l))).sum::<f64>() / average as f64
    };
    let taps = std::array::from_fn(|k| {
        let i = k as f64 - before as f64;
        (sample(i - 1.0) + 4.0 * sample(i) + sample(i + 1.0)) / 6.0
    });
    (taps, before)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_the_emitted_curve_are_those_of_sampling_averaging_and_the_spline() {
        let c: Vec<Point<1>> =
            (0..40).map(|k| [f64::from(k * k % 17) - 0.3 * f64::from(k)]).collect();
        for average in [1, 2] {
            let samples: Vec<Point<1>> =
                c.windows(3).map(|c| weighted(&[1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0], c)).collect();
            let averages: Vec<Point<1>> = samples
                .windows(average)
                .map(|p| weighted(&vec![1.0 / average as f64; average], p))
                .collect();
            for step in 0..40 {
                // averages[i] belongs to the parameter i + 1 + (average - 1) / 2.
                let phase = f64::from(step) / 40.0;
                let u = 20.0 + phase;
                let place = u - 1.0 - (average as f64 - 1.0) / 2.0;
                let from = place.floor() as usize;
                let direct = value(&averages[from - 1..], place - place.floor())[0];
                let (taps, before) = emitted(phase, average);
                let weighed = weighted(&taps, &c[20 - before..])[0];
                assert!((direct - weighed).abs() < 1e-12, "{average} {phase}: {direct} {weighed}");
            }
        }
    }
}

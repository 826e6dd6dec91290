//! The cubic of a segment over time: how far the gateware comes, as a function of V, A and J.

use crate::units;
use carrystep_profile::Real;

/// Converts units of 2^-64 step to steps.
pub(crate) fn steps(units: i128) -> f64 {
    units::float(units) * 2_f64.powi(-64)
}

/// The distances that V n, A n^2 and J n^3 contribute after `t` of `n` ticks, each per unit of its
/// unknown.
pub(crate) fn basis(t: f64, n: f64) -> [f64; 3] {
    let s = t / n;
    let pairs = s * (t - 1.0) / (2.0 * n);
    [s, pairs, pairs * (t - 2.0) / (3.0 * n)]
}

/// The same on the chord of the tick that contains `t`. Edges lie on this chord, because the
/// gateware interpolates linearly within a tick.
pub(crate) fn chord(t: f64, n: f64) -> [f64; 3] {
    let part = t - t.floor();
    let [from, to] = [t.floor(), t.floor() + 1.0].map(|t| basis(t, n));
    std::array::from_fn(|k| from[k] + part * (to[k] - from[k]))
}

/// The greatest of evenly spaced values, and of the maxima of the parabolas through three
/// neighbouring values.
pub(crate) fn peak(values: impl Iterator<Item = f64>) -> f64 {
    let (mut greatest, mut held) = (0.0_f64, [f64::NAN; 2]);
    for next in values {
        let [before, here] = held;
        let bend = before - 2.0 * here + next;
        if here >= before && here > next {
            greatest = greatest.max(here - (next - before).powi(2) / (8.0 * bend));
        }
        greatest = greatest.max(next);
        held = [here, next];
    }
    greatest
}

/// Converts a float to f64.
pub(crate) fn wide<F: Real>(x: F) -> f64 {
    x.to_f64().unwrap_or(f64::NAN)
}

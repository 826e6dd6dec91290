//! Finds the float at which a monotone condition changes, by bisection down to neighbouring floats.
//! The bisection always ends, and takes microseconds.

use crate::profile::{Real, real};

/// The largest value in `low..=high` at which `holds`. The condition must hold at `low`, and once
/// it fails it must fail for all greater values. `high` may be infinite.
pub(crate) fn largest<F: Real>(low: F, high: F, holds: impl Fn(F) -> bool) -> F {
    if high.is_finite() {
        return if holds(high) { high } else { last_held(low, high, holds) };
    }
    let (mut low, mut high) = (low, low.max(F::one()));
    while high.is_finite() && holds(high) {
        (low, high) = (high, high + high);
    }
    last_held(low, high, holds)
}

/// The smallest value from `low` on at which `holds`. Once the condition holds, it must hold for
/// all greater values. Returns infinity if it never holds.
pub(crate) fn smallest<F: Real>(low: F, holds: impl Fn(F) -> bool) -> F {
    let (mut low, mut high) = (low, low);
    while high.is_finite() && !holds(high) {
        (low, high) = (high, (high + high).max(F::min_positive_value()));
    }
    if high.is_finite() { first_held(low, high, holds) } else { high }
}

fn last_held<F: Real>(mut low: F, mut high: F, holds: impl Fn(F) -> bool) -> F {
    while let Some(middle) = between(low, high) {
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

fn first_held<F: Real>(mut low: F, mut high: F, holds: impl Fn(F) -> bool) -> F {
    while let Some(middle) = between(low, high) {
        if holds(middle) { high = middle } else { low = middle }
    }
    high
}

/// The middle of two floats, or `None` if there is no float between them.
fn between<F: Real>(low: F, high: F) -> Option<F> {
    let middle = low + (high - low) / real(2.0);
    (middle > low && middle < high).then_some(middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn largest_and_smallest_find_the_last_and_first_float_that_holds() {
        assert_eq!(largest(0.0, 10.0, |x| x * x <= 2.25), 1.5);
        assert_eq!(largest(0.0, f64::INFINITY, |x| x <= 1e9), 1e9);
        assert_eq!(largest(0.0, f64::INFINITY, |x| x <= 1e-9), 1e-9);
        assert_eq!(largest(0.0, 3.0, |_| true), 3.0);
        assert_eq!(smallest(1.0, |x: f64| x >= 1e9), 1e9);
        assert_eq!(smallest(5.0, |_: f64| true), 5.0);
        assert_eq!(smallest(1.0, |_: f64| false), f64::INFINITY);
        assert!(smallest(f64::NAN, |x| x > 0.0).is_nan());
        assert_eq!(largest(0.0, f64::NAN, |x| x < 1.0), 1.0_f64.next_down());
    }
}

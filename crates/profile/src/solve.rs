//! Finds the float at which a monotone condition changes, down to neighbouring floats. Every search
//! keeps a bracket that becomes smaller each time, so that it always ends.

use crate::profile::{Real, real};

/// The largest value in `low..=high` at which `value` is at most `most`. It must be at most `most`
/// at `low`, and must not fall. `high` may be infinite.
///
/// The method is the false position of M. Dowell and P. Jarratt (1971), "A modified regula falsi
/// method for computing the root of an equation": if the same end of the bracket is replaced twice,
/// the excess at the other end is halved. Here it works on logarithms, because a distance is nearly
/// a power of the top speed. Every guess is moved past the root, by more each time, so that the
/// bracket soon ends on both sides of it.
pub(crate) fn largest<F: Real>(low: F, high: F, most: F, value: impl Fn(F) -> F) -> F {
    let excess = |found: F| (found / most).ln();
    let (mut low, mut high) = (low, high);
    if high.is_infinite() {
        high = low.max(F::one());
        while high.is_finite() && value(high) <= most {
            (low, high) = (high, high + high);
        }
    }
    let top = value(high);
    if top <= most {
        return high;
    }
    let (mut under, mut over) = (excess(value(low)), excess(top));
    let (mut replaced_low, mut past) = (None, F::epsilon());
    while let Some(middle) = between(low, high) {
        let root = if under.is_finite() && low > F::zero() {
            low * ((high / low).ln() * under / (under - over)).exp()
        } else {
            high * (-over).exp()
        };
        let beyond = root * past;
        let guess = if replaced_low == Some(true) {
            (root + beyond).min(high - beyond)
        } else {
            (root - beyond).max(low + beyond)
        };
        let x = if guess > low && guess < high { guess } else { middle };
        let found = value(x);
        let is_low = found <= most;
        let again = replaced_low == Some(is_low);
        let half = if again { real(0.5) } else { F::one() };
        past = if again { past * real(8.0) } else { F::epsilon() };
        if is_low {
            (low, under, over) = (x, excess(found), over * half);
        } else {
            (high, over, under) = (x, excess(found), under * half);
        }
        replaced_low = Some(is_low);
    }
    low
}

/// [`largest`] for a value that floats compute without a fall, where a guess `near` the result is
/// known: the search goes away from it in steps that become twice as long each time, and bisects
/// what they enclose. A guess that is not inside the bracket decides nothing.
pub(crate) fn largest_near<F: Real>(
    near: F,
    (low, high): (F, F),
    most: F,
    value: impl Fn(F) -> F,
) -> F {
    if !(near > low && near < high) {
        return largest(low, high, most, value);
    }
    if high.is_finite() && value(high) <= most {
        return high;
    }
    let (mut low, mut high) = (low, high);
    let (mut x, mut step) = (near, near * F::epsilon());
    while x > low && x < high {
        if value(x) <= most {
            low = x;
            x = x + step;
        } else {
            high = x;
            x = x - step;
        }
        step = step + step;
    }
    while let Some(middle) = between(low, high) {
        if value(middle) <= most { low = middle } else { high = middle }
    }
    low
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
    use std::cell::Cell;

    /// The same by bisection alone.
    fn bisected(most: f64, value: impl Fn(f64) -> f64) -> f64 {
        first_held(0.0, 1e6, |x| value(x) > most).next_down()
    }

    #[test]
    fn false_position_finds_the_float_of_bisection_in_a_fifth_of_its_turns() {
        for power in [1.0, 1.5, 2.0, 3.0] {
            for most in [1e-9, 1e-3, 0.3, 1.0, 7.0, 123_456.789] {
                let turns = Cell::new(0);
                let value = |x: f64| {
                    turns.set(turns.get() + 1);
                    x.powf(power)
                };
                let found = largest(0.0, 1e6, most, value);
                let taken = turns.replace(0);
                assert_eq!(found.to_bits(), bisected(most, value).to_bits(), "{power} {most}");
                assert!(5 * taken < turns.get(), "{power} {most}: {taken} of {}", turns.get());
            }
        }
    }

    #[test]
    fn any_guess_leads_to_the_same_float() {
        for power in [1.0, 1.5, 2.0, 3.0] {
            for most in [1e-9, 1e-3, 0.3, 1.0, 7.0, 123_456.789, 1e300] {
                let value = |x: f64| x.powf(power);
                let found = largest(0.0, 1e6, most, value);
                for off in [0.0, 1e-300, 0.5, 1.0 - 1e-16, 1.0, 1.0 + 1e-15, 1.001, f64::NAN] {
                    let near = largest_near(found * off, (0.0, 1e6), most, value);
                    assert_eq!(near.to_bits(), found.to_bits(), "{power} {most} {off}");
                }
            }
        }
        assert_eq!(largest_near(7.0, (0.0, f64::INFINITY), 1e9, |x| x), 1e9);
    }

    #[test]
    fn largest_and_smallest_find_the_last_and_first_float_that_holds() {
        let linear = |x: f64| x;
        assert_eq!(largest(0.0, 10.0, 2.25, |x| x * x), 1.5);
        assert_eq!(largest(0.0, f64::INFINITY, 1e9, linear), 1e9);
        assert_eq!(largest(0.0, f64::INFINITY, 1e-9, linear), 1e-9);
        assert_eq!(largest(0.0, 3.0, 3.0, linear), 3.0);
        assert_eq!(smallest(1.0, |x: f64| x >= 1e9), 1e9);
        assert_eq!(smallest(5.0, |_: f64| true), 5.0);
        assert_eq!(smallest(1.0, |_: f64| false), f64::INFINITY);
        assert!(smallest(f64::NAN, |x| x > 0.0).is_nan());
        assert_eq!(largest(0.0, f64::NAN, 1.0, linear), 0.0);
    }
}

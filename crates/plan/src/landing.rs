//! Lands a fitted move without an extra segment: two segments share the units that V cannot spread
//! evenly over the last one.
//!
//! One unit more in V moves the end of a segment by as many units as the segment has ticks. If the
//! lengths of two segments have no common divisor, Bezout's identity reaches any distance with such
//! changes. Between the two segments the axis deviates by at most the product of their lengths.
//!
//! A greater `MOST_OFF` saves segments and allows a greater deviation.

/// The greatest product of the two lengths. It is the greatest deviation in units of 2^-64 step,
/// which is half a nanosecond at one step a second.
const MOST_OFF: i128 = 9_223_372_036;

/// Returns the change of V, in units, of an earlier segment and of the last one, so that both
/// together travel `rest` units further. The earlier segment gets slower and the last one faster,
/// so that it does not come to rest before its end. Both lengths are in ticks. Returns `None` if
/// the lengths have a common divisor or their product is too great.
pub(crate) fn shared(earlier: i128, last: i128, rest: i128) -> Option<(i128, i128)> {
    if earlier * last > MOST_OFF {
        return None;
    }
    let slower = (rest * inverse(earlier, last)?).rem_euclid(last);
    let slower = if slower == 0 { 0 } else { slower - last };
    Some((slower, (rest - slower * earlier) / last))
}

/// The inverse of `a` modulo `m`, by Euclid's algorithm, or `None` if they have a common divisor.
fn inverse(a: i128, m: i128) -> Option<i128> {
    let (mut remainders, mut factors) = ((m, a.rem_euclid(m)), (0, 1));
    while remainders.1 != 0 {
        let quotient = remainders.0 / remainders.1;
        remainders = (remainders.1, remainders.0 - quotient * remainders.1);
        factors = (factors.1, factors.0 - quotient * factors.1);
    }
    (remainders.0 == 1).then_some(factors.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shared_units_add_up_to_any_rest() {
        for (earlier, last) in [(7, 5), (14_018, 17_167), (3, 1), (1, 1), (1, 9)] {
            for rest in -2 * last..2 * last {
                let (slower, faster) = shared(earlier, last, rest).unwrap();
                assert_eq!(slower * earlier + faster * last, rest);
                assert!(-last < slower && slower <= 0, "{slower}");
                assert!((rest / last..=rest / last + earlier + 1).contains(&faster), "{faster}");
            }
        }
        assert_eq!(shared(6, 4, 1), None);
        assert_eq!(shared(1 << 20, (1 << 20) + 1, 1), None);
    }
}

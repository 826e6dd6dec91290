//! A landing that costs no segment: what V cannot share evenly over the last one, two segments share.
//!
//! A unit of V more moves the end by as many units as the segment has ticks. Where the lengths of two segments have
//! no common divisor, E. Bezout's identity makes any distance out of such moves; between the two the axis is off by
//! no more than the product of their lengths.

/// Greatest product of the lengths: 2^-64 step each, half a nanosecond at one step a second.
const MOST_OFF: i128 = 9_223_372_036;

/// Units of V for an earlier segment and for the last one that together travel `rest` units further: the earlier one
/// slower, the last one faster, so that it does not come to rest before its end.
pub(crate) fn shared(earlier: i128, last: i128, rest: i128) -> Option<(i128, i128)> {
    if earlier * last > MOST_OFF {
        return None;
    }
    let slower = (rest * inverse(earlier, last)?).rem_euclid(last);
    let slower = if slower == 0 { 0 } else { slower - last };
    Some((slower, (rest - slower * earlier) / last))
}

/// The inverse of `a` modulo `m`, by Euclid's algorithm; `None` where they have a common divisor.
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
    fn any_rest_is_shared() {
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

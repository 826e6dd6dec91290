//! Converts float steps to units of 2^-64 step. Only the rounding that the function names is
//! applied.

use carrystep_core::fixed::FRACTION_BITS;
use carrystep_profile::Real;

/// Converts `steps` to units of 2^-64 step, rounded to the nearest, halves away from zero. Returns
/// `None` if the value is not finite or does not fit into an i128.
#[inline]
pub fn nearest<F: Real>(steps: F) -> Option<i128> {
    scaled(steps, true)
}

/// Converts `steps` to units of 2^-64 step, rounded toward zero. Returns `None` if the value is not
/// finite or does not fit into an i128.
#[inline]
pub(crate) fn toward_zero<F: Real>(steps: F) -> Option<i128> {
    scaled(steps, false)
}

#[inline]
fn scaled<F: Real>(steps: F, round: bool) -> Option<i128> {
    // The product by a power of two is exact.
    let units = steps.to_f64()? * 2_f64.powi(FRACTION_BITS.cast_signed());
    if units.abs() < 2_f64.powi(62) {
        let whole = units as i64;
        let rest = units - whole as f64;
        let up = i64::from(round && rest >= 0.5) - i64::from(round && rest <= -0.5);
        return Some((whole + up).into());
    }
    if units.abs() < 2_f64.powi(96) {
        // There is no fraction of a unit, and the exponent of the mantissa is from 10 to 43.
        let bits = units.abs().to_bits();
        let mantissa = bits & ((1 << 52) - 1) | 1 << 52;
        let magnitude = i128::from(mantissa) << ((bits >> 52).saturating_sub(1075));
        return Some(if units < 0.0 { -magnitude } else { magnitude });
    }
    large(steps)
}

/// Converts a float of 2^96 units or more, if it fits.
fn large<F: Real>(steps: F) -> Option<i128> {
    if !steps.is_finite() {
        return None;
    }
    let (mantissa, exponent, sign) = steps.integer_decode();
    let shift = u32::try_from(i32::from(exponent) + FRACTION_BITS.cast_signed()).ok()?;
    (shift <= 73).then(|| i128::from(sign) * (i128::from(mantissa) << shift))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_convert_without_rounding() {
        for exponent in -80..60_i32 {
            let units = toward_zero(2_f64.powi(exponent));
            let expected = if exponent < -64 { 0 } else { 1_i128 << (exponent + 64) };
            assert_eq!(units, Some(expected), "2^{exponent}");
            assert_eq!(toward_zero(-(2_f64.powi(exponent))), Some(-expected));
        }
    }

    #[test]
    fn nearest_and_toward_zero_round_as_documented() {
        let unit = 2_f64.powi(-64);
        for (value, near, cut) in
            [(0.5, 1, 0), (0.49, 0, 0), (1.5, 2, 1), (-1.5, -2, -1), (-0.4, 0, 0)]
        {
            assert_eq!(nearest(value * unit), Some(near), "{value}");
            assert_eq!(toward_zero(value * unit), Some(cut), "{value}");
        }
        assert_eq!(nearest(f64::NAN), None);
        assert_eq!(nearest(f64::INFINITY), None);
        assert_eq!(nearest(0.25_f32), Some(1 << 62));
    }
}

//! Converts float steps to units of 2^-64 step. Only the rounding that the function names is
//! applied.

use carrystep_core::fixed::FRACTION_BITS;
use carrystep_profile::Real;

/// Converts `steps` to units of 2^-64 step, rounded to the nearest, halves away from zero. Returns
/// `None` if the value is not finite or does not fit into an i128.
pub fn nearest<F: Real>(steps: F) -> Option<i128> {
    scaled(steps, true)
}

/// Converts `steps` to units of 2^-64 step, rounded toward zero. Returns `None` if the value is not
/// finite or does not fit into an i128.
pub(crate) fn toward_zero<F: Real>(steps: F) -> Option<i128> {
    scaled(steps, false)
}

fn scaled<F: Real>(steps: F, round: bool) -> Option<i128> {
    // The product by a power of two is exact.
    let units = steps.to_f64()? * 2_f64.powi(FRACTION_BITS.cast_signed());
    if units.abs() < 2_f64.powi(62) {
        let whole = units as i64;
        let rest = units - whole as f64;
        let away = round && rest.abs() >= 0.5;
        return Some(i128::from(whole) + if away { rest.signum() as i128 } else { 0 });
    }
    if !steps.is_finite() {
        return None;
    }
    let (mantissa, exponent, sign) = steps.integer_decode();
    let shift = i32::from(exponent) + FRACTION_BITS.cast_signed();
    let mantissa = i128::from(mantissa);
    let magnitude = match shift {
        0..=73 => mantissa << shift,
        74.. if mantissa == 0 => 0,
        74.. => return None,
        ..-64 => 0,
        _ => {
            let down = shift.unsigned_abs();
            let half = if round { 1 << (down - 1) } else { 0 };
            (mantissa + half) >> down
        }
    };
    Some(i128::from(sign) * magnitude)
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

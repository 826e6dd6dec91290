//! Functions that the standard floats lack, computed without cancellation and overflow.

use crate::profile::{Real, real};

/// ln(1 + e^z), without overflow for large z and without loss of precision for small z.
pub(crate) fn softplus<F: Real>(z: F) -> F {
    z.max(F::zero()) + (-z.abs()).exp().ln_1p()
}

/// ln(e^y - 1) for y over 0, the inverse of [`softplus`].
pub(crate) fn ln_exp_m1<F: Real>(y: F) -> F {
    y + (-(-y).exp_m1()).ln()
}

/// x - sin x. For |x| below 1 the two nearly cancel; there the nested series x^3/3! - x^5/5! + ...
/// is used.
pub(crate) fn x_minus_sin<F: Real>(x: F) -> F {
    if x.abs() >= F::one() {
        return x - x.sin();
    }
    let square = x * x;
    let term = |n: f64| square / real::<F>(n * (n - 1.0));
    let nested = [19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0].into_iter();
    let sum = nested.fold(F::one(), |inner, n| F::one() - term(n) * inner);
    x * term(3.0) * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn x_minus_sin_is_continuous_where_the_series_ends() {
        let below = x_minus_sin(1.0 - f64::EPSILON);
        let above = x_minus_sin(1.0_f64);
        assert!((above / below - 1.0).abs() < 1e-15, "{below} {above}");
        assert_eq!(x_minus_sin(1e-60_f64), 1e-60_f64.powi(3) / 6.0);
        assert_eq!(x_minus_sin(-0.5_f64), -x_minus_sin(0.5_f64));
    }

    #[test]
    fn softplus_neither_overflows_nor_underflows() {
        assert_eq!(softplus(1000.0_f64), 1000.0);
        assert_eq!(softplus(-700.0_f64), (-700.0_f64).exp());
        assert!((ln_exp_m1(softplus(-30.0_f64)) + 30.0).abs() < 1e-14);
        assert_eq!(ln_exp_m1(1000.0_f64), 1000.0);
    }
}

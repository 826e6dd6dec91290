//! Tests the first steps of long ramps against 40-digit arithmetic. There the textbook formulas
//! cancel or overflow.
#![allow(clippy::excessive_precision, reason = "the digits are those of the reference")]

use carrystep_profile::{LogisticRamp, Profile, SHORTFALL, ScurveRamp, SineRamp};

#[track_caller]
fn close(actual: f64, ideal: f64, tolerance: f64) {
    assert!((actual / ideal - 1.0).abs() <= tolerance, "{actual:e}, not {ideal:e}");
}

/// Parts of a ramp, down to the first of 2^31 steps.
#[test]
fn sine_crossing_is_exact_near_rest() {
    let ramp = SineRamp::new(2.0, 1.0).unwrap();
    for (x, u) in [
        (1e-12, 0.000_742_515_383_963_117_424),
        (2.0_f64.powi(-31), 0.003_449_249_506_201_257_86),
        (1e-3, 0.132_807_715_857_285_705),
        (0.9999999, 0.999_999_95),
    ] {
        close(ramp.crossing(x), u, 1e-15);
        close(ramp.position(u), x, 4e-15);
    }
}

/// Two ramps of 1.3 million steps: a symmetric one, and one that starts far down the tail, where an
/// error of T_i counts k T_i = 20 times.
#[test]
fn logistic_crossing_is_exact_near_rest() {
    let symmetric = LogisticRamp::symmetric(1e5, 1e4).unwrap();
    let late = LogisticRamp::new(1e5, 1e4, 50.0, SHORTFALL).unwrap();
    for (x, from_symmetric, from_late) in [
        (1e-9, 1.999_999_999_999_204e-12, 4.851_647_256_398_647_03e-6),
        (0.5, 0.000_999_801_052_918_164_588, 17.196_669_174_392_160_6),
        (1.0, 0.001_999_204_423_218_714_23, 18.928_252_399_691_145_7),
        (1000.0, 1.471_690_860_700_587_8, 36.201_350_662_809_668_8),
    ] {
        close(symmetric.crossing(x), from_symmetric, 4e-15);
        close(late.crossing(x), from_late, 2e-14);
        close(symmetric.position(from_symmetric), x, 2e-14);
        close(late.position(from_late), x, 2e-14);
    }
}

/// The first jerk segment is v t + j t^3 / 6; either term may be the larger one.
#[test]
fn scurve_crossing_is_exact_near_rest() {
    for (start, x, t) in [
        (0.0, 1e-9, 0.000_018_171_205_928_321_396_6),
        (1e-3, 1e-9, 9.998_334_166_111_535_14e-7),
        (1e-3, 0.5, 0.014_422_357_030_819_218),
        (100.0, 0.5, 0.004_814_056_002_208_402_7),
        (100.0, 1e-9, 1e-11),
    ] {
        let ramp = ScurveRamp::new(start, 1e5, 1e5, 1e6).unwrap();
        close(ramp.crossing(x), t, 1e-15);
        close(ramp.position(t), x, 1e-15);
    }
}

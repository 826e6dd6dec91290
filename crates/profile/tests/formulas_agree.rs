//! Tests the profiles against the golden planning cases of the article, against each other's
//! definitions (speed is the derivative of position, and `crossing` is its inverse), and at their
//! limits.

use carrystep_profile::{Constant, Limit, Limits, Profile, Ramp, rule};
use proptest::prelude::*;
use serde_json::Value;

fn golden() -> Value {
    serde_json::from_str(include_str!("../../../tests/golden/ranade.json")).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| value.as_str().unwrap().parse().unwrap())
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-13 * a.abs().max(b.abs())
}

#[test]
fn planning_cases_of_the_article_are_reproduced() {
    let shapes = ["triangle", "refused", "constant"];
    for (case, shape) in golden()["planning_cases"].as_array().unwrap().iter().zip(shapes) {
        let get = |key: &str| number(&case[key]);
        let limits = Limits {
            start_speed: get("start"),
            speed: get("limit"),
            acceleration: get("acc_limit"),
            jerk: f64::INFINITY,
        };
        let (n, t) = (get("N"), get("T"));
        let least = rule::ranade_least_time(n, &limits);
        assert!(close(least, get("t_min")), "{least}");
        match rule::ranade(n, t, &limits) {
            Ok(profile) => {
                assert_eq!(profile.shape(), shape);
                if shape == "triangle" {
                    assert!(close(profile.acceleration(0.1), get("tri_acc")));
                    assert!(close(profile.speed(t / 2.0), get("tri_top")));
                } else {
                    assert_eq!(profile.speed(0.1), get("required_average"));
                }
            }
            Err(refusal) => {
                assert_eq!((shape, refusal.limit), ("refused", Limit::Acceleration));
                assert!(
                    close(refusal.wanted, number(&case["trap_at_speed_limit"]["acc"])),
                    "{refusal}"
                );
                assert!(close(refusal.least_time.unwrap(), get("t_min")));
            }
        }
        assert!(rule::ranade(n, least, &limits).is_ok());
        assert!(rule::ranade(n, least * (1.0 - 1e-13), &limits).is_err());
    }
}

#[test]
fn pulse_times_of_the_articles_ramp_are_exact() {
    let golden = golden();
    let case = &golden["conventional_euler"];
    let ramp = Ramp::triangle(1000.0, 0.5, number(&case["start"]), number(&case["acc"]));
    assert!(close(ramp.crossing(10.0), number(&case["t_10_exact"])));
    assert!(close(ramp.crossing(500.0), number(&case["t_500_exact"])));
    assert!(close(0.5 - ramp.crossing(990.0), number(&case["t_10_exact"])));
}

#[test]
fn trapezoid_takes_the_smaller_root() {
    // 1000 steps in 0.5 s at 25000 steps/s^2: the larger root would be 9683 steps/s with a negative
    // cruise.
    let limits =
        Limits { start_speed: 0.0, speed: 5000.0, acceleration: 25000.0, jerk: f64::INFINITY };
    let ramp = rule::trapezoid(1000.0, 0.5, &limits).unwrap();
    let expected = (25000.0 * 0.5 - (12500.0_f64.powi(2) - 4.0 * 25000.0 * 1000.0).sqrt()) / 2.0;
    assert!(close(ramp.top_speed(), expected) && expected < 5000.0);
    assert!(close(ramp.mean_speed(0.0, 0.5) * 0.5, 1000.0));
}

#[test]
fn constant_speed_is_refused_without_a_start_speed() {
    let mut limits =
        Limits { start_speed: 0.0, speed: 5000.0, acceleration: 25000.0, jerk: f64::INFINITY };
    let refusal = rule::constant(10.0, 100.0, &limits).unwrap_err();
    assert_eq!((refusal.limit, refusal.least_time), (Limit::StartSpeed, None));
    limits.start_speed = 100.0;
    assert_eq!(rule::constant(10.0, 0.1, &limits).unwrap(), Constant::new(10.0, 0.1));
    assert_eq!(rule::constant(10.0, 0.05, &limits).unwrap_err().wanted, 200.0);
}

fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

fn limits() -> impl Strategy<Value = Limits<f64>> {
    let start = prop_oneof![Just(0.0), 0.0..1.0, Just(1.0)];
    (decades(1.0, 1e6), start, decades(1.0, 1e8)).prop_map(|(speed, start, acceleration)| Limits {
        start_speed: speed * start,
        speed,
        acceleration,
        jerk: f64::INFINITY,
    })
}

/// Checks the properties of any profile of `n` steps in `t` seconds under `limits`.
fn check(
    profile: &dyn Profile<f64>,
    n: f64,
    t: f64,
    limits: &Limits<f64>,
) -> Result<(), TestCaseError> {
    prop_assert_eq!((profile.distance(), profile.duration()), (n, t));
    prop_assert!(
        close(profile.mean_speed(0.0, t) * t, n),
        "adds up: {} {n}",
        profile.mean_speed(0.0, t) * t
    );
    prop_assert!(profile.speed(0.0) <= limits.start_speed * (1.0 + 1e-15), "start speed");
    prop_assert!(
        (profile.position(t / 2.0 * (1.0 - 1e-15)) - n / 2.0).abs() <= 1e-11 * n,
        "the halves meet"
    );
    let mut last = 0.0;
    for i in 0..=200 {
        let fraction = f64::from(i) / 200.0;
        let (time, x) = (fraction * t, fraction * n);
        prop_assert!(profile.speed(time) <= limits.speed * (1.0 + 1e-14), "speed");
        prop_assert!(
            profile.acceleration(time).abs() <= limits.acceleration * (1.0 + 1e-14),
            "acceleration"
        );
        let crossing = profile.crossing(x);
        prop_assert!(crossing >= last && crossing <= t, "crossings ascend");
        last = crossing;
        let back = profile.position(crossing);
        prop_assert!((back - x).abs() <= 1e-11 * n, "crossing inverts position: {x} {back}");
        let step = (t - time).min(t / 1000.0);
        let moved = profile.position(time + step) - profile.position(time);
        let mean = profile.mean_speed(time, time + step);
        prop_assert!(
            (moved - mean * step).abs() <= 1e-11 * n,
            "mean speed: {moved} {}",
            mean * step
        );
        prop_assert!(mean <= limits.speed * (1.0 + 1e-14));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn speed_position_and_crossing_are_consistent(n in 1_u64..1_000_000_000, limits in limits(), more in prop_oneof![Just(1.0), 1.0..1.001, 1.0..100.0]) {
        let n = n as f64;
        let t = rule::ranade_least_time(n, &limits) * more;
        check(&*rule::ranade(n, t, &limits).unwrap(), n, t, &limits)?;
        let t = rule::trapezoid_least_time(n, &limits) * more;
        check(&rule::trapezoid(n, t, &limits).unwrap(), n, t, &limits)?;
        if limits.start_speed > 0.0 {
            let t = rule::constant_least_time(n, &limits).unwrap() * more;
            check(&rule::constant(n, t, &limits).unwrap(), n, t, &limits)?;
        }
    }

    #[test]
    fn less_than_the_least_time_is_refused(n in 1_u64..1_000_000_000, limits in limits(), less in 0.01..0.9999999) {
        let n = n as f64;
        let refused = rule::ranade(n, rule::ranade_least_time(n, &limits) * less, &limits);
        // A move that is slower than the start speed is never too fast.
        if let Ok(profile) = refused {
            prop_assert_eq!(profile.shape(), "constant");
        }
        let refusal = rule::trapezoid(n, rule::trapezoid_least_time(n, &limits) * less, &limits).unwrap_err();
        prop_assert!(refusal.wanted > refusal.available);
    }

    #[test]
    fn crossing_near_rest_keeps_full_precision(a in decades(1e-3, 1e8), exponent in -60_i32..0) {
        // The motion from rest is x = a t^2 / 2, down to 2^-60 of the way; by symmetry this holds
        // at both ends.
        let ramp = Ramp::triangle(a / 2.0, 2.0_f64.sqrt(), 0.0, a);
        let x = a / 4.0 * 2_f64.powi(exponent);
        prop_assert!(close(ramp.crossing(x), (2.0 * x / a).sqrt()));
    }
}

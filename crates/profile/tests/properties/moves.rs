//! Properties of moves of every kind, from 0.001 to 10 million steps/s and from one step to 2^31
//! steps.

use super::decades;
use super::laws::{Slack, hold};
use carrystep_core::ProfileKind;
use carrystep_profile::kinds;
use carrystep_profile::rule::{
    logistic, logistic_least_time, scurve, scurve_least_time, scurve_to,
};
use carrystep_profile::rule::{scurve_to_least_time, sine, sine_least_time};
use carrystep_profile::{Curve, Limits, Real};
use proptest::prelude::*;

fn limits() -> impl Strategy<Value = Limits<f64>> {
    // A start speed of 0 and an unlimited jerk are separate cases.
    let start = prop_oneof![Just(0.0), decades(1e-6, 1.0)];
    let bend = prop_oneof![Just(f64::INFINITY), decades(1e-3, 1e6)];
    (decades(1e-3, 1e7), start, decades(1e-3, 1e5), bend).prop_map(
        |(speed, start, per_second, bend)| Limits {
            start_speed: start * speed,
            speed,
            acceleration: speed * per_second,
            jerk: speed * per_second * bend,
        },
    )
}

fn steps() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(1.0),
        decades(1.0, 2.0_f64.powi(31)).prop_map(f64::round),
        Just(2.0_f64.powi(31))
    ]
}

/// The kinds that cubic segments only approximate; the others are tested one by one.
fn fitted() -> impl Strategy<Value = ProfileKind> {
    let kinds = ProfileKind::ALL.iter().copied().filter(|kind| kind.is_fitted());
    prop::sample::select(kinds.collect::<Vec<_>>())
}

/// A time as a multiple of the least time.
fn patience() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1.0), decades(1.0 + 1e-9, 1.001), decades(1.0, 1e4)]
}

#[track_caller]
fn check<F: Real>(ramped: &dyn Curve<F>, distance: F, time: F, limits: &Limits<F>) {
    assert_eq!((ramped.distance(), ramped.duration()), (distance, time));
    hold(ramped, &Slack { rounding: 64.0, quadrature: 1e4 });
    keeps(ramped, limits);
}

/// Asserts that no limit is exceeded, by the figures and by samples.
#[track_caller]
fn keeps<F: Real>(ramped: &dyn Curve<F>, limits: &Limits<F>) {
    let loose = F::one() + F::from(16.0).unwrap() * F::epsilon();
    let figures = ramped.figures();
    assert!(figures.top_speed <= limits.speed, "{figures:?} {limits:?}");
    assert!(figures.peak_acceleration <= limits.acceleration * loose, "{figures:?} {limits:?}");
    assert!(figures.peak_jerk <= limits.jerk * loose, "{figures:?} {limits:?}");
    for i in 0..=64 {
        let t = ramped.duration() * F::from(f64::from(i) / 64.0).unwrap();
        assert!(ramped.speed(t) <= figures.top_speed && ramped.speed(t) >= F::zero());
        assert!(ramped.acceleration(t).abs() <= figures.peak_acceleration * loose);
        assert!(ramped.jerk(t).abs() <= figures.peak_jerk * loose);
    }
}

/// Asserts that the ramp down is the ramp up mirrored in time.
#[track_caller]
fn mirrored(ramped: &dyn Curve<f64>) {
    let (duration, distance) = (ramped.duration(), ramped.distance());
    for i in 0..=64 {
        let t = duration * f64::from(i) / 64.0;
        let back = duration - t;
        let lost = 8.0 * f64::EPSILON * (distance + duration * ramped.top_speed());
        assert!((ramped.position(t) + ramped.position(back) - distance).abs() <= lost);
        let lost =
            8.0 * f64::EPSILON * (ramped.top_speed() + duration * ramped.peak_acceleration());
        assert!((ramped.speed(t) - ramped.speed(back)).abs() <= lost);
    }
}

proptest! {
    #[test]
    fn fitted_moves_obey_all_laws_and_limits(
        kind in fitted(),
        distance in steps(),
        limits in limits(),
        patience in patience(),
    ) {
        let time = kinds::least_time(kind, distance, &limits).unwrap() * patience;
        let curve = kinds::whole(kind, distance, time, &limits).unwrap();
        check(&*curve, distance, time, &limits);
        mirrored(&*curve);
    }

    #[test]
    fn logistic_moves_start_below_the_start_speed(
        distance in steps(),
        limits in limits(),
        patience in patience(),
    ) {
        let time = logistic_least_time(distance, &limits) * patience;
        let ramped = logistic(distance, time, &limits).unwrap();
        let start = ramped.figures().start_speed;
        prop_assert!(limits.start_speed == 0.0 || start <= limits.start_speed * (1.0 + 1e-12));
        prop_assert!(start <= ramped.top_speed() / 199.0 * (1.0 + 1e-12));
    }

    #[test]
    fn sine_moves_start_and_end_at_rest(distance in steps(), limits in limits(), patience in patience()) {
        let time = sine_least_time(distance, &limits) * patience;
        let ramped = sine(distance, time, &limits).unwrap();
        prop_assert_eq!(ramped.figures().start_speed, 0.0);
        prop_assert_eq!(ramped.figures().end_speed, 0.0);
    }

    #[test]
    fn scurve_moves_obey_all_laws_and_limits(distance in steps(), limits in limits(), patience in patience()) {
        let time = scurve_least_time(distance, &limits) * patience;
        let ramped = scurve(distance, time, &limits).unwrap();
        check(&ramped, distance, time, &limits);
        mirrored(&ramped);
        prop_assert_eq!(ramped.figures().start_speed, limits.start_speed.min(ramped.top_speed()));
    }

    #[test]
    fn scurve_moves_with_another_end_speed_obey_all_laws_and_limits(distance in steps(), limits in limits(), patience in patience(), end in 0.0..1.0) {
        let end_speed = end * limits.speed;
        let time = scurve_to_least_time(distance, end_speed, &limits) * patience;
        let ramped = scurve_to(distance, time, end_speed, &limits).unwrap();
        check(&ramped, distance, time, &limits);
        prop_assert_eq!(ramped.figures().start_speed, limits.start_speed.min(ramped.top_speed()));
        prop_assert_eq!(ramped.figures().end_speed, end_speed.min(ramped.top_speed()));
    }

    #[test]
    fn moves_computed_in_f32_obey_all_laws_and_limits(distance in decades(1.0, 1e6), limits in limits(), patience in 1.0..3.0) {
        let [distance, patience] = [distance.round(), patience].map(|x: f64| x as f32);
        let limits = Limits {
            start_speed: limits.start_speed as f32,
            speed: limits.speed as f32,
            acceleration: limits.acceleration as f32,
            jerk: limits.jerk as f32,
        };
        for kind in ProfileKind::ALL.iter().copied().filter(|kind| kind.is_fitted()) {
            let time = kinds::least_time(kind, distance, &limits).unwrap() * patience;
            check(&*kinds::whole(kind, distance, time, &limits).unwrap(), distance, time, &limits);
        }
        let time = scurve_least_time(distance, &limits) * patience;
        check(&scurve(distance, time, &limits).unwrap(), distance, time, &limits);
    }
}

//! Tests that the least time is the least one, and that a refusal names a value that works.

use super::decades;
use carrystep_profile::rule::{
    logistic, logistic_least_time, scurve, scurve_least_time, sine, sine_least_time,
};
use carrystep_profile::{Curve, Limit, LimitRefusal, Limits, Profile, RampedMove};
use proptest::prelude::*;

/// A kind of profile, with the function that plans a move in a given time and the one that returns
/// the least time.
trait Kind {
    type Ramp: Curve<f64>;
    fn least(&self, distance: f64, limits: &Limits<f64>) -> f64;
    fn plan(
        &self,
        distance: f64,
        time: f64,
        limits: &Limits<f64>,
    ) -> Result<RampedMove<f64, Self::Ramp>, LimitRefusal>;
}

macro_rules! kind {
    ($name:ident, $ramp:ident, $plan:ident, $least:ident) => {
        struct $name;

        impl Kind for $name {
            type Ramp = carrystep_profile::$ramp<f64>;

            fn least(&self, distance: f64, limits: &Limits<f64>) -> f64 {
                $least(distance, limits)
            }

            fn plan(
                &self,
                distance: f64,
                time: f64,
                limits: &Limits<f64>,
            ) -> Result<RampedMove<f64, Self::Ramp>, LimitRefusal> {
                $plan(distance, time, limits)
            }
        }
    };
}

kind!(Logistic, LogisticRamp, logistic, logistic_least_time);
kind!(Sine, SineRamp, sine, sine_least_time);
kind!(Scurve, ScurveRamp, scurve, scurve_least_time);

/// Checks that a move in its least time reaches a limit, that a shorter time is refused, and that
/// the value which the refusal names allows the shorter time.
fn refusals<K: Kind>(kind: &K, distance: f64, limits: &Limits<f64>, hurry: f64) {
    let least = kind.least(distance, limits);
    let fastest = kind.plan(distance, least, limits).unwrap();
    let figures = fastest.figures();
    // A top speed just above the start speed is known to an epsilon of itself and not of the
    // difference.
    let gain = figures.top_speed - figures.start_speed;
    let blur = 1e-7 + 4.0 * f64::EPSILON * figures.top_speed / gain;
    let touches = |value: f64, limit: f64| (value / limit - 1.0).abs() < blur;
    let steep = touches(figures.peak_acceleration, limits.acceleration)
        || touches(figures.peak_jerk, limits.jerk);
    let constant = figures.top_speed <= limits.start_speed;
    assert!(steep || constant, "{figures:?} {limits:?}");
    assert!(
        figures.top_speed == limits.speed || fastest.cruise_time() < blur * least,
        "{fastest:?}"
    );

    let time = least * hurry;
    let refusal = kind.plan(distance, time, limits).unwrap_err();
    assert_eq!(refusal.least_time, Some(least));
    let free = Limits { speed: f64::INFINITY, jerk: f64::INFINITY, ..*limits };
    let wanted = refusal.wanted;
    let (available, raised) = match refusal.limit {
        Limit::Acceleration => (limits.acceleration, Limits { acceleration: wanted, ..free }),
        Limit::Jerk => (limits.jerk, Limits { jerk: wanted, ..free }),
        Limit::Speed => (limits.speed, Limits { speed: wanted, ..*limits }),
        Limit::StartSpeed => panic!("{refusal}"),
    };
    assert_eq!(refusal.available, available);
    assert!(wanted > available && wanted.is_finite(), "{refusal}");
    assert!(kind.plan(distance, time, &raised).is_ok(), "{refusal}");
    let barely = available + (wanted - available) * 0.99;
    let lowered = match refusal.limit {
        Limit::Acceleration => Limits { acceleration: barely, ..free },
        Limit::Jerk => Limits { jerk: barely, ..free },
        _ => Limits { speed: barely, ..*limits },
    };
    assert!(kind.plan(distance, time, &lowered).is_err() || hurry > 0.999, "{refusal}");
}

proptest! {
    #[test]
    fn refusals_name_a_value_that_works_and_99_percent_of_the_raise_does_not(
        distance in decades(1.0, 1e7).prop_map(f64::round),
        speed in decades(1.0, 1e6),
        start in prop_oneof![Just(0.0), 0.0..1.0],
        per_second in decades(0.1, 1e3),
        bend in prop_oneof![Just(f64::INFINITY), decades(0.1, 1e3)],
        hurry in prop_oneof![0.1..0.99, Just(1.0 - 1e-9)],
    ) {
        let acceleration = speed * per_second;
        let limits = Limits { start_speed: start * speed, speed, acceleration, jerk: acceleration * bend };
        refusals(&Logistic, distance, &limits, hurry);
        refusals(&Sine, distance, &limits, hurry);
        refusals(&Scurve, distance, &limits, hurry);
    }

    /// In a longer time a move has a lower or equal top speed, for any two times; no limit is
    /// exceeded.
    #[test]
    fn longer_time_never_has_a_higher_top_speed(distance in decades(1.0, 1e7), times in prop::collection::vec(decades(1.0, 100.0), 2)) {
        let limits = Limits { start_speed: 100.0, speed: 1e5, acceleration: 1e6, jerk: 1e8 };
        let [short, long] = [times[0].min(times[1]), times[0].max(times[1])];
        let slower = |kind_least: f64, top: &dyn Fn(f64) -> f64| top(kind_least * short) >= top(kind_least * long);
        prop_assert!(slower(Sine.least(distance, &limits), &|t| Sine.plan(distance, t, &limits).unwrap().top_speed()));
        prop_assert!(slower(Scurve.least(distance, &limits), &|t| Scurve.plan(distance, t, &limits).unwrap().top_speed()));
    }

    #[test]
    fn invalid_limits_never_panic(numbers in prop::array::uniform6(any::<f64>()), at in any::<f64>()) {
        let [start_speed, speed, acceleration, jerk, distance, time] = numbers;
        let limits = Limits { start_speed, speed, acceleration, jerk };
        fn ask<R: Curve<f64>>(answer: Result<RampedMove<f64, R>, LimitRefusal>, at: f64) {
            match answer {
                Ok(curve) => {
                    let _ = (curve.position(at), curve.speed(at), curve.acceleration(at), curve.jerk(at));
                    let _ = (curve.crossing(at), curve.mean_speed(at, 1.0), curve.figures(), curve.breakpoints().len());
                }
                Err(refusal) => drop(refusal.to_string()),
            }
        }
        ask(Logistic.plan(distance, time, &limits), at);
        ask(Sine.plan(distance, time, &limits), at);
        ask(Scurve.plan(distance, time, &limits), at);
    }
}

#[test]
fn move_without_distance_is_at_rest() {
    let limits = Limits { start_speed: 0.0, speed: 1e4, acceleration: 1e5, jerk: 1e7 };
    let rest = Sine.plan(0.0, 0.5, &limits).unwrap();
    assert_eq!(
        (rest.duration(), rest.distance(), rest.speed(0.2), rest.position(0.2)),
        (0.5, 0.0, 0.0, 0.0)
    );
    assert_eq!(Sine.least(0.0, &limits), 0.0);
}

/// A move slower than the start speed, to which the motor jumps anyway, has constant speed, as in
/// Ranade's rule.
#[test]
fn scurve_below_the_start_speed_has_constant_speed() {
    let limits = Limits { start_speed: 500.0, speed: 1e4, acceleration: 1e5, jerk: 1e7 };
    let slow = Scurve.plan(100.0, 1.0, &limits).unwrap();
    assert_eq!((slow.shape(), slow.speed(0.3), slow.peak_acceleration()), ("constant", 100.0, 0.0));
    assert!(slow.breakpoints().is_empty());
}

//! Tests the trapezoid in a given time and the recurrences of Austin and AVR446 against the golden
//! numbers of `trapezoid_austin.json`.

use super::{Golden, TIGHT};
use carrystep_profile::rule::trapezoid;
use carrystep_profile::{Limit, Limits, Profile, Ramp};

/// The example of the source: 360 degrees at 1800 degrees/s^2 in one second, with 200 steps a turn.
struct Source {
    golden: Golden,
    steps_per_degree: f64,
    limits: Limits<f64>,
    steps: f64,
    time: f64,
}

impl Source {
    fn read() -> Self {
        let golden = Golden::read("trapezoid_austin");
        let input = |name: &str| golden.number(&format!("/example/{name}"));
        let steps_per_degree = input("gear") * input("steps_per_rev") / 360.0;
        let acceleration = input("alpha_deg_s2") * steps_per_degree;
        let limits =
            Limits { start_speed: 0.0, speed: f64::INFINITY, acceleration, jerk: f64::INFINITY };
        let (steps, time) = (input("theta_deg") * steps_per_degree, input("t_d_s"));
        Self { golden, steps_per_degree, limits, steps, time }
    }

    fn move_in_time(&self) -> Ramp<f64> {
        trapezoid(self.steps, self.time, &self.limits).unwrap()
    }

    #[track_caller]
    fn check(&self, pointer: &str, actual: f64) {
        self.golden.check(pointer, actual, TIGHT);
    }
}

#[test]
fn only_the_smaller_root_gives_a_move() {
    let source = Source::read();
    let ramp = source.move_in_time();
    let top = ramp.top_speed() / source.steps_per_degree;
    source.check("/omega_minus_valid", top);
    source.check("/t0", ramp.breakpoints()[0]);
    source.check("/t1", ramp.breakpoints()[1]);
    source.check("/t0_plus_t1", ramp.breakpoints()[0] + ramp.breakpoints()[1]);
    // The sum of the roots is alpha t_d. With the other root, the deceleration would begin before
    // the acceleration ends.
    let plus = 1800.0 - top;
    source.check("/omega_plus_invalid", plus);
    source.check("/plus_root/t0", plus / 1800.0);
    source.check("/plus_root/t1", 1.0 - plus / 1800.0);
}

#[test]
fn too_short_a_time_names_the_acceleration_that_is_needed() {
    let source = Source::read();
    let least = source.golden.number("/alpha_min_for_td");
    let acceleration = least * source.steps_per_degree;
    let barely = Limits { acceleration, ..source.limits };
    assert!(trapezoid(source.steps, source.time, &barely).is_ok());
    let short = Limits { acceleration: 0.999 * acceleration, ..source.limits };
    let refusal = trapezoid(source.steps, source.time, &short).unwrap_err();
    assert_eq!(refusal.limit, Limit::Acceleration);
    source.check("/alpha_min_for_td", refusal.wanted / source.steps_per_degree);
}

/// The source's third segment, -alpha (t - t1), jumps to 0 at t1. Its area is negative, so that
/// most of the distance of the deceleration is lost.
#[test]
fn third_segment_as_printed_jumps_and_loses_distance() {
    let source = Source::read();
    let ramp = source.move_in_time();
    let (degrees, [t0, t1]) =
        (1.0 / source.steps_per_degree, [ramp.breakpoints()[0], ramp.breakpoints()[1]]);
    source.check("/third_segment/area_corrected_deg", ramp.distance() * degrees);
    let middle = t1 + 0.1;
    assert!((ramp.speed(middle) * degrees - 1800.0 * (t0 + t1 - middle)).abs() < 1e-9);
    let third = 1800.0 * t0 * t0 / 2.0;
    source.check("/third_segment/area_printed_deg", ramp.position(t1) * degrees - third);
    source.check("/third_segment/printed_value", 1800.0 * t0 * (t1 - t0));
    source.check("/third_segment/jump_at_t1_deg_s", -ramp.speed(t1) * degrees);
}

#[test]
fn equations_6_and_7_give_step_numbers_and_not_times() {
    let source = Source::read();
    let ramp = source.move_in_time();
    let [t0, t1] = [ramp.breakpoints()[0], ramp.breakpoints()[1]];
    source.check("/units/N", source.steps_per_degree);
    source.check("/units/steps", source.steps);
    source.check("/units/eq6_is_steps_not_time/n_acc = omega^2 N~1(2 alpha)", ramp.position(t0));
    source.check("/units/eq7_step_where_decel_starts", ramp.position(t1));
    source.check("/units/t0_true_s", t0);
    source.check("/units/t1_true_s", t1);
}

/// Compares c_n = c_0 (sqrt(n + 1) - sqrt(n)) with c_n = c_(n-1) - 2 c_(n-1) / (4 n + 1).
#[test]
fn delays_and_their_recurrence_equal_the_golden_numbers() {
    let source = Source::read();
    let timer = source.golden.number("/example/f_timer_Hz");
    let ramp = source.move_in_time();
    let delay = |n: u32| (ramp.crossing(f64::from(n + 1)) - ramp.crossing(f64::from(n))) * timer;
    let recurrence =
        |start: f64, n: u32| (1..=n).fold(start, |c, n| c - 2.0 * c / f64::from(4 * n + 1));
    let c0 = delay(0);
    source.check("/austin/c0_exact_ticks", c0);
    for n in [0, 1, 2, 10] {
        source.check(&format!("/austin/exact_c_n/{n}"), delay(n));
    }
    // Step 100 is beyond the ramp of this move. A longer move with the same acceleration has it.
    let acceleration = source.limits.acceleration;
    let long: Ramp<f64> =
        Ramp::triangle(1000.0, 2.0 * (1000.0 / acceleration).sqrt(), 0.0, acceleration);
    source.check("/austin/exact_c_n/100", (long.crossing(101.0) - long.crossing(100.0)) * timer);
    for n in [0, 1, 2, 10, 100] {
        source.check(&format!("/austin/rec_from_c0/{n}"), recurrence(c0, n));
        source.check(&format!("/austin/rec_from_0.676c0/{n}"), recurrence(0.676 * c0, n));
    }
    let (c6, c7) = (recurrence(c0, 6), recurrence(c0, 7));
    source.check("/decel_mirror/check_m=7", c7 * 29.0 / 27.0 / c6);
    source.check("/austin/c1_over_c0_exact", delay(1) / c0);
    source.check("/austin/c1_over_c0_rec", recurrence(1.0, 1));
    source.check("/austin/c1_ratio_rec_over_exact", recurrence(c0, 1) / delay(1));
    // 2 Gamma(3/4) / Gamma(1/4) is the limit of the quotient of exact delay and recurrence. The
    // error is of order 1/n^2.
    let n = 1_000_000;
    let exact = 1.0 / (f64::from(n + 1).sqrt() + f64::from(n).sqrt());
    let factor = exact / recurrence(1.0, n);
    source.golden.check("/austin/ideal_c0_factor = 2 Gamma(3~14)~1Gamma(1~14)", factor, 1e-9);
    source.golden.check("/austin/asymptotic_ratio_rec_over_exact", 1.0 / factor, 1e-9);
    source.golden.check("/austin/rel_diff_of_0.676", 0.676 / factor - 1.0, 1e-4);
}

/// The integer recurrence of AVR446, with the remainder carried over and with the remainder
/// dropped.
#[test]
fn recurrence_without_remainder_is_57_percent_too_slow_at_step_1000() {
    let source = Source::read();
    let start = source.golden.number("/avr446_integer/c0_int") as i64;
    let kept = |n: i64| {
        let (mut c, mut rest) = (start, 0);
        for n in 1..=n {
            let dividend = 2 * c + rest;
            (c, rest) = (c - dividend / (4 * n + 1), dividend % (4 * n + 1));
        }
        c
    };
    let dropped = |n: i64| (1..=n).fold(start, |c, n| c - 2 * c / (4 * n + 1));
    for n in 0..12 {
        source.check(&format!("/avr446_integer/first_12/{n}"), kept(n) as f64);
        source.check(&format!("/avr446_integer/without_rest_first_12/{n}"), dropped(n) as f64);
    }
    source.check("/avr446_integer/c_100", kept(100) as f64);
    source.check("/avr446_integer/without_rest_c_1000", dropped(1000) as f64);
    let exact =
        source.golden.number("/austin/c0_exact_ticks") / (1001.0_f64.sqrt() + 1000.0_f64.sqrt());
    source.check("/avr446_integer/exact_c_1000", exact);
    assert_eq!(
        (dropped(1000) as f64 / exact * 100.0 - 100.0).round(),
        57.0,
        "per cent too slow at step 1000"
    );
}

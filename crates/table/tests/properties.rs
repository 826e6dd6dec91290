//! Tests properties that hold for every ramp, not only for the golden ones.

use crate::support::{Bench, run};
use carrystep_table::austin::{ConstantAcceleration, FloatRecurrence, IntegerRecurrence};
use carrystep_table::sine::{Sine, distance, speed};
use carrystep_table::{
    Arithmetic, Kind, Motor, Options, Pulses, Speed, Table, TableRequest, Timer, TimerMode,
};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// The bound that the documentation of `IntegerRecurrence` states.
    #[test]
    fn integer_recurrence_stays_within_its_bound_of_the_float_recurrence(first in 1_u32..=65_536, quarters in prop_oneof![Just(0_u64), 0_u64..100_000]) {
        let floats = FloatRecurrence::new(f64::from(first), quarters as f64 / 4.0);
        for (n, (whole, float)) in IntegerRecurrence::new(first, quarters).zip(floats).take(20_000).enumerate() {
            let error = f64::from(whole) - float;
            prop_assert!((-1.0..=2.5).contains(&error), "c_{n} is {whole}, {float} in floats");
        }
    }

    /// With its own first delay, the recurrence keeps constant acceleration: the error is 2.1 % at
    /// the second step and always below 3 / 64 n^2.
    #[test]
    fn recurrence_keeps_constant_acceleration(acceleration in 1.0..1e6, n in 1_u32..1_000_000) {
        let ramp = ConstantAcceleration { timer: 1e6, acceleration };
        let n = f64::from(n);
        let error = ramp.delay(n) / ramp.exact_delay(n) - 1.0;
        prop_assert!(error.abs() <= 3.0 / (64.0 * n * n) + 1e-14, "{error} at {n}");
    }

    /// The time of a step, inserted into the curve, gives that step again.
    #[test]
    fn crossings_are_the_inverse_of_the_curve(start in prop_oneof![Just(0.0_f64), 0.0_f64..5000.0], rise in 1e-3_f64..1e5, steps in 1_u32..100_000, share in 0.0_f64..1.0) {
        let curve = Sine { start, top: start + rise, steps: f64::from(steps) };
        let n = (f64::from(steps) * share).ceil();
        let u = curve.crossing(n) / curve.time();
        let back = curve.time() * (start * u + rise * distance(u));
        // steps per unit of the relative error of u
        let slope = u * (start + rise * speed(u)) * curve.time();
        prop_assert!((back - n).abs() <= 4.0 * f64::EPSILON * (slope + n), "{n} gives {back}");
        prop_assert!(n >= f64::from(steps) || curve.crossing(n) < curve.crossing(n + 1.0));
    }

    /// Both arithmetics give one ramp, and it ends at the top speed.
    #[test]
    fn avr446_ramp_ends_at_the_top_speed_in_both_arithmetics(ramp_steps in 2_u32..2000, start in prop_oneof![Just(0.0), 10.0..400.0], top in 500.0..4000.0) {
        let timer = Timer::avr16(2_000_000, 8, TimerMode::Ctc);
        let make = |arithmetic| Table::new(TableRequest {
            timer: timer.clone(),
            motor: Motor { step_angle_deg: 1.8, microsteps: 1 },
            start_frequency: start,
            top_speed: Speed::StepsPerSecond(top),
            kind: Kind::Avr446 { ramp_steps, arithmetic },
            pulses: Pulses::One,
        });
        let (Ok(float), Ok(integer)) = (make(Arithmetic::Float), make(Arithmetic::Integer)) else { return Ok(()) };
        prop_assert!(float.compare().is_sorted_by(|a, b| a >= b));
        prop_assert!(integer.compare().iter().all(|&c| c >= integer.cruise()));
        for (a, b) in float.compare().iter().zip(integer.compare()) {
            prop_assert!(a.abs_diff(*b) <= 3, "{a} {b}");
        }
        // The last delay is the mean over the last step, which is half a step's acceleration below
        // the top speed.
        let last = 250_000.0 / float.ideal_delays()[ramp_steps as usize - 1];
        let expected = top * (1.0 - (top * top - start * start) / (top * top) / (4.0 * f64::from(ramp_steps)));
        prop_assert!((last / expected - 1.0).abs() < 0.5 / f64::from(ramp_steps), "{last} {expected}");
    }
}

/// The controller reads the small inverse table in integers. Its ramp differs from the curve by at
/// most the error of the table, the rounding of its words, and half a count.
#[test]
fn ramp_computed_on_the_controller_stays_within_its_error_bound() {
    let request = TableRequest {
        timer: Timer::avr16(16_000_000, 64, TimerMode::Ctc),
        motor: Motor { step_angle_deg: 1.8, microsteps: 8 },
        start_frequency: 0.0,
        top_speed: Speed::StepsPerSecond(10_000.0),
        kind: Kind::Sine { ramp_steps: 1000, inverse: Some(256) },
        pulses: Pulses::One,
    };
    let table = Table::new(request).unwrap();
    let bench = Bench::new(&table.header(&Options::new("ramp").unwrap()));
    bench.write("sine.c", include_str!("bench/sine_bench.c"));
    let program = bench.compile(&["sine.c", "carrystep_sine.c", "carrystep_player.c"]).unwrap();
    for (steps, counts) in [
        (1, 5),
        (2, 60_000),
        (10, 60_000),
        (1000, 50_000),
        (1000, 250_000),
        (777, 31_111),
        (20_000, 1_000_000),
    ] {
        let text = run(&program, &[steps.to_string(), counts.to_string()]).unwrap();
        let delays: Vec<u32> =
            text.lines().map(|line| line.parse().unwrap_or_else(|_| panic!("{line}"))).collect();
        assert_eq!(delays.len() as u32, steps);
        let curve = Sine { start: 0.0, top: 2.0, steps: 1.0 };
        let bound = (1.2e-5 + 0.5 / 65_535.0) * f64::from(counts) + 0.5;
        let mut sum = 0;
        for (n, delay) in delays.into_iter().enumerate() {
            sum += delay + 1; // CTC
            let ideal = f64::from(counts) * curve.crossing((n + 1) as f64 / f64::from(steps));
            assert!(
                (f64::from(sum) - ideal).abs() <= bound,
                "{steps} steps in {counts}: step {n} at {sum}, {ideal}"
            );
        }
        assert_eq!(sum, counts);
    }
    // A first delay of 265 610 counts, more steps than counts, and no steps.
    for bad in [["1000", "2000000"], ["100", "50"], ["0", "1000"]] {
        assert_eq!(run(&program, &bad.map(str::to_owned)).unwrap(), "refused\n");
    }
}

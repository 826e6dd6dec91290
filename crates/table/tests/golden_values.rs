//! Tests all golden values of the timer tables, of the Austin recurrence and of the small inverse
//! table.

use carrystep_table::austin::{
    ConstantAcceleration, FIRST_DELAY, FloatRecurrence, IntegerRecurrence,
};
use carrystep_table::logistic::Logistic;
use carrystep_table::sine::{self, Sine};
use carrystep_table::{
    InverseTable, Kind, Motor, Pulses, Speed, Table, TableRequest, Timer, TimerMode,
};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::f64::consts::PI;

fn golden(text: &str) -> Value {
    serde_json::from_str(text).expect("a golden file")
}

fn timer_table() -> Value {
    golden(include_str!("../../../tests/golden/timer_table.json"))
}

fn austin() -> Value {
    golden(include_str!("../../../tests/golden/trapezoid_austin.json"))
}

fn sinusoid() -> Value {
    golden(include_str!("../../../tests/golden/sinusoid.json"))
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .or_else(|| value.as_str()?.parse().ok())
        .unwrap_or_else(|| panic!("{value} is no number"))
}

#[track_caller]
fn close(value: f64, golden: &Value) {
    let golden = number(golden);
    assert!((value - golden).abs() <= 1e-12 * golden.abs(), "{value:?}, golden {golden:?}");
}

/// For differences of nearly equal numbers the golden digits hold only to the rounding of the
/// operands.
#[track_caller]
fn close_to(value: f64, golden: &Value, absolute: f64) {
    let golden = number(golden);
    assert!((value - golden).abs() <= absolute, "{value:?}, golden {golden:?}");
}

fn whole(value: &Value) -> Vec<u32> {
    value
        .as_array()
        .expect("a list")
        .iter()
        .map(|v| u32::try_from(v.as_u64().expect("whole")).expect("32 bits"))
        .collect()
}

const MOTOR: Motor = Motor { step_angle_deg: 1.8, microsteps: 8 };
const F: f64 = 250_000.0;

fn logistic(start_frequency: f64, entries: u32, mode: TimerMode, pulses: Pulses) -> Table {
    let kind = Kind::Logistic { entries, steepness: 6.0, centre: None };
    let timer = Timer::avr16(16_000_000, 64, mode);
    let top_speed = Speed::Rpm(500.0);
    Table::new(TableRequest { timer, motor: MOTOR, start_frequency, top_speed, kind, pulses })
        .expect("a table")
}

fn counts(table: &Table) -> Vec<u32> {
    table.compare().iter().map(|&c| table.request().timer.counts(c)).collect()
}

#[test]
fn speeds_and_compare_values_equal_the_golden_values() {
    let golden = &timer_table()["ocr"];
    let full = Motor { microsteps: 1, ..MOTOR };
    close(F / full.steps_per_second(300.0), &golden["300rpm_div1_exact"]);
    close(F / MOTOR.steps_per_second(500.0), &golden["500rpm_div8_exact"]);
    close(MOTOR.steps_per_second(500.0), &golden["f_500rpm_div8_exact_Hz"]);
    close(MOTOR.rpm(F / 19.0), &golden["real_rpm_with_19_counts"]);
    close(MOTOR.rpm(F / 20.0), &golden["real_rpm_if_OCR1A=19 (CTC period OCR+1=20)"]);
    assert_eq!(golden["integer_OCR_500rpm"], (F / MOTOR.steps_per_second(500.0)).round() as u32);
    close(
        MOTOR.rpm(40_000.0 / 3.0),
        &timer_table()["wrong_lines"]["rpm_check_13333.33Hz_1.8_div8"],
    );
    // The values that follow from the constants 9.55 and 31.4 of the source.
    let share = 9.55 * PI / 30.0;
    close(250.0 * share, &golden["300rpm_div1_9.55"]);
    close(18.75 * share, &golden["500rpm_div8_9.55"]);
    close(MOTOR.steps_per_second(500.0) / share, &golden["f_500rpm_div8_9.55_Hz"]);
    close(250.0 * 10.0 * PI / 31.4, &golden["300rpm_with_31.4"]);
    close(30.0 / PI, &golden["9.55_vs_30/pi"]);
    close_to(share - 1.0, &golden["rel_error_of_9.55"], 1e-15);
}

#[test]
fn logistic_table_equals_the_golden_values() {
    let golden = &timer_table()["table_Fle_6"];
    let curve = Logistic {
        start: 500.0,
        top: MOTOR.steps_per_second(500.0),
        steepness: 6.0,
        centre: 500.0,
    };
    for i in [0, 500, 999] {
        close(curve.frequency(f64::from(i)), &golden[format!("f_{i}")]);
    }
    close(curve.frequency(0.0) / 500.0, &golden["start_jump_over_fmin"]);
    let peak = (0..1000)
        .map(|i| (curve.acceleration(f64::from(i)), i))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .expect("a peak");
    close(peak.0, &golden["peak_accel_steps_s2"]);
    assert_eq!(golden["peak_at_index"], peak.1);

    let free = logistic(500.0, 1000, TimerMode::FreeRunning, Pulses::One);
    let ocr: Vec<u32> = free.compare().iter().copied().map(u32::from).collect();
    assert_eq!(ocr[..10], whole(&golden["OCR_0..9"]));
    for i in [100, 250, 500, 750, 999] {
        assert_eq!(golden[format!("OCR_{i}")], ocr[i]);
    }
    assert_eq!(golden["sum_OCR_0..999"], ocr.iter().sum::<u32>());
    let text: Vec<String> = ocr.iter().map(u32::to_string).collect();
    let hash: String =
        Sha256::digest(text.join(",")).iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(golden["sha256_0..999"], hash);

    // The same delays for CTC: each value is one less. The values of a free-running timer would
    // make the ramp 4 ms longer.
    let ctc = logistic(500.0, 1000, TimerMode::Ctc, Pulses::One);
    assert!(ctc.compare().iter().zip(&ocr).all(|(&c, &f)| u32::from(c) + 1 == f));
    close(ctc.figures().ramp_seconds, &golden["ramp_time_OCR_s"]);
    close(ctc.figures().ramp_seconds + 1000.0 / F, &golden["ramp_time_if_OCR+1_s"]);
    close(ctc.figures().ramp_seconds_ideal, &golden["ramp_time_float_s"]);
    // The integral of di / f from 0 to 1000, by Simpson's rule.
    let slowness = |i: u32| 1.0 / curve.frequency(f64::from(i) / 8.0);
    let inner: f64 = (1..8000).map(|i| slowness(i) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
    close((slowness(0) + inner + slowness(8000)) / 24.0, &golden["ramp_time_integral_s"]);
}

#[test]
fn pulses_by_group_and_by_time_equal_the_golden_values() {
    let golden = &timer_table()["update_2018_08"];
    let bands = logistic(600.0, 600, TimerMode::Ctc, Pulses::ByGroup(whole(&golden["bands"])));
    assert_eq!(golden["total_pulses_bands"], bands.figures().ramp_pulses);
    close(bands.figures().ramp_seconds, &golden["time_bands_s"]);

    let table = logistic(600.0, 600, TimerMode::Ctc, Pulses::ByTime(1e-3));
    let mut sizes = vec![0_u32; 600];
    table.ramp_entries().for_each(|entry| sizes[entry] += 1);
    assert_eq!(sizes[..10], whole(&golden["cstep_first10"]));
    assert_eq!(golden["cstep_last"], sizes[599]);
    // The loop of the source ends before the last entry; the player here plays it.
    assert_eq!(golden["pulses_1ms"], sizes[..599].iter().sum::<u32>());
    assert_eq!(table.figures().ramp_pulses, 4479);
    let counts = counts(&table);
    let time = |extra: u32| (0..599).map(|i| (sizes[i] + extra) * counts[i]).sum::<u32>();
    close(f64::from(time(0)) / F, &golden["nominal_time_s"]);
    close(f64::from(time(1)) / F, &golden["bug_extra_interrupt_time_s"]);
    close(F / f64::from(2 * counts[0]), &golden["first_band_effective_Hz"]);
}

#[test]
fn austin_recurrence_equals_the_golden_values() {
    let file = austin();
    let golden = &file["austin"];
    let ramp = ConstantAcceleration { timer: 1e6, acceleration: 1000.0 };
    let c0 = ramp.exact_delay(0.0);
    close(c0, &golden["c0_exact_ticks"]);
    let places = |name: &str| golden[name].as_object().expect("values by index").clone();
    for (n, value) in places("exact_c_n") {
        close(ramp.exact_delay(n.parse().expect("an index")), &value);
    }
    for (start, name) in [(c0, "rec_from_c0"), (0.676 * c0, "rec_from_0.676c0")] {
        let delays: Vec<f64> = FloatRecurrence::new(start, 0.0).take(101).collect();
        for (n, value) in places(name) {
            close(delays[n.parse::<usize>().expect("an index")], &value);
        }
    }
    close(FIRST_DELAY, &golden["ideal_c0_factor = 2 Gamma(3/4)/Gamma(1/4)"]);
    close(1.0 / FIRST_DELAY, &golden["asymptotic_ratio_rec_over_exact"]);
    close_to(0.676 / FIRST_DELAY - 1.0, &golden["rel_diff_of_0.676"], 1e-15);
    close(ramp.exact_delay(1.0) / c0, &golden["c1_over_c0_exact"]);
    close(FloatRecurrence::new(1.0, 0.0).nth(1).expect("c_1"), &golden["c1_over_c0_rec"]);
    close(0.6 / (2_f64.sqrt() - 1.0), &golden["c1_ratio_rec_over_exact"]);
    // The closed form equals the recurrence that starts from its own first delay.
    for (n, delay) in FloatRecurrence::new(FIRST_DELAY * c0, 0.0).take(3000).enumerate() {
        assert!((delay / ramp.delay(n as f64) - 1.0).abs() < 1e-12, "c_{n}");
    }
    // The deceleration has the same values in reverse: c_(m-1) = c_m (4 m + 1) / (4 m - 1).
    close(ramp.delay(7.0) * 29.0 / 27.0 / ramp.delay(6.0), &file["decel_mirror"]["check_m=7"]);
}

#[test]
fn avr446_in_integers_equals_the_golden_values() {
    let golden = &austin()["avr446_integer"];
    let first = u32::try_from(golden["c0_int"].as_u64().expect("whole")).expect("32 bits");
    let delays: Vec<u32> = IntegerRecurrence::new(first, 0).take(1001).collect();
    assert_eq!(delays[..12], whole(&golden["first_12"]));
    assert_eq!(golden["c_100"], delays[100]);
    let ramp = ConstantAcceleration { timer: 1e6, acceleration: 1000.0 };
    close(ramp.exact_delay(1000.0), &golden["exact_c_1000"]);
    let printed =
        FloatRecurrence::new(0.676 * ramp.exact_delay(0.0), 0.0).nth(1000).expect("c_1000");
    close(printed, &golden["float_rec_0.676_c_1000"]);
    assert!(
        (f64::from(delays[1000]) - printed).abs() < 2.0,
        "the remainder is kept: {}",
        delays[1000]
    );
    // The recurrence without the remainder.
    let lossy: Vec<u32> = (1..=1000)
        .scan(first, |c, n| {
            *c -= 2 * *c / (4 * n + 1);
            Some(*c)
        })
        .collect();
    assert_eq!(lossy[..11], whole(&golden["without_rest_first_12"])[1..]);
    assert_eq!(golden["without_rest_c_1000"], lossy[999]);
}

#[test]
fn sine_curve_equals_the_golden_values() {
    let file = sinusoid();
    let curve = Sine { start: 0.0, top: 1e4, steps: 1000.0 };
    close(curve.time(), &file["example"]["T_s"]);
    close(curve.peak_acceleration(), &file["example"]["peak_accel"]);
    for (n, value) in file["t_n_s"].as_object().expect("times") {
        close(curve.crossing(n.parse().expect("an index")), value);
    }
    for (n, value) in file["u_n"].as_object().expect("times") {
        close(curve.crossing(n.parse().expect("an index")) / curve.time(), value);
    }
    let delay = |n: f64| curve.crossing(n + 1.0) - curve.crossing(n);
    close(delay(0.0), &file["c_0_first_delay_s"]);
    close(delay(1.0), &file["c_1_s"]);
    close(delay(999.0), &file["c_999_s"]);
    close(2.0 * sine::distance(0.5), &file["half_time"]["s(0.5)/s(1)"]);
    close(sine::speed(0.5), &file["half_time"]["v(0.5)/vmax"]);
}

#[test]
fn inverse_tables_have_the_golden_errors() {
    let file = sinusoid();
    let curve = Sine { start: 0.0, top: 2.0, steps: 1.0 };
    let worst = |lookup: &dyn Fn(f64) -> f64| {
        let error =
            |n: u32| (lookup(f64::from(n) / 1000.0) - curve.crossing(f64::from(n) / 1000.0)).abs();
        (0..=1000).map(|n| (error(n), n)).max_by(|a, b| a.0.total_cmp(&b.0)).expect("a worst step")
    };
    for intervals in [64_u32, 256, 1024] {
        let size = intervals.to_string();
        let table = InverseTable::new(intervals);
        let golden = &file["table_lookup_linear_interp_in_fourth_root_of_s"][&size];
        let (error, _) = worst(&|s| table.u(s));
        close_to(error, &golden["max_abs_err_u_at_steps_N1000"], 1e-15);
        close_to(error * 0.2e6, &golden["max_err_us_T0.2s"], 1e-9);
        // The table of the source, against s itself.
        let golden = &file["table_lookup_linear_interp"][&size];
        let (error, step) = worst(&|s| {
            let place = s * f64::from(intervals);
            let left = place.floor().min(f64::from(intervals - 1));
            let knot = |k: f64| curve.crossing(k / f64::from(intervals));
            knot(left) + (knot(left + 1.0) - knot(left)) * (place - left)
        });
        close_to(error, &golden["max_abs_err_u_at_steps_N1000"], 1e-15);
        assert_eq!(golden["at_step"], step);
        close_to(error * 0.2e3, &golden["max_err_ms_T0.2s"], 1e-9);
    }
}

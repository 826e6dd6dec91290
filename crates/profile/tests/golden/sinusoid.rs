//! Tests the sinusoidal S-curve against the golden numbers of `sinusoid.json`.

use super::{Golden, TIGHT};
use carrystep_profile::{Curve, Profile, ScurveRamp, SineRamp};
use std::f64::consts::PI;

fn example() -> (Golden, SineRamp<f64>) {
    let golden = Golden::read("sinusoid");
    let ramp = SineRamp::new(golden.number("/example/vmax_steps_s"), golden.number("/example/T_s"))
        .unwrap();
    (golden, ramp)
}

#[test]
fn ramp_figures_equal_the_golden_numbers() {
    let (golden, ramp) = example();
    golden.check("/example/N_ramp_steps", ramp.distance(), TIGHT);
    golden.check("/example/peak_accel", ramp.peak_acceleration(), TIGHT);
    golden.check("/example/mean_accel", ramp.top_speed() / ramp.duration(), TIGHT);
    golden.check("/example/peak_jerk", ramp.peak_jerk(), TIGHT);
    golden.check("/half_time/s(0.5)~1s(1)", ramp.position(0.1) / ramp.distance(), TIGHT);
    golden.check("/half_time/v(0.5)~1vmax", ramp.speed(0.1) / ramp.top_speed(), TIGHT);
    golden.check(
        "/snap_jump_example",
        (2.0 * PI).powi(2) * ramp.top_speed() / ramp.duration().powi(3),
        TIGHT,
    );
    let twice = SineRamp::with_acceleration(ramp.top_speed(), ramp.peak_acceleration()).unwrap();
    assert_eq!(twice, ramp);
}

#[test]
fn step_times_and_delays_equal_the_golden_numbers() {
    let (golden, ramp) = example();
    for n in [1, 2, 10, 500, 1000] {
        let t = ramp.crossing(f64::from(n));
        golden.check(&format!("/u_n/{n}"), t / ramp.duration(), TIGHT);
        golden.check(&format!("/t_n_s/{n}"), t, TIGHT);
    }
    golden.check("/c_0_first_delay_s", ramp.delay(0.0), TIGHT);
    golden.check("/c_1_s", ramp.delay(1.0), TIGHT);
    golden.check("/c_999_s", ramp.delay(999.0), TIGHT);
    golden.check("/small_u/exact", ramp.crossing(1.0) / ramp.duration(), TIGHT);
    golden.check("/small_u/value", (3.0 / (PI * PI * ramp.distance())).powf(0.25), TIGHT);
}

/// A trapezoid ramp of the same duration and steps has half the peak acceleration, and its first
/// step comes four times as early.
#[test]
fn trapezoid_of_the_same_duration_steps_earlier() {
    let (golden, ramp) = example();
    let mean = ramp.top_speed() / ramp.duration();
    let trapezoid = ScurveRamp::new(0.0, ramp.top_speed(), mean, f64::INFINITY).unwrap();
    assert_eq!((trapezoid.distance(), trapezoid.duration()), (ramp.distance(), ramp.duration()));
    golden.check("/trapezoid_same_duration_t1_s", trapezoid.crossing(1.0), TIGHT);
}

/// The source puts step n where f(x) = x^2/2 + cos x - 1 equals 2 pi n / N. But f runs to 2 pi^2
/// and not to 2 pi, so that its ramp ends early.
#[test]
fn step_formula_as_printed_ends_before_the_top_speed() {
    let (golden, ramp) = example();
    golden.check("/normalised/f(2pi)", 2.0 * PI * PI, TIGHT);
    golden.check("/normalised/2pi^2", 2.0 * PI * PI, TIGHT);
    let t = ramp.crossing(ramp.distance() / PI);
    golden.check("/seed_error_2pi_over_N/t_end_rad", t / ramp.duration() * 2.0 * PI, TIGHT);
    golden.check("/seed_error_2pi_over_N/u_end", t / ramp.duration(), TIGHT);
    golden.check("/seed_error_2pi_over_N/v_end_over_vmax", ramp.speed(t) / ramp.top_speed(), TIGHT);
    golden.check("/seed_error_2pi_over_N/ratio_correct_over_seed", PI, TIGHT);
}

/// A table of u at even steps of s^(1/root), read by linear interpolation.
struct Table<'a> {
    ramp: &'a SineRamp<f64>,
    root: i32,
    entries: Vec<f64>,
}

impl<'a> Table<'a> {
    fn new(ramp: &'a SineRamp<f64>, size: usize, root: i32) -> Self {
        let entry = |i: usize| (i as f64 / size as f64).powi(root) * ramp.distance();
        let entries = (0..=size).map(|i| ramp.crossing(entry(i)) / ramp.duration()).collect();
        Self { ramp, root, entries }
    }

    /// The error of the table's u at position `x`.
    fn error(&self, x: f64) -> f64 {
        let last = self.entries.len() - 1;
        let at = (x / self.ramp.distance()).powf(f64::from(self.root).recip()) * last as f64;
        let left = (at as usize).min(last - 1);
        let (low, high) = (self.entries[left], self.entries[left + 1]);
        (low + (high - low) * (at - left as f64) - self.ramp.crossing(x) / self.ramp.duration())
            .abs()
    }

    /// The greatest error of the table at the steps of the ramp, and the number of that step.
    fn worst_step(&self) -> (f64, usize) {
        let steps = 1..=self.ramp.distance() as usize;
        steps.map(|n| (self.error(n as f64), n)).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
    }
}

/// The golden numbers of this test have 16 digits, and an error of 10^-7 is the difference of two
/// numbers near 1, so that the tolerance is 10^-9.
#[test]
fn interpolation_error_of_a_small_table_equals_the_golden_numbers() {
    let (golden, ramp) = example();
    let milli = 1e3 * ramp.duration();
    for entries in [64, 256, 1024] {
        let at = |key: &str| format!("/table_lookup_linear_interp/{entries}/{key}");
        let table = Table::new(&ramp, entries, 1);
        let (error, step) = table.worst_step();
        golden.check(&at("max_abs_err_u_at_steps_N1000"), error, 1e-9);
        golden.check(&at("max_err_ms_T0.2s"), error * milli, 1e-9);
        assert_eq!(step as f64, golden.number(&at("at_step")));
        let worst = ramp.position(golden.number(&at("at_u")) * ramp.duration());
        golden.check(&at("max_abs_err_u"), table.error(worst), 1e-9);

        let at =
            |key: &str| format!("/table_lookup_linear_interp_in_fourth_root_of_s/{entries}/{key}");
        let (error, _) = Table::new(&ramp, entries, 4).worst_step();
        golden.check(&at("max_abs_err_u_at_steps_N1000"), error, 1e-9);
        golden.check(&at("max_err_us_T0.2s"), error * milli * 1e3, 1e-9);
    }
}

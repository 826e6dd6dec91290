//! Tests the logistic S-curve (M. Sorn, 2019) against the golden numbers of `logistic.json`.

use super::{Golden, TIGHT};
use carrystep_profile::{Curve, LogisticRamp, Profile, SHORTFALL, ScurveRamp};
use std::f64::consts::PI;

/// The example of the source, in the units of the source.
struct Source {
    golden: Golden,
    /// Angle of a step, rad.
    alpha: f64,
    /// Top speed, rad/s.
    omega: f64,
    /// Acceleration, rad/s^2.
    a: f64,
    /// Centre T_i, seconds.
    centre: f64,
}

impl Source {
    fn read() -> Self {
        let golden = Golden::read("logistic");
        let input = |name: &str| golden.number(&format!("/cases/0/in/{name}"));
        let steps_per_turn = 360.0 / input("step_angle_deg") * input("microsteps");
        let (alpha, travel) = (2.0 * PI / steps_per_turn, input("travel_per_rev_mm"));
        let omega = 2.0 * PI * input("vm_mm_per_min") / 60.0 / travel;
        let a = 2.0 * PI * input("accel_mm_s2") / travel;
        let centre = input("T_i_s");
        golden.check("/cases/0/spr", steps_per_turn, TIGHT);
        golden.check("/cases/0/steps_per_mm", steps_per_turn / travel, TIGHT);
        Self { golden, alpha, omega, a, centre }
    }

    /// The ramp that ends at `fraction` of the asymptote.
    fn ramp(&self, fraction: f64) -> LogisticRamp<f64> {
        LogisticRamp::new(self.omega / self.alpha, self.a / self.alpha, self.centre, 1.0 - fraction)
            .unwrap()
    }

    #[track_caller]
    fn check(&self, pointer: &str, actual: f64) {
        self.golden.check(&format!("/cases/0{pointer}"), actual, TIGHT);
    }

    fn number(&self, pointer: &str) -> f64 {
        self.golden.number(&format!("/cases/0{pointer}"))
    }
}

#[test]
fn converted_units_equal_those_of_the_source() {
    let source = Source::read();
    source.check("/alpha_rad", source.alpha);
    source.check("/omega_rad_s", source.omega);
    source.check("/a_rad_s2", source.a);
    source.check("/v_steps_s", source.omega / source.alpha);
    source.check("/a_steps_s2", source.a / source.alpha);
}

/// Figure 4 of the source draws the ramp of constant acceleration beside the curve.
#[test]
fn constant_acceleration_ramp_equals_figure_4() {
    let source = Source::read();
    let (v, a) = (source.number("/v_steps_s"), source.number("/a_steps_s2"));
    let ramp = ScurveRamp::new(0.0, v, a, f64::INFINITY).unwrap();
    source.check("/trap/n_exact", ramp.distance());
    source.check("/trap/T_a_exact", ramp.duration());
    source.check("/trap/c0", ramp.delay(0.0));
    source.check("/trap/c1", ramp.delay(1.0));
    source.check("/trap/c2", ramp.delay(2.0));
    // The source rounds the 138.9 steps of its ramp up, so that the last step ends above the top
    // speed.
    let n = source.number("/trap/n");
    assert_eq!(n, ramp.distance().ceil());
    let longer = ScurveRamp::new(0.0, (2.0 * a * n).sqrt(), a, f64::INFINITY).unwrap();
    source.check("/trap/c_last", longer.delay(n - 1.0));
    source.check("/trap/c_total", longer.crossing(n));
    source.golden.check("/seed_code_in_double/1000/trap_total", longer.crossing(n), TIGHT);
    assert_eq!(source.golden.number("/seed_code_in_double/1000/trap_n"), n);
}

#[test]
fn start_and_end_of_the_ramp_equal_the_golden_numbers() {
    let source = Source::read();
    let ramp = source.ramp(0.995);
    let k = ramp.steepness();
    source.check("/sigmoid/four_aT_over_omega", k * ramp.centre());
    source.check("/sigmoid/A", ramp.asymptote() / ramp.speed(0.0) - 1.0);
    source.check("/sigmoid/omega0_over_omega", ramp.speed(0.0) / ramp.asymptote());
    source.check("/sigmoid/start_speed_steps_s", ramp.figures().start_speed);
    source.check("/sigmoid/start_accel_steps_s2", ramp.acceleration(0.0));
    source.check("/sigmoid/code_0.995/t_end_s", ramp.duration());
    source.check("/sigmoid/code_0.995/n_exact", ramp.distance());
    source.check(
        "/sigmoid/code_0.995/omega_end_over_omega",
        ramp.figures().end_speed / ramp.asymptote(),
    );
    source.check("/sigmoid/code_0.995/q", ((ramp.centre() - ramp.duration()) * k).exp());
    assert_eq!(ramp.distance().round(), source.number("/sigmoid/code_0.995/n_rounded"));

    let text = source.ramp(1.0 / 1.005);
    source.check("/sigmoid/text_1.005/t_end_s", text.duration());
    source.check("/sigmoid/text_1.005/n_exact", text.distance());
    source.check(
        "/sigmoid/text_1.005/omega_end_over_omega",
        text.figures().end_speed / text.asymptote(),
    );
    assert_eq!(text.distance().round(), source.number("/sigmoid/text_1.005/n_rounded"));
}

/// Eq. 5 is printed as ln(1.005 w - 1), with the value of a speed in rad/s in place of a ratio.
#[test]
fn equation_5_as_printed_ends_at_the_wrong_speed() {
    let source = Source::read();
    let q = 1.005 * source.omega - 1.0;
    let fraction = 1.0 / (1.0 + q);
    let printed = source.ramp(fraction);
    source.check("/sigmoid/printed_ln(1.005*omega-1)/q", q);
    source.check("/sigmoid/printed_ln(1.005*omega-1)/t_end_s", printed.duration());
    source.check("/sigmoid/printed_ln(1.005*omega-1)/n_exact", printed.distance());
    source.check("/sigmoid/printed_ln(1.005*omega-1)/omega_end_over_omega", fraction);
    assert_eq!(
        printed.distance().round(),
        source.number("/sigmoid/printed_ln(1.005*omega-1)/n_rounded")
    );
    source.golden.check(
        "/printed_eq5_domain/ln_argument_positive_iff_omega_gt",
        1.0 / 1.005,
        TIGHT,
    );
}

#[test]
fn step_times_and_delays_equal_the_golden_numbers() {
    let source = Source::read();
    // The listing rounds the ramp of 367.9 steps to 368, so that the last step ends a little above
    // 99.5 %.
    let ramp = source.ramp(0.9951);
    source.check("/sigmoid/profile_code/c0", ramp.delay(0.0));
    source.check("/sigmoid/profile_code/c1", ramp.delay(1.0));
    let n = source.number("/sigmoid/profile_code/n");
    source.check(
        "/sigmoid/profile_code/c_mid",
        ramp.delay(source.number("/sigmoid/profile_code/c_mid_index")),
    );
    source.check("/sigmoid/profile_code/c_last", ramp.delay(n - 1.0));
    let end = ramp.crossing(n);
    source.check("/sigmoid/profile_code/c_total_s", end);
    source.check(
        "/sigmoid/profile_code/omega_at_c_total_over_omega",
        ramp.speed(end) / ramp.asymptote(),
    );
    source.check("/sigmoid/profile_code/theta_check_quad_steps", ramp.position(end));
    // The values that the listing itself prints, in doubles.
    source.golden.check("/seed_code_in_double/1000/sig_c0", ramp.delay(0.0), TIGHT);
    source.golden.check("/seed_code_in_double/1000/sig_clast", ramp.delay(n - 1.0), TIGHT);
    source.golden.check("/seed_code_in_double/1000/sig_total", end, TIGHT);
    assert_eq!(source.golden.number("/seed_code_in_double/1000/sig_n"), n);
}

#[test]
fn symmetric_ramp_has_equal_shortfalls_at_both_ends() {
    let source = Source::read();
    let ramp =
        LogisticRamp::symmetric(source.number("/v_steps_s"), source.number("/a_steps_s2")).unwrap();
    source.check("/sigmoid/T_i_symmetric_0.5pct", ramp.centre());
    source.check("/sigmoid/T_a_symmetric", ramp.duration());
    source.check("/sigmoid/ramp_steps_symmetric", ramp.distance());
    let (figures, w) = (ramp.figures(), ramp.asymptote());
    assert!((figures.start_speed / w - SHORTFALL).abs() < 1e-15, "{figures:?}");
    assert!((1.0 - figures.end_speed / w - SHORTFALL).abs() < 1e-15, "{figures:?}");
}

/// Below 10.82 mm/min the term e^(k T_i) of the source exceeds the greatest double.
#[test]
fn slow_ramps_do_not_overflow() {
    let source = Source::read();
    let least = 4.0 * source.a * source.centre / f64::MAX.ln();
    source.golden.check("/double_overflow/omega_min_rad_s", least, TIGHT);
    source.golden.check(
        "/double_overflow/vm_min_mm_per_min",
        least * 5.0 * 60.0 / (2.0 * PI),
        TIGHT,
    );
    for slower in [1.0, 0.99, 0.1, 1e-3, 1e-6] {
        let w = slower * least / source.alpha;
        let ramp = LogisticRamp::new(w, source.a / source.alpha, source.centre, SHORTFALL).unwrap();
        // A relative error e of T_i is a relative error e k T_i of the distance travelled so far; k
        // T_i is 710 or more here.
        let tolerance = 4.0 * f64::EPSILON * ramp.steepness() * ramp.centre();
        for part in [1e-3, 0.5, 0.999] {
            let n = part * ramp.distance();
            let back = ramp.position(ramp.crossing(n));
            assert!((back / n - 1.0).abs() <= tolerance, "{slower} {part}: {n:e} became {back:e}");
        }
        assert!((ramp.speed(ramp.centre()) / w - 0.5).abs() < tolerance);
        let mean = ramp.mean_speed(0.0, ramp.duration());
        assert!(
            (mean * ramp.duration() / ramp.distance() - 1.0).abs() < tolerance,
            "{slower}: {mean:e}"
        );
    }
}

//! Tests that `docs/profiles.md` is true, by computing its table and its figures again.

use crate::pages::{self, grouped};
use carrystep_core::ProfileKind;
use carrystep_profile::rule::{
    logistic, logistic_least_time, logistic_ramp, scurve, scurve_least_time, scurve_ramp, sine,
    sine_least_time, sine_ramp,
};
use carrystep_profile::{
    Curve, CurveFigures, Limits, LogisticRamp, Profile, RampedMove, SHORTFALL, SineRamp, kinds,
};
use serde_json::Value;
use std::f64::consts::PI;

const PAGE: &str = include_str!("../../../docs/profiles.md");

/// Asserts that the page contains each of these texts, regardless of line breaks.
#[track_caller]
fn says(texts: &[String]) {
    pages::says("docs/profiles.md", PAGE, texts);
}

const STEPS: f64 = 20_000.0;
const LIMITS: Limits<f64> =
    Limits { start_speed: 0.0, speed: f64::INFINITY, acceleration: 500_000.0, jerk: f64::INFINITY };

fn row<R: Curve<f64>>(name: &str, ramped: &RampedMove<f64, R>) -> String {
    assert!(ramped.cruise_time() < 1e-9);
    row_of(name, &ramped.figures())
}

/// The row of a move without a cruise.
fn row_of(name: &str, figures: &CurveFigures<f64>) -> String {
    assert!((figures.peak_acceleration / LIMITS.acceleration - 1.0).abs() < 1e-12);
    format!(
        "| {name} | {} | {} | {} | {:.6} | {:.6} |",
        grouped(figures.start_speed),
        grouped(figures.acceleration_jump),
        if figures.peak_jerk > 0.0 { grouped(figures.peak_jerk) } else { "impulses".into() },
        figures.seconds / 2.0,
        figures.seconds,
    )
}

#[test]
fn page_gives_the_figures_of_the_reference_move() {
    let plan_scurve =
        |limits: &Limits<f64>| scurve(STEPS, scurve_least_time(STEPS, limits), limits).unwrap();
    let smooth = sine(STEPS, sine_least_time(STEPS, &LIMITS), &LIMITS).unwrap();
    let curve = logistic(STEPS, logistic_least_time(STEPS, &LIMITS), &LIMITS).unwrap();
    let as_sharp = plan_scurve(&Limits { jerk: smooth.peak_jerk(), ..LIMITS });
    let ramp = curve.up();
    assert_eq!(grouped(ramp.asymptote()), "61 468");
    assert_eq!(format!("{:.6}", ramp.duration()), "0.325371");
    assert!((ramp.centre() - 199.0_f64.ln() / ramp.steepness()).abs() < 1e-12);
    assert_eq!(grouped(smooth.top_speed()), "70 711");
    assert_eq!(format!("{:.6}", smooth.up().duration()), "0.282843");
    let top = |name: &str, x: f64| format!("{name} {}", grouped(x));
    says(&[
        row("trapezoid", &plan_scurve(&LIMITS)),
        row("scurve, jerk as of the sine", &as_sharp),
        top("trapezoid", plan_scurve(&LIMITS).top_speed()),
        top("scurve", as_sharp.top_speed()),
        format!("(asymptote {})", grouped(ramp.asymptote())),
        format!("{} steps from and to rest, with an acceleration", grouped(STEPS)),
        format!("of at most {} steps/s^2, as fast as", grouped(LIMITS.acceleration)),
        format!("so each ramp is {} steps.", grouped(smooth.up().distance())),
        format!(
            "{:.0} % more time than an scurve",
            100.0 * (smooth.duration() / as_sharp.duration() - 1.0)
        ),
    ]);
}

#[test]
fn page_gives_the_figures_of_every_fitted_kind() {
    for &kind in ProfileKind::ALL.iter().filter(|kind| kind.is_fitted()) {
        let least = kinds::least_time(kind, STEPS, &LIMITS).unwrap();
        let figures = kinds::whole(kind, STEPS, least, &LIMITS).unwrap().figures();
        says(&[
            row_of(kind.name(), &figures),
            format!("{kind} {}", grouped(figures.top_speed)),
            format!("{kind} {} times", ratio(least)),
        ]);
    }
}

/// A time in multiples of the trapezoid's.
fn ratio(seconds: f64) -> String {
    format!("{:.2}", seconds / (2.0 * (STEPS / LIMITS.acceleration).sqrt()))
}

/// The example of the logistic source: 1.8 degrees, half steps, 5 mm a turn, 80 mm/s^2, T_i = 0.4
/// s.
fn sorn(mm_per_minute: f64) -> LogisticRamp<f64> {
    LogisticRamp::new(mm_per_minute / 60.0 * 80.0, 80.0 * 80.0, 0.4, SHORTFALL).unwrap()
}

#[test]
fn page_gives_the_errors_of_the_logistic_source() {
    let golden = golden(include_str!("../../../tests/golden/logistic.json"));
    let given = |name: &str| number(&golden["cases"][0]["in"][name]);
    let (speed, acceleration) = (given("vm_mm_per_min"), given("accel_mm_s2"));
    let centre = given("T_i_s");
    let (slow, fast) = (sorn(speed), sorn(3000.0));
    assert_eq!((slow.centre(), slow.steepness()), (centre, 4.0 * acceleration * 60.0 / speed));
    let jump = |ramp: &LogisticRamp<f64>| 100.0 * ramp.speed(0.0) / ramp.asymptote();
    let least = 4.0 * 80.0 * 80.0 * 0.4 / f64::MAX.ln() / 80.0 * 60.0;
    let omega = 1000.0 / 60.0 / 5.0 * 2.0 * PI;
    let printed =
        LogisticRamp::new(slow.asymptote(), 6400.0, 0.4, 1.0 - 1.0 / (1.005 * omega)).unwrap();
    let symmetric = LogisticRamp::symmetric(slow.asymptote(), 6400.0).unwrap();
    says(&[
        format!(
            "jumps to {:.2} % of its speed at 1000 mm/min and to {:.1} % at 3000",
            jump(&slow),
            jump(&fast)
        ),
        format!(
            "stops after {:.0} steps at {:.1} % of the speed",
            printed.distance().round(),
            100.0 / (1.005 * omega)
        ),
        format!("instead of {:.0} steps at 99.5 %", slow.distance().round()),
        format!("under {least:.2} mm/min"),
        format!("a ramp of a million steps has {} digits less.", word(1e6_f64.log10())),
        format!("the example ({speed} mm/min, {acceleration} mm/s^2) stops"),
        format!("It is {centre} s in the example"),
        format!("at {speed} mm/min, and jumps to {:.1} % at any speed.", jump(&symmetric)),
        format!("{:.3} s instead of {:.3} s", symmetric.duration(), slow.duration()),
    ]);
}

#[test]
fn page_gives_the_errors_of_the_sinusoidal_source() {
    let ramp = SineRamp::new(10_000.0, 0.2).unwrap();
    let end = ramp.crossing(ramp.distance() / PI);
    let first = ramp.crossing(1.0);
    let leading = ramp.duration() * (3.0 / (PI * PI * ramp.distance())).powf(0.25);
    // The linear table of 256 entries at the first step, which lies between 0 and the second entry.
    const ENTRIES: u32 = 256;
    let entries = f64::from(ENTRIES);
    let entry = ramp.crossing(ramp.distance() / entries);
    // The table over the fourth root of the distance, at 39 places in each of its 256 cells.
    let time = |root: f64| ramp.crossing(ramp.distance() * (root / entries).powi(4));
    let wrong = |cell: f64, part: f64| {
        time(cell + part) - (time(cell) * (1.0 - part) + time(cell + 1.0) * part)
    };
    let places = (0..ENTRIES)
        .flat_map(|cell| (1..40).map(move |part| (f64::from(cell), f64::from(part) / 40.0)));
    let worst = places.map(|(cell, part)| wrong(cell, part).abs()).fold(0.0, f64::max);
    // A trapezoid ramp over the same distance in the same time has the acceleration v / T.
    let (v, seconds) = (ramp.top_speed(), ramp.duration());
    let peak = ramp.acceleration(0.5 * seconds) * seconds / v;
    assert!((peak - 2.0).abs() < 1e-12, "twice: {peak}");
    says(&[
        format!(
            "For a ramp of {:.0} steps to {} steps/s in {seconds} s:",
            ramp.distance(),
            grouped(v)
        ),
        "acceleration is twice that of a trapezoid ramp.".to_owned(),
        // The peak acceleration of a move over a distance is inversely proportional to T^2.
        format!("the move takes sqrt({peak:.0}) times as long."),
        format!("with {ENTRIES} entries it is"),
        format!("more than {:.2} us wrong", 1e6 * worst),
        format!(
            "{:.1} % of the speed after all its steps",
            100.0 * ramp.speed(end) / ramp.top_speed()
        ),
        format!("The first step comes at {:.2} ms", 1e3 * first),
        format!("({:.2} ms by the leading term)", 1e3 * leading),
        format!(
            "{:.1} ms early at the first step",
            1e3 * (first - entry * entries / ramp.distance())
        ),
        format!(
            "{} steps/s^4",
            grouped((2.0 * PI).powi(2) * ramp.top_speed() / ramp.duration().powi(3))
        ),
    ]);
}

#[test]
fn page_gives_the_time_of_the_scurve() {
    let as_sharp = Limits { jerk: PI * 500_000.0 / 0.282_842_712_474_619, ..LIMITS };
    says(&[format!("scurve {} times", ratio(scurve_least_time(STEPS, &as_sharp)))]);
}

/// The example of the trapezoidal source in degrees: 360 degrees in 1 s at 1800 degrees/s^2, with
/// 200 steps a turn.
#[test]
fn page_gives_the_errors_of_the_trapezoidal_source() {
    let (degrees, acceleration, per_step) = (360.0_f64, 1800.0_f64, 360.0 / 200.0);
    let root = (acceleration * acceleration - 4.0 * acceleration * degrees).sqrt();
    let (minus, plus) = ((acceleration - root) / 2.0, (acceleration + root) / 2.0);
    let limits = Limits {
        start_speed: 0.0,
        speed: f64::INFINITY,
        acceleration: acceleration / per_step,
        jerk: f64::INFINITY,
    };
    let ramp = carrystep_profile::rule::trapezoid(200.0, 1.0, &limits).unwrap();
    assert!((ramp.top_speed() * per_step / minus - 1.0).abs() < 1e-12);
    let [up, down] = [minus, plus].map(|speed| speed / acceleration);
    assert!(
        (ramp.breakpoints()[0] - up).abs() < 1e-12 && (ramp.breakpoints()[1] - down).abs() < 1e-12
    );
    let refused =
        carrystep_profile::rule::trapezoid(200.0, 1.0, &Limits { acceleration: 100.0, ..limits })
            .unwrap_err();
    // As printed, the third segment moves backward from rest for as long as the ramp lasts.
    let printed = minus * up / 2.0 + minus * (down - up) - minus * up / 2.0;
    says(&[
        format!(
            "The plus root, {plus:.0} degrees/s, begins to slow down ({up:.3} s) before it has sped up ({down:.3} s)"
        ),
        format!("the minus root, {minus:.1} degrees/s"),
        format!(
            "The example of the source: {degrees} degrees in 1 s at {acceleration} degrees/s^2"
        ),
        format!("degrees/s^2, {:.0} steps a turn.", 360.0 / per_step),
        format!("where the text has times ({up:.3} and {down:.3} s)"),
        format!("would do: here {:.0} degrees/s^2", refused.wanted * per_step),
        format!(
            "speed jumps by -{minus:.1} degrees/s and the motor turns {printed:.1} degrees instead of {degrees:.0}"
        ),
        format!("step numbers**, {:.1} and {:.1}", ramp.position(up), ramp.position(down)),
        format!("here {:.0}/9", 9.0 * 200.0 / degrees),
    ]);
}

#[test]
fn page_gives_the_first_step_of_the_trapezoid() {
    let trapezoid = (2.0 / (10_000.0 / 0.2_f64)).sqrt();
    says(&[format!("that of the trapezoid ramp of the same time at {:.2} ms", 1e3 * trapezoid)]);
}

/// A small whole number in words.
fn word(number: f64) -> &'static str {
    ["none", "one", "two", "three", "four", "five", "six", "seven"][number as usize]
}

#[test]
fn page_gives_the_segments_of_an_scurve() {
    // The limits leave room for a held acceleration and for a cruise.
    let limits = Limits { speed: 40_000.0, jerk: 1e7, ..LIMITS };
    let held = scurve(STEPS, scurve_least_time(STEPS, &limits), &limits).unwrap();
    assert!(held.cruise_time() > 0.0);
    let segments = held.breakpoints().len() + 1;
    says(&[
        format!("The move has {} segments:", word(segments as f64)),
        format!("cruise, and the first {} mirrored", word((segments - 1) as f64 / 2.0)),
    ]);
}

/// Where the jerk limits a ramp, its time is in proportion to a root of speed over jerk.
#[test]
fn page_gives_the_times_of_ramps_that_the_jerk_limits() {
    let (speed, jerk) = (50_000.0, 1e6);
    let limits = Limits { start_speed: 0.0, speed: f64::INFINITY, acceleration: 1e9, jerk };
    let root = |top: f64| (top / jerk).sqrt();
    let scurve = scurve_ramp(speed, None, &limits).unwrap().duration() / root(speed);
    let sine = sine_ramp(speed, None, &limits).unwrap().duration() / root(speed);
    let logistic = logistic_ramp(speed, None, &limits).unwrap();
    let whole = |factor: f64| {
        assert!((factor / factor.round() - 1.0).abs() < 1e-9, "{factor}");
        factor.round()
    };
    let w = logistic.asymptote();
    let factor = logistic.duration() / (w / (6.0 * 3.0_f64.sqrt() * jerk)).sqrt();
    says(&[
        format!("a ramp takes {} sqrt(v / j) (scurve)", whole(scurve)),
        format!("sqrt({} pi v / j) (sine)", whole(sine * sine / PI)),
        format!("2 ln({}) sqrt(w / (6 sqrt(3) j)) (logistic)", whole((factor / 2.0).exp())),
    ]);
}

fn golden(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// A number of a golden file, with its digits.
fn number(value: &Value) -> f64 {
    value.as_f64().or_else(|| value.as_str()?.parse().ok()).unwrap()
}

#[test]
fn page_gives_what_text_and_listing_of_the_logistic_source_say() {
    let golden = golden(include_str!("../../../tests/golden/logistic.json"));
    let sigmoid = &golden["cases"][0]["sigmoid"];
    let [text, listing] =
        ["text_1.005", "code_0.995"].map(|of| 1.0 + 1.0 / number(&sigmoid[of]["q"]));
    let reached = 100.0 * number(&sigmoid["code_0.995"]["omega_end_over_omega"]);
    says(&[
        format!("1 + 1/q is {text:.0} in the text and {listing:.0} in the listing."),
        format!("carrystep uses the {reached:.1} % of the listing."),
    ]);
}

#[test]
fn page_gives_the_loss_of_a_dropped_remainder() {
    let golden = golden(include_str!("../../../tests/golden/trapezoid_austin.json"));
    let integer = |name: &str| number(&golden["avr446_integer"][name]);
    let slow = integer("without_rest_c_1000") / integer("exact_c_1000") - 1.0;
    says(&[format!("step 1000 is {:.0} % too slow.", 100.0 * slow)]);
}

#[test]
fn page_gives_the_longest_ramp_of_its_test() {
    let test = include_str!("near_rest.rs");
    let (_, rest) = test.split_once("2.0_f64.powi(-").unwrap();
    let power = rest.split(')').next().unwrap();
    says(&[
        format!("first step of a ramp of 2^{power} steps is correct"),
        format!("the first step of a ramp of 2^{power} steps has all its digits."),
    ]);
}

/// The values of Gamma(3/4) and Gamma(1/4) give the first delay of the recurrence of AVR446.
#[test]
fn page_gives_the_first_delay_of_the_recurrence() {
    let first = 2.0 * 1.225_416_702_465_178 / 3.625_609_908_221_908;
    says(&[
        format!("they are {:.3} times too long for ever", 1.0 / first),
        format!("Started from {first:.3} of it"),
        format!("right within {:.1e} in the end", 0.676 / first - 1.0),
    ]);
}

#[test]
fn page_gives_the_share_of_the_speed_that_a_logistic_ramp_reaches() {
    let (begun, reached) = (100.0 * SHORTFALL, 100.0 * (1.0 - SHORTFALL));
    let parts = 1.0 / SHORTFALL;
    says(&[
        format!("and ends at {reached:.1} % of it"),
        format!("missing at the end: 1/{parts:.0}."),
        format!("T_i = ln({:.0}) / k: they begin at {begun:.1} % of w", parts - 1.0),
        format!("and cruise at {reached:.1} %"),
        format!("w = limit / {:.3}.", 1.0 - SHORTFALL),
        format!("The jump at the start is {begun:.1} % of w,"),
        format!("longer by about ln({SHORTFALL} w / start_speed) / k."),
        format!("and reports the jump of {begun:.1} %."),
        format!("The correct term is ln {SHORTFALL}."),
    ]);
}

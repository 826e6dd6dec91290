//! Tests that `docs/tables.md` is true: its figures are computed again, or taken from the golden
//! values, which `golden_values.rs` computes again.

#![allow(clippy::expect_used, reason = "clippy.toml's allowance reaches unit tests only")]

use crate::pages::{self, grouped};
use carrystep_table::austin::{ConstantAcceleration, IntegerRecurrence};
use carrystep_table::logistic::Logistic;
use carrystep_table::sine::Sine;
use carrystep_table::{
    Arithmetic, InverseTable, Kind, Motor, PLAYER, Pulses, Speed, Table, TableRequest, Timer,
    TimerMode,
};
use serde_json::Value;

/// Asserts that the page contains each of these texts, regardless of line breaks.
#[track_caller]
fn says(texts: &[String]) {
    pages::says("docs/tables.md", include_str!("../../../docs/tables.md"), texts);
}

/// The motor of the look-up method.
const MOTOR: Motor = Motor { step_angle_deg: 1.8, microsteps: 8 };
/// The speeds of the page's ramp, steps/s and rpm, and its entries.
const START: f64 = 500.0;
const RPM: f64 = 500.0;
const ENTRIES: u32 = 1000;
/// The steepness Fle.
const STEEPNESS: f64 = 6.0;

/// The page's ramp.
fn table(prescaler: u32, kind: Kind) -> Table {
    Table::new(TableRequest {
        timer: Timer::avr16(16_000_000, prescaler, TimerMode::Ctc),
        motor: MOTOR,
        start_frequency: START,
        top_speed: Speed::Rpm(RPM),
        kind,
        pulses: Pulses::One,
    })
    .expect("a table")
}

fn avr446(arithmetic: Arithmetic) -> Kind {
    Kind::Avr446 { ramp_steps: ENTRIES, arithmetic }
}

fn logistic() -> (Logistic, Kind) {
    let (top, centre) = (MOTOR.steps_per_second(RPM), f64::from(ENTRIES) / 2.0);
    let kind = Kind::Logistic { entries: ENTRIES, steepness: STEEPNESS, centre: None };
    (Logistic { start: START, top, steepness: STEEPNESS, centre }, kind)
}

#[test]
fn page_compares_the_kinds_of_tables() {
    let (top, steps) = (MOTOR.steps_per_second(RPM), f64::from(ENTRIES));
    let constant = ConstantAcceleration::between(2e6, START, top, steps).acceleration;
    let sine = Sine { start: START, top, steps }.peak_acceleration();
    let (curve, kind) = logistic();
    let steep = (0..ENTRIES).map(|i| curve.acceleration(f64::from(i))).fold(0.0, f64::max);
    let row = |kind: Kind, shape: &str, peak: f64| {
        let (name, table) = (kind.name(), table(8, kind));
        let seconds = table.figures().ramp_seconds;
        format!("| `{name}` | {shape} | {seconds:.3} s | {} steps/s^2 |", grouped(peak))
    };
    says(&[
        row(avr446(Arithmetic::Float), "constant acceleration", constant),
        row(
            Kind::Sine { ramp_steps: ENTRIES, inverse: None },
            "acceleration proportional to 1 - cos over time",
            sine,
        ),
        row(kind, "frequency is a logistic function of the *entry*", steep),
        format!("({} degrees, {} microsteps)", MOTOR.step_angle_deg, MOTOR.microsteps),
        format!("from {START} to {} steps/s in {ENTRIES} entries", grouped(top)),
    ]);
}

#[test]
fn page_gives_the_first_frequency_of_a_logistic_table() {
    let (curve, _) = logistic();
    let first = curve.frequency(0.0);
    let share = 100.0 * (first - curve.start) / (curve.top - curve.start);
    says(&[format!(
        "higher by {share:.2} % of the rise ({first:.2} Hz instead of {START} at the steepness Fle = {STEEPNESS})"
    )]);
}

#[test]
fn page_gives_the_bias_of_the_integer_recurrence() {
    let longer = |prescaler| {
        let seconds = |arithmetic| table(prescaler, avr446(arithmetic)).figures().ramp_seconds;
        100.0 * (seconds(Arithmetic::Integer) / seconds(Arithmetic::Float) - 1.0)
    };
    says(&[format!(
        "at 250 kHz the ramp above takes {:.1} % longer, at 2 MHz {:.1} %",
        longer(64),
        longer(8)
    )]);
}

#[test]
fn page_gives_the_rounding_of_the_top_speed() {
    let (_, kind) = logistic();
    let table = table(64, kind);
    let figures = table.figures();
    let khz = figures.timer_hz / 1e3;
    let prescaler = |prescaler| Timer::avr16(16_000_000, prescaler, TimerMode::Ctc).frequency();
    says(&[
        format!("a timer at {} MHz (prescaler 8), which rounds little.", prescaler(8) / 1e6),
        format!("The command above has prescaler 64, a timer at {} kHz", prescaler(64) / 1e3),
    ]);
    says(&[format!(
        "At {khz} kHz {RPM} rpm is {:.2} counts; the player uses {:.0}, which is {:.1} rpm.",
        figures.timer_hz / figures.top_speed_asked,
        figures.timer_hz / figures.top_speed,
        figures.top_rpm
    )]);
}

/// The sizes of the structures in the player's header, with the pointers of an AVR.
#[test]
fn page_gives_the_memory_that_tables_and_player_take() {
    let header =
        PLAYER.iter().find(|(name, _)| *name == "carrystep_player.h").expect("the header").1;
    let bytes = |name: &str| -> usize {
        let (before, _) = header.split_once(&format!("}} {name};")).expect("a structure");
        let (_, fields) = before.rsplit_once("typedef struct {").expect("its beginning");
        let bytes_of = |field: &str| -> usize {
            match field.trim() {
                field if field.contains('*') => 2,
                field if field.starts_with("uint32_t ") => 4,
                field if field.starts_with("uint16_t ") => 2,
                field => panic!("{field}"),
            }
        };
        let fields = fields.lines().filter_map(|line| line.split_once(';'));
        fields.map(|(field, _)| bytes_of(field)).sum()
    };
    says(&[
        format!(
            "the player takes {} bytes of RAM, and the table's descriptor {}.",
            bytes("carrystep_player"),
            bytes("carrystep_table")
        ),
        format!("from its {} words", InverseTable::new(256).words().len()),
    ]);
}

fn golden(text: &str) -> Value {
    serde_json::from_str(text).expect("a golden file")
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .or_else(|| value.as_str()?.parse().ok())
        .unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn page_gives_the_errors_of_the_sources() {
    let timer = golden(include_str!("../../../tests/golden/timer_table.json"));
    let austin = golden(include_str!("../../../tests/golden/trapezoid_austin.json"));
    let sine = golden(include_str!("../../../tests/golden/sinusoid.json"));
    let ocr = |name: &str| number(&timer["ocr"][name]);
    let ramp = |name: &str| number(&timer["table_Fle_6"][name]);
    let update = |name: &str| number(&timer["update_2018_08"][name]);
    let first = number(&austin["austin"]["ideal_c0_factor = 2 Gamma(3/4)/Gamma(1/4)"]);
    let integer = |name: &str| number(&austin["avr446_integer"][name]);
    let kept = IntegerRecurrence::new(integer("c0_int") as u32, 0).nth(1000).expect("a delay");
    let linear = |name: &str, error: &str| number(&sine[name]["256"][error]);
    says(&[
        format!("30/pi = {:.4}", ocr("9.55_vs_30/pi")),
        format!("; {:.1e} off", ocr("rel_error_of_9.55")),
        format!("runs at {} rpm", ocr("real_rpm_if_OCR1A=19 (CTC period OCR+1=20)")),
        format!(
            "the {:.3} s ramp takes {:.3} s",
            ramp("ramp_time_OCR_s"),
            ramp("ramp_time_if_OCR+1_s")
        ),
        format!(
            "the ramp takes {:.3} s and begins at {:.1} Hz | the ramp takes {:.3} s and begins at {:.1} Hz |",
            update("bug_extra_interrupt_time_s"),
            update("first_band_effective_Hz"),
            update("nominal_time_s"),
            // The first entry lasts one pulse, so one interrupt more doubles its time.
            2.0 * update("first_band_effective_Hz")
        ),
        format!("stop condition ({} pulses)", update("pulses_1ms")),
        format!("writes OCR {}", ocr("integer_OCR_500rpm")),
        format!(
            "and {:.0e} with the printed 31.4 for 10 pi",
            ocr("300rpm_with_31.4") / ocr("300rpm_div1_exact") - 1.0
        ),
        format!("every delay {:.0} % too long", 100.0 * (1.0 / first - 1.0)),
        format!("= {first:.5} of it (0.676 in AVR446; {:.1e} off)", 0.676 / first - 1.0),
        format!("dropped: c_1000 = {}", integer("without_rest_c_1000")),
        format!("kept: c_1000 = {kept};"),
        format!("the exact value is {:.2}", integer("exact_c_1000")),
        format!(
            "over s: wrong by {:.1} ms at the first step",
            linear("table_lookup_linear_interp", "max_err_ms_T0.2s")
        ),
        format!(
            "over s^(1/4): wrong by {:.1} us",
            linear("table_lookup_linear_interp_in_fourth_root_of_s", "max_err_us_T0.2s")
        ),
    ]);
}

/// The ramp of the source, of which golden_values.rs checks the first entries.
#[test]
fn page_gives_the_pulses_of_a_ramp_with_its_last_entry() {
    let table = Table::new(TableRequest {
        timer: Timer::avr16(16_000_000, 64, TimerMode::Ctc),
        motor: MOTOR,
        start_frequency: 600.0,
        top_speed: Speed::Rpm(RPM),
        kind: Kind::Logistic { entries: 600, steepness: STEEPNESS, centre: None },
        pulses: Pulses::ByTime(1e-3),
    })
    .expect("a table");
    says(&[format!("used ({} pulses)", table.figures().ramp_pulses)]);
}

#[test]
fn page_compares_the_recurrence_with_constant_acceleration() {
    let ramp = ConstantAcceleration { timer: 1e6, acceleration: 1000.0 };
    let short = |n: f64| 1.0 - ramp.delay(n) / ramp.exact_delay(n);
    // The error times n^2 approaches a constant.
    let [near, far] = [1e3, 1e4].map(|n| 64.0 * n * n * short(n));
    assert!((near - far).abs() < 0.02, "{near} {far}");
    says(&[format!(
        "its delay is {:.1} % short at the second step, and by {far:.0} / 64 n^2 in general.",
        100.0 * short(1.0)
    )]);
    let source = include_str!("../src/table.rs");
    let (_, rest) = source.split_once("let quarters = (").expect("the index in parts of a step");
    let parts: f64 = rest.split(' ').next().and_then(|n| n.parse().ok()).expect("a number");
    assert_eq!(parts, 4.0, "a quarter");
    says(&["(n = v^2 / 2a, rounded to a quarter of a step)".to_owned()]);
}

#[test]
fn page_gives_the_errors_of_rounded_delays() {
    let test = include_str!("player_plays_the_table.rs");
    let behind = |text: &str| -> f64 {
        let (_, rest) = test.split_once(text).expect("the text");
        let number = rest.split(',').next().expect("a number");
        number.parse().unwrap_or_else(|_| panic!("{number}"))
    };
    let (whole, rounded) = (behind("Arithmetic::Integer, .. } => "), behind("        _ => "));
    let timer = Timer::avr16(16_000_000, 64, TimerMode::Ctc);
    says(&[
        format!("pulse n is at most n/{:.0} counts from the formula**", 1.0 / rounded),
        format!("(`avr446` in integers: {whole:.0} counts a pulse"),
        format!("and counts once round, {} counts.", grouped(timer.most_counts().into())),
    ]);
}

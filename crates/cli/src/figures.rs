//! The figures of a curve (jumps, greatest values, times), as a table with one column per curve.

use carrystep_profile::reference::{Drive, Length, Reference};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write as _;

/// The figures of a curve under their names in `--json`.
#[derive(Debug, JsonSchema, Serialize)]
pub struct FiguresJson {
    steps: f64,
    whole_steps: f64,
    seconds: f64,
    start_speed_steps_per_s: f64,
    end_speed_steps_per_s: f64,
    top_speed_steps_per_s: f64,
    peak_acceleration_steps_per_s2: f64,
    acceleration_jump_steps_per_s2: f64,
    /// `None`, with a reason, if all jerk is impulses and therefore has no greatest value.
    peak_jerk_steps_per_s3: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_jerk_reason: Option<&'static str>,
    first_delay_s: f64,
    last_delay_s: f64,
}

impl FiguresJson {
    /// Measures a curve.
    pub fn new(reference: &Reference) -> Self {
        let (figures, whole_steps) = (reference.figures(), reference.whole_steps());
        let impulses = figures.peak_jerk <= 0.0 && figures.acceleration_jump > 0.0;
        Self {
            steps: figures.steps,
            whole_steps,
            seconds: figures.seconds,
            start_speed_steps_per_s: figures.start_speed,
            end_speed_steps_per_s: figures.end_speed,
            top_speed_steps_per_s: figures.top_speed,
            peak_acceleration_steps_per_s2: figures.peak_acceleration,
            acceleration_jump_steps_per_s2: figures.acceleration_jump,
            peak_jerk_steps_per_s3: (!impulses).then_some(figures.peak_jerk),
            peak_jerk_reason: impulses.then_some("impulses where the acceleration jumps"),
            first_delay_s: reference.delay(0.0),
            last_delay_s: reference.delay(whole_steps - 1.0),
        }
    }
}

/// A row of the table: its name, and the function that formats its value for a curve.
type Line<'a> = (String, Box<dyn Fn(&Reference, &FiguresJson) -> String + 'a>);

/// The table with one column per curve; if the drive has a travel per turn, also in millimetres.
pub fn table(references: &[Reference], drive: &Drive) -> String {
    let measured: Vec<(&Reference, FiguresJson)> =
        references.iter().map(|r| (r, FiguresJson::new(r))).collect();
    let mut lines = lines();
    lines.extend(in_unit("steps", 1.0));
    if let Some(travel) = drive.travel_per_rev_mm {
        let steps = drive.steps_in(Length::Millimetre).unwrap_or(f64::NAN);
        lines.push((
            format!("length, mm ({travel} mm a turn)"),
            Box::new(move |_, f| number(f.steps / steps)),
        ));
        lines.extend(in_unit("mm", steps));
    }
    let head =
        std::iter::once(String::new()).chain(references.iter().map(|r| r.kind().to_string()));
    let body = lines.iter().map(|(name, value)| {
        std::iter::once(name.clone())
            .chain(measured.iter().map(|(r, f)| value(r, f)))
            .collect::<Vec<_>>()
    });
    let mut text = String::new();
    for row in std::iter::once(head.collect::<Vec<_>>()).chain(body) {
        let name = row.first().map_or("", String::as_str);
        let _ = write!(text, "{name:<34}");
        for cell in row.iter().skip(1) {
            let _ = write!(text, "  {cell:>12}");
        }
        text.push('\n');
    }
    text
}

fn lines<'a>() -> Vec<Line<'a>> {
    let line = |name: &str, value: fn(&Reference, &FiguresJson) -> String| -> Line<'a> {
        (name.to_owned(), Box::new(value))
    };
    vec![
        line("length, steps", |_, f| number(f.steps)),
        line("time, s", |_, f| format!("{:.6}", f.seconds)),
        line("first delay c_0, s", |_, f| number(f.first_delay_s)),
        line("last delay, s", |_, f| number(f.last_delay_s)),
    ]
}

/// The rows whose unit contains a length; `steps` is the number of steps in one `unit`.
fn in_unit<'a>(unit: &str, steps: f64) -> Vec<Line<'a>> {
    let line = |what: &str, power: &str, value: fn(&FiguresJson) -> f64| -> Line<'a> {
        (format!("{what}, {unit}/s{power}"), Box::new(move |_, f| number(value(f) / steps)))
    };
    let jerk = move |_: &Reference, f: &FiguresJson| {
        f.peak_jerk_steps_per_s3.map_or_else(|| "impulses".to_owned(), |jerk| number(jerk / steps))
    };
    vec![
        line("start jump", "", |f| f.start_speed_steps_per_s),
        line("top speed", "", |f| f.top_speed_steps_per_s),
        line("end speed", "", |f| f.end_speed_steps_per_s),
        line("peak acceleration", "^2", |f| f.peak_acceleration_steps_per_s2),
        line("jump of acceleration", "^2", |f| f.acceleration_jump_steps_per_s2),
        (format!("peak jerk, {unit}/s^3"), Box::new(jerk)),
    ]
}

/// Formats a number with six significant digits, or with all digits of a longer integer part.
fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_normal() {
        return value.to_string();
    }
    let before = value.abs().log10().floor() as i32 + 1;
    let after = usize::try_from(6 - before).unwrap_or(0);
    if after > 12 || before > 12 {
        return format!("{value:.5e}");
    }
    let text = format!("{value:.after$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

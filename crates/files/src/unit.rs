//! Formats lengths, speeds and accelerations for people: in the axis' own unit, and in steps beside
//! it.

use serde::Serialize;

/// Unit name of an axis that has more than one step per unit and no `unit` in its file.
const UNNAMED: &str = "units";

/// Unit name of an axis whose unit is the step.
const STEPS: &str = "steps";

/// Number of significant digits shown.
const DIGITS: i32 = 6;

/// The unit of an axis. It serves display only: no motion is computed from its floats.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Unit {
    /// Name of the unit, as in the machine file's `unit`.
    pub name: String,
    /// Steps per unit.
    pub steps: f64,
}

impl Unit {
    /// The unit of this name. Without a name it is called `steps` if there is one step per unit,
    /// otherwise `units`.
    pub fn new(name: Option<&str>, steps: f64) -> Self {
        let unnamed = if steps == 1.0 { STEPS } else { UNNAMED };
        Self { name: name.unwrap_or(unnamed).to_owned(), steps }
    }

    /// The unit divided by a power of seconds: `mm`, `mm/s`, `mm/s^2`, `mm/s^3`.
    pub fn per(&self, seconds: u32) -> String {
        per(&self.name, seconds)
    }

    /// Converts a figure in steps/s^`seconds` and appends the unit: `95 mm/s`. The power of seconds
    /// is 0 for a length, 1 for a speed, 2 for an acceleration, 3 for a jerk.
    pub fn own(&self, steps: f64, seconds: u32) -> String {
        format!("{} {}", digits(steps / self.steps), self.per(seconds))
    }

    /// The figure in both units, `95 mm/s (7600 steps/s)`, or in steps alone if they are the axis'
    /// unit.
    pub fn both(&self, steps: f64, seconds: u32) -> String {
        self.with_steps(self.own(steps, seconds), &digits(steps), seconds)
    }

    /// As [`Unit::both`], with both figures rounded down, so that neither exceeds an upper limit.
    pub fn at_most(&self, steps: f64, seconds: u32) -> String {
        let own = format!("{} {}", digits_below(steps / self.steps), self.per(seconds));
        self.with_steps(own, &digits_below(steps), seconds)
    }

    fn with_steps(&self, own: String, steps: &str, seconds: u32) -> String {
        if self.is_step() { own } else { format!("{own} ({steps} {})", per(STEPS, seconds)) }
    }

    /// Whether the unit is the step itself, so that figures are shown once only.
    pub fn is_step(&self) -> bool {
        self.steps == 1.0 && self.name == STEPS
    }
}

fn per(name: &str, seconds: u32) -> String {
    match seconds {
        0 => name.to_owned(),
        1 => format!("{name}/s"),
        power => format!("{name}/s^{power}"),
    }
}

/// Formats a number with six significant digits, and with all digits of its whole part: `0.95`,
/// `2061.86`, `1234567`, `1.5e-9`.
pub fn digits(value: f64) -> String {
    shown(value, |scaled| scaled)
}

/// As [`digits`], rounded down.
pub fn digits_below(value: f64) -> String {
    // The factor keeps a whole number that is low by a float's rounding from being rounded down by
    // one.
    shown(value, |scaled| (scaled * (1.0 + 1e-12)).floor())
}

fn shown(value: f64, round: fn(f64) -> f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let before = value.abs().log10().floor() as i32 + 1;
    if !(-6..=12).contains(&before) {
        let text = format!("{value:.5e}");
        let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{power}", mantissa.trim_end_matches('0').trim_end_matches('.'));
    }
    let after = usize::try_from(DIGITS - before).unwrap_or(0);
    let scale = 10_f64.powi(after as i32);
    let text = format!("{:.after$}", round(value * scale) / scale);
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_six_digits_and_no_trailing_zeros() {
        let shown = [0.0, 0.95, 2_061.855_67, 1_234_567.0, 12.5, -0.05, 320_000_000.0, 1e-9, 1e30]
            .map(digits);
        assert_eq!(
            shown,
            ["0", "0.95", "2061.86", "1234567", "12.5", "-0.05", "320000000", "1e-9", "1e30"]
        );
        assert_eq!(
            [2061.859, 500.0, 499.999_999_999_999_9, 0.3].map(digits_below),
            ["2061.85", "500", "500", "0.3"]
        );
    }

    #[test]
    fn figures_in_steps_are_shown_once() {
        assert_eq!(Unit::new(Some("mm"), 80.0).both(7600.0, 1), "95 mm/s (7600 steps/s)");
        assert_eq!(Unit::new(None, 80.0).both(76.0, 0), "0.95 units (76 steps)");
        assert_eq!(Unit::new(None, 1.0).both(76.0, 2), "76 steps/s^2");
        assert_eq!(Unit::new(Some("um"), 1.0).both(7.0, 3), "7 um/s^3 (7 steps/s^3)");
        assert_eq!(
            Unit::new(Some("mm"), 80.0).at_most(164_948.45, 1),
            "2061.85 mm/s (164948 steps/s)"
        );
    }
}

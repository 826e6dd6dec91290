//! Figures in the text of the sources: constants that are private to a crate, to a test or to a
//! bench, and that pages of the documentation give.

use crate::pages;

/// The number that follows a text in a source file.
///
/// # Panics
/// If there is none.
#[track_caller]
pub fn behind(file: &str, text: &str) -> f64 {
    let source = pages::file(file);
    let (_, rest) = source.split_once(text).unwrap_or_else(|| panic!("{file} has no `{text}`"));
    let of_a_number = |c: &char| c.is_ascii_alphanumeric() || "._-".contains(*c);
    let digits: String = rest.chars().take_while(of_a_number).filter(|c| *c != '_').collect();
    digits.parse().unwrap_or_else(|_| panic!("{file}: `{digits}` after `{text}` is no number"))
}

/// The value of a constant of a source file: a number, a power of two or a duration, whose unit is
/// that of the source.
///
/// # Panics
/// If there is none.
#[track_caller]
pub fn constant(file: &str, name: &str) -> f64 {
    let source = pages::file(file);
    let (_, rest) = source
        .split_once(&format!("const {name}: "))
        .unwrap_or_else(|| panic!("{file} has no constant {name}"));
    let (_, value) = rest.split_once(" = ").expect("a value");
    let (value, _) = value.split_once(';').expect("the end of a value");
    let bare = ["Duration::from_millis(", "Duration::from_secs("]
        .iter()
        .find_map(|unit| value.strip_prefix(unit)?.strip_suffix(')'))
        .unwrap_or(value);
    let number = |text: &str| -> f64 {
        let digits = text.replace('_', "");
        digits.parse().unwrap_or_else(|_| panic!("{file}: {name} is no number: {text}"))
    };
    match bare.split_once(" << ") {
        Some((one, power)) => number(one) * number(power).exp2(),
        None => number(bare),
    }
}

/// The exponent of a power of ten.
///
/// # Panics
/// If the figure is another number.
#[track_caller]
pub fn power_of_ten(figure: f64) -> i32 {
    let power = figure.log10().round() as i32;
    assert!((10_f64.powi(power) / figure - 1.0).abs() < 1e-12, "{figure} is no power of ten");
    power
}

/// A figure as a whole number.
///
/// # Panics
/// If it is none.
#[track_caller]
pub fn whole(figure: f64) -> u64 {
    assert!(figure >= 0.0 && figure.fract() == 0.0, "{figure} is no whole number");
    figure as u64
}

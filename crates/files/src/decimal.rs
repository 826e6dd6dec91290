//! Numbers of input files as exact decimals: the sum of ten times 0.1 is exactly 1.

use bigdecimal::{BigDecimal, RoundingMode, ToPrimitive};
use std::str::FromStr;

/// Greatest number of digits of a number in a file, before and behind the point together.
const MAX_DIGITS: i64 = 60;

/// Greatest number of characters of a literal without its underscores. A longer one needs more than
/// 60 digits, or has zeros without a meaning. Reading two million digits would take three seconds.
const MAX_LENGTH: usize = 200;

/// The exact value of a TOML number literal. Sign, underscores, exponent and the prefixes 0x, 0o
/// and 0b are allowed.
///
/// `None` if it is not a finite decimal number or needs more than 60 digits.
pub fn parse(literal: &str) -> Option<BigDecimal> {
    let plain: String = literal.trim().chars().filter(|&c| c != '_').collect();
    if plain.len() > MAX_LENGTH {
        return None;
    }
    let value = if let Some(hex) = plain.strip_prefix("0x") {
        BigDecimal::from(i64::from_str_radix(hex, 16).ok()?)
    } else if let Some(octal) = plain.strip_prefix("0o") {
        BigDecimal::from(i64::from_str_radix(octal, 8).ok()?)
    } else if let Some(binary) = plain.strip_prefix("0b") {
        BigDecimal::from(i64::from_str_radix(binary, 2).ok()?)
    } else {
        BigDecimal::from_str(plain.trim_start_matches('+')).ok()?
    };
    let scale = value.fractional_digit_count();
    let digits = i64::try_from(value.digits()).ok()?;
    (digits <= MAX_DIGITS && scale.checked_abs()? <= MAX_DIGITS).then_some(value)
}

/// The nearest whole number; halves are rounded away from zero. `None` outside i64.
pub fn round_half_away(value: &BigDecimal) -> Option<i64> {
    value.with_scale_round(0, RoundingMode::HalfUp).to_i64()
}

/// The nearest float; NaN if the number has none.
pub fn to_f64(value: &BigDecimal) -> f64 {
    value.to_f64().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_tenths_make_one() {
        let tenth = parse("0.1").unwrap();
        let sum: BigDecimal = std::iter::repeat_n(tenth, 10).sum();
        assert_eq!(sum, BigDecimal::from(1));
    }

    #[test]
    fn halves_are_rounded_away_from_zero() {
        for (text, whole) in
            [("0.5", 1), ("-0.5", -1), ("1.5", 2), ("2.5", 3), ("-2.5", -3), ("0.4999999", 0)]
        {
            assert_eq!(round_half_away(&parse(text).unwrap()), Some(whole), "{text}");
        }
    }

    #[test]
    fn literals_of_too_many_digits_are_refused() {
        for text in ["1e999999999", "1e-999999999", "nan", "inf", "", "1e", "--1"] {
            assert_eq!(parse(text), None, "{text}");
        }
        assert_eq!(parse(&format!("1.{}", "0".repeat(3_000_000))), None);
        assert_eq!(parse("1_000.5e-1"), parse("100.05"));
        assert_eq!(parse("0x10"), parse("16"));
    }
}

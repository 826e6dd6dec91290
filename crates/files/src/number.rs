//! Exact numbers of input files. Each check reports the place of the number that it rejects.

use crate::decimal;
use crate::error::{InputError, SourceText, quoted};
use bigdecimal::{BigDecimal, Signed};
use toml::Spanned;

/// The exact value of a number in the file. Numbers that are not finite, are 10^30 or more in
/// magnitude, or need more than 60 digits are errors.
pub(crate) fn exact(
    source: &SourceText,
    value: &Spanned<f64>,
    key: &str,
) -> Result<BigDecimal, InputError> {
    const GREATEST: f64 = 1e30;
    let literal = source.text.get(value.span()).unwrap_or("");
    let refused = |wrong: &str, help: &str| {
        let message =
            format!("{} = {}: not a usable number: it {wrong}", quoted(key), quoted(literal));
        InputError::at(source, value.span(), message).help(help)
    };
    if !value.as_ref().is_finite() {
        return Err(refused("is not finite", "give a finite decimal number"));
    }
    if value.as_ref().abs() >= GREATEST {
        return Err(refused("is too great", "a number must be under 10^30"));
    }
    decimal::parse(literal)
        .ok_or_else(|| refused("needs more than 60 digits before or behind its point", "round it"))
}

/// A number greater than zero.
pub(crate) fn positive(
    source: &SourceText,
    value: &Spanned<f64>,
    key: &str,
) -> Result<BigDecimal, InputError> {
    let exact = exact(source, value, key)?;
    if exact.is_positive() {
        return Ok(exact);
    }
    Err(InputError::at(source, value.span(), format!("{key} = {exact}: must be over zero")))
}

/// A number that is zero or greater.
pub(crate) fn not_negative(
    source: &SourceText,
    value: &Spanned<f64>,
    key: &str,
) -> Result<BigDecimal, InputError> {
    let exact = exact(source, value, key)?;
    if exact.is_negative() {
        return Err(InputError::at(
            source,
            value.span(),
            format!("{key} = {exact}: must be zero or more"),
        ));
    }
    Ok(exact)
}

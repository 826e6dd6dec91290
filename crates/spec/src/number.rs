//! Numbers of a file, exact, each refused where it stands.

use crate::decimal;
use crate::error::{InputError, Source};
use bigdecimal::{BigDecimal, Signed};
use toml::Spanned;

/// The exact value of a number in the file, which must be finite.
pub(crate) fn exact(source: &Source, value: &Spanned<f64>, key: &str) -> Result<BigDecimal, InputError> {
    let literal = source.text.get(value.span()).unwrap_or("");
    let exact = if value.as_ref().is_finite() { decimal::parse(literal) } else { None };
    exact.filter(|v| decimal::to_f64(v).abs() < 1e30).ok_or_else(|| {
        InputError::at(source, value.span(), format!("{key} = {literal}: not a usable number"))
            .help("a finite decimal number of at most 60 digits is expected")
    })
}

/// A number over zero.
pub(crate) fn positive(source: &Source, value: &Spanned<f64>, key: &str) -> Result<BigDecimal, InputError> {
    let exact = exact(source, value, key)?;
    if exact.is_positive() {
        return Ok(exact);
    }
    Err(InputError::at(source, value.span(), format!("{key} = {exact}: must be over zero")))
}

/// Zero or a number over it.
pub(crate) fn not_negative(source: &Source, value: &Spanned<f64>, key: &str) -> Result<BigDecimal, InputError> {
    let exact = exact(source, value, key)?;
    if exact.is_negative() {
        return Err(InputError::at(source, value.span(), format!("{key} = {exact}: must be zero or more")));
    }
    Ok(exact)
}

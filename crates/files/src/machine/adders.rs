//! `adders`: the number of adders of the engine.

use crate::error::{InputError, SourceText};
use carrystep_core::Timebase;
use carrystep_core::engine::{
    Adders, EngineError, MAX_AXES, adder_counts, check_schedule_of_adders,
};
use toml::Spanned;

/// Checks the number of adders; without one, there is one.
pub(super) fn check(
    source: &SourceText,
    given: Option<&Spanned<usize>>,
    axes: usize,
) -> Result<usize, InputError> {
    let Some(given) = given else { return Ok(1) };
    let adders = *given.as_ref();
    // Too few or too many axes are an error of their own.
    if adders == 1 || !(1..=MAX_AXES).contains(&axes) {
        return Ok(1);
    }
    if adder_counts(axes).any(|count| count == adders) {
        return Ok(adders);
    }
    let message = EngineError::Adders(Adders { adders, axes }).to_string();
    Err(InputError::at(source, given.span(), message).help(
        "one adder computes all axes in turn; with two adders half of them at a time, and with as \
         many adders as axes all at once, so that the tick can be shorter",
    ))
}

/// Checks that the tick has room for the time slots of several adders. With one adder it need not:
/// the parallel gateware takes shorter ticks.
pub(super) fn check_tick(
    source: &SourceText,
    given: Option<&Spanned<usize>>,
    axes: usize,
    timebase: &Timebase,
) -> Result<(), InputError> {
    let several = given.filter(|given| *given.as_ref() > 1 && axes <= MAX_AXES);
    let Some(given) = several else { return Ok(()) };
    check_schedule_of_adders(axes, *given.as_ref(), timebase)
        .map_err(|error| InputError::at(source, given.span(), error.to_string()))
}

//! `stop_accel`: the acceleration with which the engine ramps an axis down, as the integer that it
//! subtracts from V in each tick.

use super::limit::{AxisLimit, per_tick};
use crate::decimal;
use crate::error::{InputError, SourceText};
use crate::number::positive;
use crate::unit::Unit;
use bigdecimal::BigDecimal;
use carrystep_core::build::Timebase;
use toml::Spanned;

/// Greatest stop acceleration, 2^-64 step per tick^2: a quarter of a step, so that a stop from the
/// greatest speed lasts two ticks.
const MOST: u64 = 1 << 62;

/// Converts a stop acceleration of the file, in units/s^2.
pub(super) fn units(
    source: &SourceText,
    value: &Spanned<f64>,
    steps_per_unit: &BigDecimal,
    unit: &Unit,
    timebase: &Timebase,
) -> Result<u64, InputError> {
    let exact = positive(source, value, "stop_accel")? * steps_per_unit;
    let (least, most) = (1, MOST);
    let fits = |units: &u64| (least..=most).contains(units);
    if let Some(fine) = u64::try_from(per_tick(&exact, 2, timebase)).ok().filter(fits) {
        return Ok(fine);
    }
    let given = unit.both(decimal::to_f64(&exact), 2);
    Err(InputError::at(
        source,
        value.span(),
        format!("stop_accel is {given}: not from 2^-64 to 1/4 step per tick^2"),
    )
    .help(format!(
        "with ticks of {} ns from {} to {} can be counted",
        timebase.tick_ns(),
        unit.both(timebase.steps_per_s2(least), 2),
        unit.at_most(timebase.steps_per_s2(most), 2)
    )))
}

/// The stop acceleration of a file that gives none: the axis' acceleration limit, at most [`MOST`].
pub(super) fn at_the_limit(accel_limit: &AxisLimit) -> u64 {
    u64::try_from(accel_limit.units).unwrap_or(MOST).clamp(1, MOST)
}

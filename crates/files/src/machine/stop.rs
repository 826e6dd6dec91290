//! `stop_accel`: the acceleration with which the engine ramps an axis down, as the integer that it
//! subtracts from V in each tick.

use crate::decimal;
use crate::error::{InputError, SourceText};
use crate::number::positive;
use crate::unit::Unit;
use bigdecimal::{BigDecimal, RoundingMode, ToPrimitive};
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
    let units = counted(&exact, timebase);
    let (least, most) = (1, MOST);
    if let Some(fine) = units.to_u64().filter(|units| (least..=most).contains(units)) {
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

/// The stop acceleration of a file that gives none: the axis' acceleration limit in steps/s^2, at
/// most [`MOST`].
pub(super) fn at_the_limit(accel_limit: &BigDecimal, timebase: &Timebase) -> u64 {
    counted(accel_limit, timebase).to_u64().unwrap_or(MOST).clamp(1, MOST)
}

/// Converts steps/s^2 to 2^-64 step per tick^2, rounded toward zero.
fn counted(steps: &BigDecimal, timebase: &Timebase) -> BigDecimal {
    let tick_ns = BigDecimal::from(timebase.tick_ns());
    // The factor 10^-18 converts ns^2 to s^2; it is exact in decimals.
    let per_tick = steps * &tick_ns * &tick_ns * BigDecimal::new(1.into(), 18);
    (per_tick * BigDecimal::from(1_u128 << 64)).with_scale_round(0, RoundingMode::Down)
}

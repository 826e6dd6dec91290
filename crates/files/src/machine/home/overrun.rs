//! The distance by which an axis overruns its switch, and conversions of speeds.

use crate::machine::limit;
use bigdecimal::BigDecimal;
use carrystep_core::build::Timebase;
use carrystep_core::engine::Guard;

/// Distance in steps, rounded up, from the place where the switch closes to the place where the
/// axis rests. The axis first moves on while the guard accepts the level, and then ramps down.
/// `speed` is in 2^-64 step per tick, `stop` in 2^-64 step per tick^2.
pub fn overrun(speed: u64, stop: u64, guard: &Guard) -> u64 {
    let ramp = u128::from(speed) * u128::from(speed) / (2 * u128::from(stop.max(1)));
    steps_up(ramp.saturating_add(accepted(speed, guard)))
}

/// Converts steps/s to 2^-64 step per tick, rounded down.
pub(super) fn per_tick(speed: &BigDecimal, timebase: &Timebase) -> u64 {
    register(limit::per_tick(speed, 1, timebase))
}

/// A speed in 2^-64 step per tick, which fits because it is below half a step per tick.
pub(super) fn register(speed: i128) -> u64 {
    u64::try_from(speed).unwrap_or(u64::MAX >> 1)
}

/// Distance in 2^-64 step that an axis of this speed moves while the guard accepts a level.
pub(super) fn accepted(speed: u64, guard: &Guard) -> u128 {
    // Four ticks more: the ramp begins a tick later, its first tick determines the direction, and a
    // step reaches the pin two ticks later.
    let ticks = u128::from(guard.debounce) * u128::from(guard.round) + 4;
    u128::from(speed) * ticks
}

/// Converts 2^-64 step to whole steps, rounded up.
pub(super) fn steps_up(units: u128) -> u64 {
    u64::try_from(units.div_ceil(1 << 64)).unwrap_or(u64::MAX)
}

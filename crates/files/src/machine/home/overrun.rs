//! How far an axis goes over its switch, and in what units.

use crate::machine::{Axis, Machine};
use bigdecimal::{BigDecimal, RoundingMode, ToPrimitive};
use carrystep_core::build::Timebase;
use carrystep_core::engine::Guard;

/// How far an axis runs on, in steps, rounded up, from the place where its switch closes until it rests: the time that the
/// guard takes to accept the level, then the ramp. `speed` is in 2^-64 step per tick, `stop` in 2^-64 step per tick^2.
pub fn overrun(speed: u64, stop: u64, guard: &Guard) -> u64 {
    let ramp = u128::from(speed) * u128::from(speed) / (2 * u128::from(stop.max(1)));
    steps_up(ramp.saturating_add(accepted(speed, guard)))
}

impl Axis {
    /// How far this axis has to move away from a switch, in steps, until that is open: `move_off` where the axis homes, else
    /// what a limit stop at full speed runs over the switch.
    pub fn move_off(&self, machine: &Machine) -> u32 {
        let full = || overrun(per_tick(&self.speed_limit, &machine.timebase), self.stop, &machine.guard);
        self.home.map_or_else(|| u32::try_from(full()).unwrap_or(u32::MAX), |home| home.move_off)
    }
}

/// Steps/s in 2^-64 step per tick, rounded down.
pub(super) fn per_tick(speed: &BigDecimal, timebase: &Timebase) -> u64 {
    let per_tick = speed * BigDecimal::from(timebase.tick_ns()) * BigDecimal::new(1.into(), 9);
    let units = (per_tick * BigDecimal::from(1_u128 << 64)).with_scale_round(0, RoundingMode::Down);
    // Speeds are under half a step per tick.
    units.to_u64().unwrap_or(u64::MAX >> 1)
}

/// How far an axis of this speed goes while the guard accepts a level, 2^-64 step.
pub(super) fn accepted(speed: u64, guard: &Guard) -> u128 {
    // The ramp begins a tick later, its first tick finds the direction, and a step is on the pin two ticks later.
    let ticks = u128::from(guard.debounce) * u128::from(guard.round) + 4;
    u128::from(speed) * ticks
}

/// Whole steps, rounded up.
pub(super) fn steps_up(units: u128) -> u64 {
    u64::try_from(units.div_ceil(1 << 64)).unwrap_or(u64::MAX)
}

//! The limits of an axis, exactly in the gateware's units and as floats for the profiles.
//!
//! The directions of rounding ensure that a checked plan does not exceed a limit; they may not
//! change.

use bigdecimal::num_bigint::BigInt;
use bigdecimal::{BigDecimal, ToPrimitive};
use carrystep_core::Timebase;
use carrystep_core::fixed::FRACTION_BITS;
use carrystep_files::Axis;
use carrystep_profile::{Limits, Real};

/// The greatest number of segments of one axis in one move. A move that needs more is refused.
pub(crate) const MOST_SEGMENTS: usize = 1 << 17;

/// Limits in 2^-64 step per tick, per tick^2 and per tick^3, rounded down from the file's decimals.
#[derive(Debug, Clone, Copy)]
pub struct ExactLimits {
    /// Start speed, 2^-64 step per tick.
    pub start_speed: i128,
    /// Speed, 2^-64 step per tick.
    pub speed: i128,
    /// Acceleration, 2^-64 step per tick^2.
    pub acceleration: i128,
    /// Jerk, 2^-64 step per tick^3; `None` if the axis has no jerk limit.
    pub jerk: Option<i128>,
    /// By how much a speed may exceed its limit because floats are rounded, 2^-64 step per tick:
    /// 10^-9 of the speed limit in f64, 64 epsilon of it in f32, plus one unit.
    pub tolerance: i128,
}

impl ExactLimits {
    /// Converts the limits of an axis. Returns `None` if one of them exceeds an i128; the check of
    /// the machine file already refuses such a limit.
    pub fn new<F: Real>(axis: &Axis, timebase: &Timebase) -> Option<Self> {
        let units = |value, ticks| units(value, timebase.tick_ns(), ticks);
        let speed = units(&axis.speed_limit, 1)?;
        let relative = (F::epsilon().to_f64()? * 64.0).max(1e-9);
        Some(Self {
            start_speed: units(&axis.start_speed, 1)?,
            speed,
            acceleration: units(&axis.accel_limit, 2)?,
            // A jerk limit beyond an i128 limits nothing.
            jerk: axis.jerk_limit.as_ref().and_then(|jerk| units(jerk, 3)),
            tolerance: (speed as f64 * relative) as i128 + 1,
        })
    }

    /// The greatest V that a segment may be planned with, 2^-64 step per tick: the speed limit and
    /// half the tolerance. The other half is left for the landing, which may add a unit.
    pub fn fastest(&self) -> i128 {
        self.speed + self.tolerance / 2
    }
}

/// Converts `value` steps per s, s^2 or s^3 (`ticks` is the power) to units of 2^-64 step per power
/// of a tick of `tick_ns`, rounded down. The decimal is digits / 10^scale, and a tick is tick_ns /
/// 10^9 s.
fn units(value: &BigDecimal, tick_ns: u64, ticks: u32) -> Option<i128> {
    let (digits, scale) = value.as_bigint_and_scale();
    let tens = scale + 9 * i64::from(ticks);
    if let Some(units) = small_units(digits.to_u64(), tick_ns.checked_pow(ticks), tens) {
        return Some(units);
    }
    let units = (&*digits << FRACTION_BITS) * BigInt::from(tick_ns).pow(ticks);
    let power = BigInt::from(10).pow(u32::try_from(tens.unsigned_abs()).ok()?);
    if tens < 0 { units * power } else { units / power }.to_i128()
}

/// The same from numbers that fit into 64 bits and 128 bits, as those of most machines do.
fn small_units(digits: Option<u64>, scale: Option<u64>, tens: i64) -> Option<i128> {
    let mut value = digits?.checked_mul(scale?)?;
    let mut tens = u32::try_from(tens).ok()?;
    while tens > 0 && value.is_multiple_of(10) && value > 0 {
        (value, tens) = (value / 10, tens - 1);
    }
    let power = 10_u128.checked_pow(tens)?;
    i128::try_from((u128::from(value) << FRACTION_BITS) / power).ok()
}

/// The same limits in steps and seconds, as floats. A missing jerk limit is infinite.
pub(crate) fn float_limits<F: Real>(axis: &Axis) -> Limits<F> {
    let float = |value: &BigDecimal| value.to_f64().and_then(F::from).unwrap_or_else(F::nan);
    Limits {
        start_speed: float(&axis.start_speed),
        speed: float(&axis.speed_limit),
        acceleration: float(&axis.accel_limit),
        jerk: axis.jerk_limit.as_ref().map_or_else(F::infinity, float),
    }
}

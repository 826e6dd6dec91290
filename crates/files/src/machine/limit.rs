//! A limit of an axis, as the file gives it and as the gateware counts it.
//!
//! The integers are rounded down. A plan that keeps them therefore keeps the file's limits; this
//! direction of rounding may not change.

use crate::decimal;
use bigdecimal::{BigDecimal, RoundingMode, ToPrimitive};
use carrystep_core::build::Timebase;
use carrystep_core::fixed::FRACTION_BITS;
use std::cmp::Ordering;

/// A speed, or one of its rates of change, in the three forms in which it is used. They are
/// converted once, where the file is read.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisLimit {
    /// The exact product of the file's numbers, steps per s, s^2 or s^3; 0 or more.
    pub steps: BigDecimal,
    /// The same as the nearest float.
    pub float: f64,
    /// 2^-64 step per tick, tick^2 or tick^3, rounded down. `i128::MAX` stands for all that exceeds
    /// it, as only a jerk limit may.
    pub units: i128,
}

impl AxisLimit {
    /// Converts steps per s, s^2 or s^3; `seconds` is the power of the second.
    pub(super) fn new(steps: BigDecimal, seconds: u32, timebase: &Timebase) -> Self {
        let (float, units) = (decimal::to_f64(&steps), per_tick(&steps, seconds, timebase));
        Self { steps, float, units }
    }
}

impl PartialOrd for AxisLimit {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.steps.partial_cmp(&other.steps)
    }
}

/// Converts steps per s, s^2 or s^3 to 2^-64 step per tick, tick^2 or tick^3, rounded down, at most
/// `i128::MAX`. `seconds` is the power of the second.
pub(super) fn per_tick(steps: &BigDecimal, seconds: u32, timebase: &Timebase) -> i128 {
    // A tick is tick_ns / 10^9 s, which is exact in decimals.
    let tick = BigDecimal::new(timebase.tick_ns().into(), 9);
    let per_tick =
        (0..seconds).fold(steps * BigDecimal::from(1_u128 << FRACTION_BITS), |x, _| x * &tick);
    per_tick.with_scale_round(0, RoundingMode::Down).to_i128().unwrap_or(i128::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limit(steps: &str, seconds: u32, tick_ns: u64) -> i128 {
        let timebase = Timebase::new(80_000_000, tick_ns, 4).unwrap();
        AxisLimit::new(decimal::parse(steps).unwrap(), seconds, &timebase).units
    }

    #[test]
    fn units_are_rounded_down() {
        let step = 1_i128 << 64;
        assert_eq!(limit("1e6", 1, 1000), step);
        assert_eq!(limit("3e3", 2, 1000), 3 * step / 1_000_000_000);
        assert_eq!(limit("7", 3, 2000), 7 * 8 * step / 1_000_000_000_000_000_000);
        assert_eq!(limit("0.00000000001", 1, 1000), step / 100_000_000_000_000_000);
        assert_eq!(limit("0", 2, 1000), 0);
        let just_below = "0.999999999999999999999999999999";
        assert_eq!(limit(&format!("{just_below}e6"), 1, 1000), step - 1);
    }

    #[test]
    fn what_exceeds_an_i128_is_cut() {
        assert_eq!(limit("1e29", 1, 1000), i128::MAX);
    }
}

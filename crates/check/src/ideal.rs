//! Computes the times at which the float profile crosses each step, and compares edges with them.

use carrystep_core::Timebase;
use carrystep_profile::Crossing;

/// Picoseconds in a second.
pub(crate) const PS: f64 = 1e12;

/// Picoseconds in a nanosecond.
pub(crate) const NS: f64 = 1e3;

/// Length of a tick, ps.
pub(crate) const fn tick_ps(timebase: &Timebase) -> u64 {
    timebase.tick_ns() * 1000
}

/// Length of a phase, h/Q, ps.
pub(crate) fn phase_ps(timebase: &Timebase) -> f64 {
    tick_ps(timebase) as f64 / f64::from(timebase.phases())
}

/// The time at which a crossing is due, after the origin: whole ps, and a rest of at most half a
/// ps. It is computed once for each crossing, because an edge is compared with it several times.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Due {
    whole: i64,
    rest: f64,
}

impl Due {
    /// When a crossing is due. `tick_ps` is the length of a tick.
    pub(crate) fn of(crossing: &Crossing, tick_ps: u64) -> Self {
        let whole = rounded(crossing.seconds * PS);
        let rest = crossing.seconds.mul_add(PS, -whole);
        // 64 bits hold 106 days in ps. A longer time saturates.
        let start = crossing.start_tick.saturating_mul(tick_ps);
        let whole = (whole as i64).saturating_add_unsigned(start);
        Self { whole, rest }
    }

    /// The lateness e = m - t of a rising edge, ps; negative is early. Integers are subtracted
    /// first and floats last, so that the result is exact to a fraction of a ps.
    pub(crate) fn lateness_ps(self, rise_ps: u64, origin_ps: i64) -> f64 {
        let late = i128::from(rise_ps) - i128::from(origin_ps) - i128::from(self.whole);
        nearest(late) - self.rest
    }

    /// The origin for which an edge at `ps` would be exactly at this crossing, ps.
    pub(crate) fn origin_for(self, ps: u64) -> Option<i64> {
        i64::try_from(i128::from(ps) - self.at_ps(0)).ok()
    }

    /// The time of the capture, in whole ps.
    pub(crate) fn at_ps(self, origin_ps: i64) -> i128 {
        i128::from(origin_ps) + i128::from(self.whole)
    }
}

/// The whole number nearest to a float, as [`f64::round`] gives it, but without a call where the
/// float has a fraction.
pub(crate) fn rounded(x: f64) -> f64 {
    const ALL_WHOLE: f64 = (1_u64 << 52) as f64;
    if x.abs() >= ALL_WHOLE {
        return x;
    }
    let truncated = x as i64 as f64;
    let rest = x - truncated;
    if rest.abs() >= 0.5 { truncated + rest.signum() } else { truncated }
}

/// The float nearest to a whole number, which nearly always fits into 64 bits: their conversion is
/// faster.
pub(crate) fn nearest(whole: i128) -> f64 {
    #[cold]
    #[inline(never)]
    fn of_128_bits(whole: i128) -> f64 {
        whole as f64
    }
    match i64::try_from(whole) {
        Ok(whole) => whole as f64,
        Err(_) => of_128_bits(whole),
    }
}

/// The greatest shift of an edge, ps, because the gateware interpolates linearly within a tick and
/// the profile is a parabola: h^2 |a| / (8 v), but at most one tick.
pub(crate) fn curvature_ps(crossing: &Crossing, timebase: &Timebase) -> f64 {
    let tick = timebase.tick_seconds();
    let shift = tick * tick * crossing.acceleration.abs() / (8.0 * crossing.speed);
    // The quotient 0 / 0 would be a crossing at rest without acceleration, which a moving profile
    // does not have.
    if shift.is_nan() { tick * PS } else { shift.min(tick) * PS }
}

/// A factor by which rounding cannot make a product too great.
pub(crate) const ALMOST: f64 = 1.0 - 1e-12;

/// Whether [`curvature_ps`] is surely less than `most_ps`; this needs no division.
pub(crate) fn is_less_curved(crossing: &Crossing, timebase: &Timebase, most_ps: f64) -> bool {
    let tick = timebase.tick_seconds();
    let shift_ps = tick * tick * PS * crossing.acceleration.abs();
    shift_ps < most_ps * (8.0 * crossing.speed) * ALMOST
}

/// Formats a time of the capture for a message.
pub(crate) fn moment(ps: impl Into<i128>) -> String {
    let ps = ps.into() as f64;
    match ps.abs() {
        small if small < 1e6 => format!("{:.3} ns", ps / 1e3),
        small if small < 1e9 => format!("{:.6} us", ps / 1e6),
        small if small < 1e12 => format!("{:.9} ms", ps / 1e9),
        _ => format!("{:.9} s", ps / 1e12),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossing(start_tick: u64, seconds: f64, speed: f64, acceleration: f64) -> Crossing {
        Crossing { start_tick, seconds, backward: false, speed, acceleration }
    }

    #[test]
    fn lateness_is_exact_to_a_picosecond_after_an_hour() {
        let (tick, hour) = (1_000_000_u64, 3_600_000_000_u64);
        for late in [-1_i64, 0, 1, 12_345] {
            let rise = (hour * tick + 123_456_789).strict_add_signed(late) + 7;
            let due = Due::of(&crossing(hour, 123.456_789e-6, 1.0, 0.0), tick);
            let found = due.lateness_ps(rise, 7);
            assert!((found - late as f64).abs() < 1e-6, "{found}");
        }
        let due = Due::of(&crossing(hour, 0.5, 1.0, 0.0), tick);
        assert_eq!(due.at_ps(-7), 3_600_500_000_000_000 - 7);
    }

    #[test]
    fn rounded_is_what_the_standard_library_rounds_to() {
        let around =
            [0.0, 0.25, 0.499_999_999_999_999_94, 0.5, 0.75, 1.0, 1.5, 2.5, 1e9 + 0.5, 4e15 + 0.5];
        let large = [(1_u64 << 52) as f64, (1_u64 << 53) as f64, 1e300, f64::INFINITY];
        for x in around.into_iter().chain(large).flat_map(|x| [x, -x]) {
            assert_eq!(rounded(x) as i128, x.round() as i128, "{x}");
        }
    }

    #[test]
    fn curvature_is_at_most_one_tick() {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        let cases = [(100.0, 8e6, 1e4), (0.0, 1.0, 1e6), (0.0, 0.0, 1e6), (10.0, 0.0, 0.0)];
        for (speed, acceleration, ps) in cases {
            let found = curvature_ps(&crossing(0, 0.0, speed, acceleration), &timebase);
            assert!((found - ps).abs() < 1e-6, "{found} {ps}");
            for most in [0.0, 1.0, 99.0, 101.0, 9e3, 2e4] {
                let is_less =
                    is_less_curved(&crossing(0, 0.0, speed, acceleration), &timebase, most);
                assert!(!is_less || found < most, "{found} {most}");
            }
        }
        assert!(is_less_curved(&crossing(0, 0.0, 1e4, 8e6), &timebase, 101.0));
    }

    #[test]
    fn times_are_formatted_in_suitable_units() {
        let texts =
            [12_345, 12_345_678, 12_345_678_901, 1_234_567_890_123].map(|ps: u64| moment(ps));
        assert_eq!(texts, ["12.345 ns", "12.345678 us", "12.345678901 ms", "1.234567890 s"]);
    }
}

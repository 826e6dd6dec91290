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
    whole: i128,
    rest: f64,
}

impl Due {
    /// When a crossing is due. `tick_ps` is the length of a tick.
    pub(crate) fn of(crossing: &Crossing, tick_ps: u64) -> Self {
        let whole = (crossing.seconds * PS).round();
        let rest = crossing.seconds.mul_add(PS, -whole);
        // 64 bits hold 106 days in ps. A longer time saturates in the cast.
        let start = i128::from(crossing.start_tick) * i128::from(tick_ps);
        Self { whole: start + i128::from(whole as i64), rest }
    }

    /// The lateness e = m - t of a rising edge, ps; negative is early. Integers are subtracted
    /// first and floats last, so that the result is exact to a fraction of a ps.
    pub(crate) fn lateness_ps(self, rise_ps: u64, origin_ps: i64) -> f64 {
        let late = i128::from(rise_ps) - i128::from(origin_ps) - self.whole;
        // The difference nearly always fits into 64 bits, whose conversion to a float is faster.
        i64::try_from(late).map_or_else(|_| late as f64, |late| late as f64) - self.rest
    }

    /// The time of the capture, in whole ps.
    pub(crate) fn at_ps(self, origin_ps: i64) -> i128 {
        i128::from(origin_ps) + self.whole
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
    fn curvature_is_at_most_one_tick() {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        let cases = [(100.0, 8e6, 1e4), (0.0, 1.0, 1e6), (0.0, 0.0, 1e6), (10.0, 0.0, 0.0)];
        for (speed, acceleration, ps) in cases {
            let found = curvature_ps(&crossing(0, 0.0, speed, acceleration), &timebase);
            assert!((found - ps).abs() < 1e-6, "{found} {ps}");
        }
    }

    #[test]
    fn times_are_formatted_in_suitable_units() {
        let texts =
            [12_345, 12_345_678, 12_345_678_901, 1_234_567_890_123].map(|ps: u64| moment(ps));
        assert_eq!(texts, ["12.345 ns", "12.345678 us", "12.345678901 ms", "1.234567890 s"]);
    }
}

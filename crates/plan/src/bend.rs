//! A and J of one run in integers: rounded toward zero, and never such that V, which makes up for them,
//! leaves its range.

use crate::limits::ExactLimits;

/// What a run of one cubic should do, in the direction of travel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wanted {
    /// Length, ticks, at least 1.
    pub ticks: i128,
    /// Distance, 2^-64 step, 0 or more.
    pub distance: i128,
    /// Twice the acceleration in the middle, units.
    pub doubled_middle: i128,
    /// Jerk, units, rounded toward zero.
    pub jerk: i128,
    /// Whether the acceleration keeps its sign.
    pub one_way: bool,
    /// Least V in the first tick, units: 1 where the first motion is to step at once.
    pub least: i128,
    /// Whether it is the first of a move: then the start speed is a limit.
    pub first: bool,
}

/// A, in the first tick, and J of a run; its distance then gives V.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Bend {
    pub a: i128,
    pub j: i128,
}

/// Bounds of A, both included.
#[derive(Debug, Clone, Copy)]
struct Range {
    low: i128,
    high: i128,
}

impl Range {
    /// Keeps what has `slope` A + `rest` >= 0.
    fn keep(&mut self, slope: i128, rest: i128) {
        if slope > 0 {
            self.low = self.low.max(-rest.div_euclid(slope));
        } else {
            self.high = self.high.min(rest.div_euclid(-slope));
        }
    }
}

impl Wanted {
    /// The registers nearest to what is wanted that keep V between zero and the speed limit at both ends, and A
    /// and J within theirs. Without J, without A: one of the three is always possible.
    pub fn within(self, limits: &ExactLimits) -> Bend {
        let most = limits.jerk.unwrap_or(i128::MAX);
        let with_jerk = self.accelerated(self.jerk.clamp(-most, most), limits);
        with_jerk.or_else(|| self.accelerated(0, limits)).unwrap_or_default()
    }

    fn accelerated(&self, j: i128, limits: &ExactLimits) -> Option<Bend> {
        let Self { ticks: n, distance, .. } = *self;
        if n < 2 {
            return None;
        }
        let pairs = n * (n - 1) / 2;
        let by_jerk = jerk_distance(n, j)?;
        let last_tick = (n - 1) * j;
        let fastest = n * limits.fastest();
        let mut a = Range { low: -limits.acceleration, high: limits.acceleration };
        // A is right a tick later than it is loaded: the run begins at A - J, ends at A + (n - 1) J.
        for end in [-j, last_tick] {
            a.keep(1, limits.acceleration + end);
            a.keep(-1, limits.acceleration - end);
        }
        // n V is distance - pairs A - by_jerk in the first tick, distance + pairs A + 2 by_jerk in the last.
        a.keep(-pairs, distance - by_jerk - n * self.least);
        a.keep(pairs, distance + 2 * by_jerk);
        a.keep(pairs, fastest - distance + by_jerk);
        a.keep(-pairs, fastest - distance - 2 * by_jerk);
        if self.one_way && self.doubled_middle >= 0 {
            a.keep(1, 0);
            a.keep(1, last_tick);
        } else if self.one_way {
            a.keep(-1, 0);
            a.keep(-1, -last_tick);
        }
        if a.low > a.high {
            return None;
        }
        if self.first {
            // V - A/2 + J/3, the speed at the very start, times 6 n.
            let mut slow = a;
            let start = limits.start_speed + limits.tolerance;
            slow.keep(3 * n * n, 6 * (by_jerk - distance + n * start) - 2 * n * j);
            a.low = slow.low.min(a.high);
        }
        // V changes by A + k J from tick k to the next: in the middle of these changes A + (n - 2)/2 J is right.
        let nearest = (self.doubled_middle - (n - 2) * j) / 2;
        Some(Bend { a: nearest.clamp(a.low, a.high), j })
    }
}

/// n(n-1)(n-2)/6 J, where that fits with room to spare.
pub(crate) fn jerk_distance(n: i128, j: i128) -> Option<i128> {
    if j == 0 {
        return Some(0);
    }
    let triples = (n <= u32::MAX.into()).then(|| n * (n - 1) * (n - 2) / 6)?;
    triples.checked_mul(j).filter(|distance| distance.abs() < 1 << 120)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::speeds;
    use carrystep_core::Segment;

    const LIMITS: ExactLimits =
        ExactLimits { start_speed: 0, speed: 1 << 60, acceleration: 1 << 40, jerk: None, tolerance: 1 };

    /// The least V of the run that these registers make.
    fn slowest(wanted: Wanted, Bend { a, j }: Bend) -> i128 {
        let n = wanted.ticks;
        let v = (wanted.distance - n * (n - 1) / 2 * a - n * (n - 1) * (n - 2) / 6 * j).div_euclid(n);
        let fits = |x: i128| i64::try_from(x).unwrap();
        let segment = Segment { ticks: u32::try_from(n).unwrap(), v: fits(v), a: fits(a), j: fits(j), last: false };
        speeds(&segment).min().unwrap()
    }

    #[test]
    fn a_lost_fraction_of_jerk_never_turns_the_speed_round() {
        // From and to rest with a jerk of 10.9 units: leaving out 0.9 alone would dip below zero.
        let n = 100_000;
        let distance = n * n * n / 6 * 109 / 10;
        for doubled_middle in [n * 109 / 10, -n * 109 / 10] {
            let wanted = Wanted { ticks: n, distance, doubled_middle, jerk: 10, one_way: true, least: 0, first: true };
            let bend = wanted.within(&LIMITS);
            assert_eq!(bend.j, 10);
            assert!(slowest(wanted, bend) >= 0, "{bend:?}");
        }
    }

    #[test]
    fn what_cannot_be_bent_is_straight() {
        let wanted = Wanted {
            ticks: 1000,
            distance: 5,
            doubled_middle: 1 << 30,
            jerk: 1 << 20,
            one_way: true,
            least: 0,
            first: false,
        };
        assert_eq!(wanted.within(&LIMITS), Bend::default());
        let endless = Wanted { ticks: 1 << 50, distance: 1 << 100, jerk: i128::MAX >> 2, ..wanted };
        assert_eq!(endless.within(&LIMITS).j, 0);
    }
}

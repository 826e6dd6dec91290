//! Rounds A and J of a run to integers, toward zero, such that V, which makes up for the rounding,
//! stays in its range.
//!
//! A run is a sequence of ticks that follows one cubic; a unit is 2^-64 step. The exact check
//! (`check.rs`) repeats every bound that is kept here.

use crate::edges::{pairs, product, triples};
use crate::limits::ExactLimits;

/// What a run of one cubic should do, in the direction of travel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wanted {
    /// Length, ticks, at least 1.
    pub ticks: u64,
    /// Distance, 2^-64 step, 0 or more.
    pub distance: i128,
    /// Twice the acceleration in the middle of the run, 2^-64 step per tick^2.
    pub doubled_middle: i128,
    /// Jerk, 2^-64 step per tick^3, rounded toward zero.
    pub jerk: i128,
    /// Whether the acceleration must keep its sign.
    pub one_way: bool,
    /// Least V in the first tick, units per tick: 1 if the first motion has to step at once,
    /// otherwise 0.
    pub least: i64,
    /// Whether the run is the first of a move, to which the start speed limit applies.
    pub first: bool,
}

/// A in the first tick, and J of a run, in units per tick^2 and per tick^3. V follows from the
/// distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Bend {
    pub a: i128,
    pub j: i128,
}

impl Bend {
    /// The distance in units that A and J add in `n` ticks, or `None` if the magnitude of what J
    /// adds is 2^120 or more.
    #[inline]
    pub fn distance(self, n: u64) -> Option<i128> {
        let Self { a, j } = self;
        let by_acceleration = match (u32::try_from(n), i64::try_from(a)) {
            (Ok(n), Ok(a)) => product(pairs(n.into()), a),
            _ => i128::from(n) * (i128::from(n) - 1) / 2 * a,
        };
        Some(by_acceleration + jerk_distance(n, j)?)
    }

    /// The nearest registers with which a falling run of `ticks` ticks travels `distance` and comes
    /// to rest without reversing.
    pub fn landing(self, ticks: u64, distance: i128, limits: &ExactLimits) -> Self {
        let Self { a, j } = self;
        let doubled_middle = 2 * a + (i128::from(ticks) - 2) * j;
        let wanted = Wanted {
            ticks,
            distance,
            doubled_middle,
            jerk: j,
            one_way: true,
            least: 0,
            first: false,
        };
        wanted.within(limits)
    }
}

/// Bounds of A, both inclusive.
#[derive(Debug, Clone, Copy)]
struct Range {
    low: i128,
    high: i128,
}

impl Range {
    /// Restricts A to values with `slope` A + `rest` >= 0. Most bounds hold at the end that they
    /// concern already, and need no division.
    fn keep(&mut self, slope: i128, rest: i128) {
        let holds = |a: i128| slope.checked_mul(a).is_some_and(|product| product >= -rest);
        if slope > 0 {
            if !holds(self.low) {
                self.low = self.low.max(-rest.div_euclid(slope));
            }
        } else if !holds(self.high) {
            self.high = self.high.min(rest.div_euclid(-slope));
        }
    }
}

impl Wanted {
    /// Returns the registers nearest to the wanted ones that keep V between zero and the speed
    /// limit at both ends of the run, and A and J within their limits. If there are none with J,
    /// the run has J = 0; if there are none with A either, both are 0, which is always possible.
    pub fn within(self, limits: &ExactLimits) -> Bend {
        if self.doubled_middle == 0 && self.jerk == 0 && self.one_way && !self.first {
            // The run has constant speed. If that exceeds a bound, no A helps: it lowers V at one end
            // of the run by as much as it raises V at the other end.
            return Bend::default();
        }
        let j = match limits.jerk {
            Some(most) if self.jerk != 0 => self.jerk.clamp(-most, most),
            _ => self.jerk,
        };
        if let Some(bend) = self.unbounded(j, limits) {
            return bend;
        }
        self.bounded(j, limits).or_else(|| self.bounded(0, limits)).unwrap_or_default()
    }

    /// What [`Self::bounded`] returns, where the wanted A keeps all bounds and the numbers have an
    /// ordinary size. That is so for most runs, and it takes no division.
    #[inline]
    fn unbounded(&self, j: i128, limits: &ExactLimits) -> Option<Bend> {
        let register = |value: i128| i64::try_from(value).ok();
        let n = i64::from(u32::try_from(self.ticks).ok()?);
        let by_jerk = jerk_distance(self.ticks, j)?;
        let j = register(j)?;
        if n < 2 {
            return None;
        }
        let doubled_middle = register(self.doubled_middle)?;
        let a = doubled_middle.checked_sub((n - 2).checked_mul(j)?)? / 2;
        // The acceleration at both ends of the run; A is between the two.
        let ends = [a.checked_sub(j)?, a.checked_add((n - 1).checked_mul(j)?)?];
        let most = register(limits.acceleration).unwrap_or(i64::MAX);
        if ends.iter().any(|&end| end < -most || most < end) {
            return None;
        }
        let [least_a, most_a] = [a.min(ends[1]), a.max(ends[1])];
        if self.one_way && if doubled_middle < 0 { most_a > 0 } else { least_a < 0 } {
            return None;
        }
        // The product is below 2^126. With a distance below 2^120, as what J adds is, no sum of
        // them overflows.
        let by_acceleration = product(pairs(n.cast_unsigned()), a);
        if !(0..1 << 120).contains(&self.distance) {
            return None;
        }
        // n V in the first tick and in the last.
        let first = self.distance - by_jerk - by_acceleration;
        let last = self.distance + 2 * by_jerk + by_acceleration;
        let fastest = product(n, register(limits.fastest())?);
        if first < product(n, self.least) || fastest < first || last < 0 || fastest < last {
            return None;
        }
        if self.first {
            // 6 n times the room below the start speed, of V - A/2 + J/3. Both products by n are
            // below 2^96.
            let room = product(n, register(limits.start_speed + limits.tolerance)?) - first;
            let bend = a.checked_mul(3)?.checked_sub(j.checked_mul(2)?)?;
            if 6 * room + product(n, bend) < 0 {
                return None;
            }
        }
        Some(Bend { a: a.into(), j: j.into() })
    }

    /// The A nearest to the wanted one within all bounds.
    #[cold]
    fn bounded(&self, j: i128, limits: &ExactLimits) -> Option<Bend> {
        let Self { ticks, distance, .. } = *self;
        if ticks < 2 {
            return None;
        }
        let by_jerk = jerk_distance(ticks, j)?;
        let n = i128::from(ticks);
        let pairs = n * (n - 1) / 2;
        let last_tick = (n - 1) * j;
        let fastest = n * limits.fastest();
        let mut a = Range { low: -limits.acceleration, high: limits.acceleration };
        // The continuous acceleration runs from A - J at the start of the run to A + (n - 1) J at
        // its end.
        for end in [-j, last_tick] {
            a.keep(1, limits.acceleration + end);
            a.keep(-1, limits.acceleration - end);
        }
        // n V is distance - pairs A - by_jerk in the first tick, and distance + pairs A + 2 by_jerk
        // in the last.
        a.keep(-pairs, distance - by_jerk - n * i128::from(self.least));
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
            // 6 n times V - A/2 + J/3, the speed at the start of the first tick.
            let mut slow = a;
            let start = limits.start_speed + limits.tolerance;
            slow.keep(3 * n * n, 6 * (by_jerk - distance + n * start) - 2 * n * j);
            a.low = slow.low.min(a.high);
        }
        // V changes by A + k J from tick k to the next. In the middle of these changes this is A +
        // (n - 2)/2 J, which should equal the wanted acceleration.
        let nearest = (self.doubled_middle - (n - 2) * j) / 2;
        Some(Bend { a: nearest.clamp(a.low, a.high), j })
    }
}

/// The distance n(n-1)(n-2)/6 J in units, or `None` if its magnitude is 2^120 or more.
#[inline]
pub(crate) fn jerk_distance(n: u64, j: i128) -> Option<i128> {
    if j == 0 { Some(0) } else { bent_distance(n, j) }
}

/// [`jerk_distance`] where J is not 0.
fn bent_distance(n: u64, j: i128) -> Option<i128> {
    let triples = triples(u32::try_from(n).ok()?.into());
    let distance = match (i64::try_from(triples), i64::try_from(j)) {
        (Ok(few), Ok(j)) => Some(product(few, j)),
        _ => triples.checked_mul(j),
    };
    distance.filter(|distance| distance.abs() < 1 << 120)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::speeds;
    use carrystep_core::Segment;

    const LIMITS: ExactLimits = ExactLimits {
        start_speed: 0,
        speed: 1 << 60,
        acceleration: 1 << 40,
        jerk: None,
        tolerance: 1,
    };

    /// The least V of the run that these registers make.
    fn slowest(wanted: Wanted, Bend { a, j }: Bend) -> i128 {
        let n = i128::from(wanted.ticks);
        let v =
            (wanted.distance - n * (n - 1) / 2 * a - n * (n - 1) * (n - 2) / 6 * j).div_euclid(n);
        let fits = |x: i128| i64::try_from(x).unwrap();
        let segment = Segment {
            ticks: u32::try_from(n).unwrap(),
            v: fits(v),
            a: fits(a),
            j: fits(j),
            last: false,
        };
        speeds(&segment).min().unwrap()
    }

    #[test]
    fn rounding_of_jerk_never_reverses_the_speed() {
        // The run starts or ends at rest with a jerk of 10.9 units. Leaving out only the 0.9 units
        // would let V dip below zero.
        let ticks = 100_000;
        let n = i128::from(ticks);
        let distance = n * n * n / 6 * 109 / 10;
        for doubled_middle in [n * 109 / 10, -n * 109 / 10] {
            let wanted = Wanted {
                ticks,
                distance,
                doubled_middle,
                jerk: 10,
                one_way: true,
                least: 0,
                first: true,
            };
            let bend = wanted.within(&LIMITS);
            assert_eq!(bend.j, 10);
            assert!(slowest(wanted, bend) >= 0, "{bend:?}");
        }
    }

    #[test]
    fn run_without_valid_bend_has_constant_speed() {
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
